// What a choice of columns looks like as a graph: its parts, and what lies on a cycle.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/choosing.h"

namespace vfplan {

// Room to look at one choice again and again, at the cost of what is chosen. Refers to both.
class Structure {
public:
    Structure(const Problem& problem, const Choosing& choosing);

    // Numbers the parts in which the chosen hang together. joins()
    // keeps that up to date.
    void find_parts();
    std::int32_t part(std::int32_t column) { return top(part_[idx(column)]); }
    // Columns near to a part: what a search outward from it would cost.
    std::int64_t weight(std::int32_t part) const { return weight_[idx(part)]; }
    std::int32_t parts() const { return parts_; }
    // A column that has just been chosen: draws together the parts that it touches.
    void joins(std::int32_t column);
    // How many parts a column touches that is not chosen.
    std::int32_t touches(std::int32_t column);

    // True if the chosen hang together without this one of them as much as with it.
    bool can_go(std::int32_t column);

    // Finds which of the chosen lie on a cycle; returns how many stations are loose.
    std::int64_t find_cycles();
    bool on_cycle(std::int32_t column) const { return on_cycle_[idx(column)] != 0; }
    bool is_loose(std::int32_t column) const;

private:
    std::int32_t top(std::int32_t part);

    const Problem& p_;
    const Choosing& c_;
    std::vector<std::int32_t> part_;
    std::vector<std::int32_t> above_;  // of parts, drawn together
    std::vector<std::int64_t> weight_;
    std::int32_t parts_ = 0;
    std::vector<std::int32_t> queue_;
    std::vector<std::uint32_t> seen_;
    std::uint32_t now_ = 0;
    std::vector<std::int32_t> order_;
    std::vector<std::int32_t> low_;
    std::vector<std::int32_t> parent_;
    std::vector<std::size_t> next_;
    std::vector<std::uint8_t> passed_;  // the way to the parent was met once
    std::vector<std::uint8_t> on_cycle_;
};

}  // namespace vfplan
