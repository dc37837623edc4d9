// A choice of columns that changes, with what each column means to it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/search/problem.h"

namespace vfplan {

// All is kept up to date with each change: a change costs about as much as the column's lists hold.
// Changes can be taken back to a mark. Refers to the problem. Not thread-safe.
class Choosing {
public:
    explicit Choosing(const Problem& problem);

    void add(std::int32_t column);
    void remove(std::int32_t column);
    // Takes back all changes since the mark, which was changes() once.
    void back_to(std::size_t mark);
    std::size_t changes() const { return changes_.size(); }
    std::span<const std::int32_t> changed_since(std::size_t mark) const {
        return {changes_.data() + mark, changes_.data() + changes_.size()};
    }
    void forget_changes() { changes_.clear(); }

    // In no order that means anything.
    const std::vector<std::int32_t>& chosen() const { return chosen_; }
    Choice choice() const;
    bool is_chosen(std::int32_t column) const { return place_[idx(column)] >= 0; }
    // How many chosen columns cover the row.
    std::int32_t cover(std::int32_t row) const { return cover_[idx(row)]; }
    // How many rows only this chosen column covers.
    std::int32_t alone(std::int32_t column) const { return alone_[idx(column)]; }
    // Chosen columns near to the column, chosen or not; in no order that means anything. One that
    // is near by two ways stands there twice.
    const std::vector<std::int32_t>& links(std::int32_t column) const {
        return links_[idx(column)];
    }
    // Pairs of chosen columns that stand too near by each other.
    std::int64_t pairs_beside() const { return pairs_beside_; }
    // Rows that lost their only cover since this was last emptied; some may be covered again.
    std::vector<std::int32_t>& bared() { return bared_; }
    // Chosen columns that were not alone with any row any more; some may be again, or gone.
    std::vector<std::int32_t>& spared() { return spared_; }

private:
    void put(std::int32_t column);
    void take(std::int32_t column);
    std::int64_t chosen_beside(std::int32_t column) const;

    const Problem& p_;
    std::vector<std::int32_t> chosen_;
    std::vector<std::int32_t> place_;  // in chosen_; -1 where not
    std::vector<std::int32_t> cover_;
    std::vector<std::int32_t> owner_;  // by row: its chosen columns, exclusive or of all
    std::vector<std::int32_t> alone_;
    std::vector<std::vector<std::int32_t>> links_;
    std::int64_t pairs_beside_ = 0;
    std::vector<std::int32_t> bared_;
    std::vector<std::int32_t> spared_;
    std::vector<std::int32_t> changes_;
};

}  // namespace vfplan
