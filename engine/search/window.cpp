#include "engine/search/window.h"

#include <algorithm>

#include "engine/search/still.h"

namespace vfplan {
namespace {

using Flags = std::vector<std::uint8_t>;

// The rows that only stations inside cover.
std::vector<std::int32_t> rows_of(const Problem& p, const Choosing& plan,
                                  const std::vector<std::int32_t>& stations) {
    std::vector<std::int32_t> times(idx(p.rows()), 0);
    std::vector<std::int32_t> out;
    for (const std::int32_t s : stations) {
        for (const std::int32_t r : p.rows_of.of(s)) {
            if (++times[idx(r)] == plan.cover(r)) out.push_back(r);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

// The stations, and what covers one of the rows or is near to one of them, as far as it hangs
// together with the plan by way of each other.
std::vector<std::int32_t> columns_of(const Problem& p, const Choosing& plan,
                                     const std::vector<std::int32_t>& stations,
                                     const std::vector<std::int32_t>& rows) {
    enum : std::uint8_t { unknown, listed, joined };
    Flags state(idx(p.columns()), unknown);
    std::vector<std::int32_t> list;
    const auto add = [&](std::int32_t c) {
        if (state[idx(c)] != unknown || plan.is_chosen(c)) return;
        state[idx(c)] = listed;
        list.push_back(c);
    };
    for (const std::int32_t r : rows) {
        for (const std::int32_t c : p.columns_of.of(r)) add(c);
    }
    for (const std::int32_t s : stations) {
        for (const std::int32_t c : p.near.of(s)) add(c);
    }
    std::vector<std::int32_t> out = stations;
    const auto join = [&](std::int32_t c) {
        if (state[idx(c)] != listed) return;
        state[idx(c)] = joined;
        out.push_back(c);
    };
    for (const std::int32_t c : list) {
        if (!plan.links(c).empty()) join(c);
    }
    for (std::size_t i = stations.size(); i < out.size(); ++i) {
        for (const std::int32_t n : p.near.of(out[i])) join(n);
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

Window make_window(const Problem& p, const Choosing& plan,
                   const std::vector<std::int32_t>& stations) {
    Window out;
    Flags inside(idx(p.columns()), 0);
    for (const std::int32_t s : stations) inside[idx(s)] = 1;
    const std::vector<std::int32_t> rows = rows_of(p, plan, stations);
    out.column = columns_of(p, plan, stations, rows);
    Flags touched(idx(p.columns()), 0);
    for (const std::int32_t c : out.column) {
        for (const std::int32_t n : plan.links(c)) touched[idx(n)] = 1;
    }
    const Still still = find_still(p, plan, inside, touched);

    const bool cycles = !p.loose.empty();
    const auto columns = static_cast<std::int32_t>(out.column.size());
    std::vector<std::int32_t> number(idx(p.columns()), -1);
    for (std::int32_t i = 0; i < columns; ++i) number[idx(out.column[idx(i)])] = i;
    // Ways between columns and nodes, and between nodes.
    std::vector<std::vector<std::int32_t>> to_node(idx(still.nodes));
    for (const auto& [a, b] : still.links) {
        to_node[idx(a)].push_back(columns + b);
        to_node[idx(b)].push_back(columns + a);
    }
    std::vector<std::int32_t> row_number(idx(p.rows()), -1);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        row_number[idx(rows[i])] = static_cast<std::int32_t>(i);
    }
    Problem& q = out.problem;
    for (std::int32_t i = 0; i < columns; ++i) {
        const std::int32_t c = out.column[idx(i)];
        for (const std::int32_t r : p.rows_of.of(c)) {
            if (row_number[idx(r)] >= 0) q.rows_of.to.push_back(row_number[idx(r)]);
        }
        q.rows_of.end_list();
        std::vector<std::int32_t> nodes;
        for (const std::int32_t n : p.near.of(c)) {
            if (number[idx(n)] >= 0) {
                q.near.to.push_back(number[idx(n)]);
            } else if (plan.is_chosen(n)) {
                nodes.push_back(still.node[idx(n)]);
            }
        }
        std::sort(nodes.begin(), nodes.end());
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            // Two ways to one node are a cycle; more, or two where none count, are no more.
            const std::size_t most = cycles ? 2 : 1;
            if (k >= most && nodes[k - most] == nodes[k]) continue;
            q.near.to.push_back(columns + nodes[k]);
            to_node[idx(nodes[k])].push_back(i);
        }
        q.near.end_list();
        if (p.beside.size() > 0) {
            for (const std::int32_t n : p.beside.of(c)) {
                if (number[idx(n)] >= 0) q.beside.to.push_back(number[idx(n)]);
            }
            q.beside.end_list();
        }
        q.fixed.push_back(p.fixed[idx(c)]);
        if (!cycles) continue;
        q.block.push_back(p.block[idx(c)]);
        q.loose.push_back(p.loose[idx(c)]);
        q.closable.push_back(p.closable.empty() ? std::uint8_t{0} : p.closable[idx(c)]);
    }
    for (std::vector<std::int32_t>& list : to_node) {
        std::sort(list.begin(), list.end());
        q.near.add_list(list);
        q.rows_of.end_list();
        if (p.beside.size() > 0) q.beside.end_list();
        q.fixed.push_back(1);
    }
    q.block.insert(q.block.end(), still.block.begin(), still.block.end());
    q.loose.insert(q.loose.end(), still.loose.begin(), still.loose.end());
    q.closable.insert(q.closable.end(), still.closable.begin(), still.closable.end());
    q.columns_of = transposed(q.rows_of, static_cast<std::int32_t>(rows.size()));
    for (const std::int32_t s : stations) out.start.push_back(number[idx(s)]);
    for (std::int32_t n = 0; n < still.nodes; ++n) out.start.push_back(columns + n);
    std::sort(out.start.begin(), out.start.end());
    out.column.resize(out.column.size() + idx(still.nodes), -1);
    return out;
}

}  // namespace vfplan
