// A part of a plan as a problem of its own, the rest standing still.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/choosing.h"
#include "engine/search/problem.h"

namespace vfplan {

// Its columns are those of the window's stations and what could take their place; its rows those
// that only they cover. What stands still is there as columns without rows that are fixed: one for
// each part that hangs together, or, where cycles count, as much of its tree of blocks as a cycle
// through the window could run along. So a plan of the window, put in place of its stations, makes
// a plan of the whole, with as many more or fewer stations, and as many more or fewer loose.
struct Window {
    Problem problem;
    Choice start;
    std::vector<std::int32_t> column;  // in the whole problem; -1: what stands still
};

// `stations`: some of the chosen columns. Takes time with the whole and its plan's links. The
// whole may be a window itself, of which what stands still is none of the stations. Thread-safe.
Window make_window(const Problem& whole, const Choosing& plan,
                   const std::vector<std::int32_t>& stations);

}  // namespace vfplan
