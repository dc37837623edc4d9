// Cycles for what is loose.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/search/choosing.h"
#include "engine/search/dice.h"
#include "engine/search/structure.h"
#include "engine/search/ways.h"

namespace vfplan {

// A link that is on no cycle divides the chosen in two sides; its ear is a way from one side to the
// other through columns that are not chosen. Refers to all.
class Ears {
public:
    Ears(const Problem& problem, Choosing& choosing, Structure& structure, Ways& ways, Dice& dice)
        : p_(problem),
          c_(choosing),
          structure_(structure),
          ways_(ways),
          dice_(dice),
          side_(idx(problem.columns()), 0) {}

    // Adds ears for what is loose, one after another in an order drawn by lot: at any cost the
    // shortest of each, else one of each where it takes at most `most_columns` for each column that
    // is then not loose any more. Returns how many stations are loose then; none, at any cost,
    // unless the problem is a window.
    std::int64_t close(double most_columns);
    static constexpr double any_cost = 1e300;

private:
    void find(std::int32_t a, std::int32_t b);

    const Problem& p_;
    Choosing& c_;
    Structure& structure_;
    Ways& ways_;
    Dice& dice_;
    std::vector<std::uint32_t> side_;
    std::uint32_t now_ = 0;
    std::array<std::vector<std::int32_t>, 2> sides_;
    std::vector<std::int32_t> ear_;
};

}  // namespace vfplan
