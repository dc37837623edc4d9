// Cells over which a set of candidates covers what it sees, so that no lesser one is needed for it.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/joining/chains.h"
#include "engine/joining/knowledge.h"
#include "kernels/coverage.h"

namespace vfplan {

// Rows of candidates and disputed cells, and what is known of them. Refers to what outlives it.
struct TakerProblem {
    const LocalRows& local;
    std::int32_t first_piece = 0;  // of the site, is 0 in the local rows
    std::int32_t candidates = 0;   // so many of the rows, the first ones
    const Joined& joined;
    const std::vector<PieceComponent>& seen;  // from candidates, all of the site
    const Pieces& pieces;
};

// Of the sets that see a piece from any cell, the one that sees most length owns it. Where no
// candidate of the owner covers it, cells of the owner that do are taken: those that cover most
// such pieces first, of equal ones the first, each with the cells that lead to a candidate.
// Numbers of cells, ascending.
std::vector<std::int32_t> find_takers(const TakerProblem& problem);

}  // namespace vfplan
