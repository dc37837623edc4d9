#include "engine/search/structure.h"

#include <algorithm>

namespace vfplan {

Structure::Structure(const Problem& problem, const Choosing& choosing)
    : p_(problem),
      c_(choosing),
      part_(idx(p_.columns()), -1),
      seen_(idx(p_.columns()), 0),
      order_(idx(p_.columns()), -1),
      low_(idx(p_.columns()), 0),
      parent_(idx(p_.columns()), -1),
      next_(idx(p_.columns()), 0),
      passed_(idx(p_.columns()), 0),
      on_cycle_(idx(p_.columns()), 0) {}

void Structure::find_parts() {
    for (const std::int32_t c : c_.chosen()) part_[idx(c)] = -1;
    above_.clear();
    weight_.clear();
    for (const std::int32_t seed : c_.chosen()) {
        if (part_[idx(seed)] >= 0) continue;
        const auto part = static_cast<std::int32_t>(above_.size());
        above_.push_back(part);
        weight_.push_back(0);
        part_[idx(seed)] = part;
        queue_.assign(1, seed);
        for (std::size_t i = 0; i < queue_.size(); ++i) {
            weight_.back() += static_cast<std::int64_t>(p_.near.of(queue_[i]).size());
            for (const std::int32_t n : c_.links(queue_[i])) {
                if (part_[idx(n)] >= 0) continue;
                part_[idx(n)] = part;
                queue_.push_back(n);
            }
        }
    }
    parts_ = static_cast<std::int32_t>(above_.size());
}

std::int32_t Structure::top(std::int32_t part) {
    while (above_[idx(part)] != part) {
        part = above_[idx(part)] = above_[idx(above_[idx(part)])];
    }
    return part;
}

void Structure::joins(std::int32_t column) {
    const auto part = static_cast<std::int32_t>(above_.size());
    above_.push_back(part);
    weight_.push_back(static_cast<std::int64_t>(p_.near.of(column).size()));
    part_[idx(column)] = part;
    ++parts_;
    for (const std::int32_t n : c_.links(column)) {
        const std::int32_t other = top(part_[idx(n)]);
        if (other == part) continue;
        above_[idx(other)] = part;
        weight_[idx(part)] += weight_[idx(other)];
        --parts_;
    }
}

std::int32_t Structure::touches(std::int32_t column) {
    const std::vector<std::int32_t>& links = c_.links(column);
    std::int32_t count = 0;
    for (std::size_t i = 0; i < links.size(); ++i) {
        const std::int32_t mine = part(links[i]);
        bool known = false;
        for (std::size_t k = 0; k < i && !known; ++k) known = part(links[k]) == mine;
        if (!known) ++count;
    }
    return count;
}

bool Structure::can_go(std::int32_t column) {
    const std::vector<std::int32_t>& links = c_.links(column);
    if (links.size() < 2) return true;
    ++now_;
    seen_[idx(column)] = now_;
    const std::uint32_t wanted = now_;
    ++now_;
    std::size_t left = 0;
    for (const std::int32_t n : links) {
        if (seen_[idx(n)] == wanted) continue;
        seen_[idx(n)] = wanted;
        ++left;
    }
    queue_.assign(1, links.front());
    seen_[idx(links.front())] = now_;
    --left;
    for (std::size_t i = 0; i < queue_.size() && left > 0; ++i) {
        for (const std::int32_t n : c_.links(queue_[i])) {
            if (n == column || seen_[idx(n)] == now_) continue;
            if (seen_[idx(n)] == wanted) --left;
            seen_[idx(n)] = now_;
            queue_.push_back(n);
        }
    }
    return left == 0;
}

bool Structure::is_loose(std::int32_t column) const {
    if (on_cycle(column) || p_.loose[idx(column)] == 0) return false;
    if (!p_.closable.empty() && p_.closable[idx(column)] != 0) return true;
    const std::vector<std::int32_t>& links = c_.links(column);
    return std::any_of(links.begin(), links.end(),
                       [&](std::int32_t n) { return p_.block[idx(n)] == p_.block[idx(column)]; });
}

// Lowest-reachable numbering (Tarjan), without recursion. The way to the parent is passed over
// once: where there are two, they are a cycle.
std::int64_t Structure::find_cycles() {
    for (const std::int32_t c : c_.chosen()) {
        order_[idx(c)] = -1;
        on_cycle_[idx(c)] = 0;
        parent_[idx(c)] = -1;
        next_[idx(c)] = 0;
    }
    std::int32_t clock = 0;
    std::vector<std::int32_t>& stack = queue_;
    for (const std::int32_t root : c_.chosen()) {
        if (order_[idx(root)] >= 0) continue;
        order_[idx(root)] = low_[idx(root)] = clock++;
        stack.assign(1, root);
        passed_[idx(root)] = 1;
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            const std::vector<std::int32_t>& links = c_.links(v);
            if (next_[idx(v)] < links.size()) {
                const std::int32_t w = links[next_[idx(v)]++];
                if (order_[idx(w)] < 0) {
                    parent_[idx(w)] = v;
                    passed_[idx(w)] = 0;
                    order_[idx(w)] = low_[idx(w)] = clock++;
                    stack.push_back(w);
                } else if (w == parent_[idx(v)] && passed_[idx(v)] == 0) {
                    passed_[idx(v)] = 1;
                } else {
                    low_[idx(v)] = std::min(low_[idx(v)], order_[idx(w)]);
                }
                continue;
            }
            stack.pop_back();
            const std::int32_t p = parent_[idx(v)];
            if (p < 0) continue;
            low_[idx(p)] = std::min(low_[idx(p)], low_[idx(v)]);
            if (low_[idx(v)] <= order_[idx(p)]) on_cycle_[idx(v)] = on_cycle_[idx(p)] = 1;
        }
    }
    std::int64_t loose = 0;
    for (const std::int32_t c : c_.chosen()) {
        if (is_loose(c)) loose += p_.loose[idx(c)];
    }
    return loose;
}

}  // namespace vfplan
