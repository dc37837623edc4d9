// What the lines of a proof say, in numbers.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/problem.h"
#include "kernels/certificate.h"

namespace vfplan {

// Of which columns every plan has one: those of a row, or one that is fixed. Ascend.
struct Root {
    std::int32_t row = -1;
    std::int32_t column = -1;
    std::vector<std::int32_t> columns;
};
// The first fixed column, else the row with the fewest columns. REQUIRES: there is one of these.
Root root_of(const Problem& problem);

// The variables of a problem with a root: x of each column; y of each link into each column, in
// the order of Problem::near (number i of the list of c is the way from there to c); r of each root
// candidate. Here lines tell columns and rows of the problem. Refers to both. Not thread-safe.
class Lines {
public:
    // `cost`: of columns, in parts of proof_scale; where it is empty, each is one station.
    Lines(const Problem& problem, const Root& root, std::vector<std::int64_t> cost = {});

    std::int32_t size() const { return first_root_ + static_cast<std::int32_t>(r_.columns.size()); }
    std::int32_t x(std::int32_t column) const { return column; }
    std::int32_t y(std::int64_t place) const {
        return p_.columns() + static_cast<std::int32_t>(place);
    }
    std::int32_t r(std::size_t number) const {
        return first_root_ + static_cast<std::int32_t>(number);
    }
    const Problem& problem() const { return p_; }
    const Root& root() const { return r_; }
    std::int64_t cost(std::int32_t column) const {
        return cost_.empty() ? proof_scale : cost_[idx(column)];
    }
    // Place of the way from a column to another one near to it.
    std::int64_t place(std::int32_t from, std::int32_t to) const;

    static std::int64_t least(LineKind kind) {
        return is_of_piece(kind) || kind == LineKind::root ? 1 : 0;
    }
    static bool is_equation(LineKind kind) { return kind == LineKind::root; }

    // Calls f(variable, factor), each variable once.
    template <class F>
    void each(const ProofLine& line, F&& f) {
        ++now_;
        for (const std::int32_t w : line.within) in_[idx(w)] = now_;
        switch (line.kind) {
            case LineKind::cover:
                for (const std::int32_t c : p_.columns_of.of(line.of)) f(c, 1);
                break;
            case LineKind::nodes:
            case LineKind::nodes_of:
                each_node(line, f);
                break;
            case LineKind::root:
                for (std::size_t k = 0; k < r_.columns.size(); ++k) f(r(k), 1);
                break;
            case LineKind::pair:
                f(line.of, 1);
                f(y(place(line.of, line.within.front())), -1);
                f(y(place(line.within.front(), line.of)), -1);
                break;
            case LineKind::first:
                for (std::size_t k = 0; k < r_.columns.size() && r_.columns[k] <= line.of; ++k) {
                    f(r(k), 1);
                }
                f(line.of, -1);
                break;
            case LineKind::arcs:
            case LineKind::arcs_of:
                each_arc(line, f);
                break;
        }
    }

private:
    template <class F>
    void each_node(const ProofLine& line, F& f) {
        const auto once = [&](std::int32_t c) {
            if (met_[idx(c)] == now_) return;
            met_[idx(c)] = now_;
            f(c, 1);
        };
        for (const std::int32_t w : line.within) {
            for (const std::int32_t n : p_.near.of(w)) {
                if (in_[idx(n)] != now_) once(n);
            }
        }
        if (line.kind == LineKind::nodes) {
            for (const std::int32_t c : p_.columns_of.of(line.of)) {
                if (in_[idx(c)] != now_) once(c);
            }
        }
        for (const std::int32_t c : r_.columns) {
            if (in_[idx(c)] == now_) once(c);
        }
        if (line.kind == LineKind::nodes_of) f(line.of, -1);
    }

    template <class F>
    void each_arc(const ProofLine& line, F& f) {
        for (const std::int32_t w : line.within) {
            for (auto i = p_.near.begin[idx(w)]; i < p_.near.begin[idx(w) + 1]; ++i) {
                if (in_[idx(p_.near.to[idx(i)])] != now_) f(y(i), 1);
            }
            if (root_[idx(w)] >= 0) f(r(idx(root_[idx(w)])), 1);
        }
        if (line.kind == LineKind::arcs_of) {
            f(line.of, -1);
            return;
        }
        for (const std::int32_t c : p_.columns_of.of(line.of)) {
            if (in_[idx(c)] != now_) f(c, 1);
        }
    }

    const Problem& p_;
    const Root& r_;
    std::vector<std::int64_t> cost_;
    std::int32_t first_root_;
    std::vector<std::int32_t> root_;  // by column: its place in the root, or -1
    std::vector<std::uint32_t> in_;
    std::vector<std::uint32_t> met_;
    std::uint32_t now_ = 0;
};

}  // namespace vfplan
