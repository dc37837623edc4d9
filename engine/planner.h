// From the coverage table to a connected network of stations (SPEC sections 6 and 7). Works on
// the tables alone: no geometry.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/cycles.h"
#include "engine/graph.h"
#include "engine/piece_rows.h"
#include "engine/separation.h"
#include "kernels/candidate.h"

namespace vfplan {

struct PlanOptions {
    std::string method = "refined";  // greedy | refined
    bool loops = true;
    OverlapRatio ratio = OverlapRatio::mean_len;
    double threshold = 0.3;
};

struct PlanInput {
    const std::vector<Candidate>& candidates;
    const PieceRows& rows;
    const std::vector<double>& piece_length_m;
    const std::vector<PieceStatus>& reach;
    const Graph& graph;  // over the candidates, by the options' ratio and threshold
};

// What happened on the way.
struct PlanReport {
    std::int64_t greedy_stations = 0;  // Algorithm 1 alone
    std::int64_t pruned_stations = 0;  // taken out again
    std::int64_t before_loops = 0;     // VC before loops were closed
    std::int64_t loose_before = 0;     // stations on no cycle, before and after
    std::int64_t loose_after = 0;
};

// Stations numbered by network, then order of choice. Deterministic. Links have no ratios but that
// of the job yet (add_ratios), and there is no certificate yet (independent_pieces).
Plan make_plan(const PlanInput& input, const PlanOptions& options, PlanReport& report);

// All five ratios of the plan's links. Goes through the candidates once, in their order, and asks
// for their angles on the way: a few megabytes at a time.
void add_ratios(const PlanInput& input, const AngleSource& angles, Plan& plan);

// Pieces no two of which share a candidate, greedily: a lower bound (Plan::bound_pieces).
std::vector<std::int32_t> independent_pieces(const PieceRows& rows, const PieceIndex& index);

// --- the steps, each on the chosen candidates of one network -----------------------------------

// A network in the making: candidates in the order in which they were chosen.
using Chosen = std::vector<std::int32_t>;

// What the steps note by candidate. Made once and shared by all networks, so that a small network
// costs what it holds, not what the graph holds: a step leaves the arrays as it found them.
struct Workspace {
    explicit Workspace(const Graph& graph);

    static constexpr std::int32_t far_away = 0x7fffffff;
    std::vector<std::uint8_t> mark;    // 0
    std::vector<double> overlap;       // 0
    std::vector<double> step;          // 0
    std::vector<std::int32_t> hops;    // far_away
    std::vector<std::int32_t> before;  // -1
    Separation chosen;                 // of the networks pruned so far
    Cycles stations;                   // of the networks whose loops are closed
};

// Algorithm 1 with its gaps closed (SPEC section 6). Chooses among `members` (one connected
// component, ascending) until every piece with wanted[piece] that they can cover is covered;
// clears `wanted` of what it covers. `forced` members are taken first, joined by shortest paths.
Chosen greedy_network(const PlanInput& input, const std::vector<std::int32_t>& members,
                      const std::vector<std::int32_t>& forced, std::vector<std::uint8_t>& wanted,
                      Workspace& work);

// Takes out, last chosen first, what neither coverage nor connection needs. `kept` (by candidate)
// must stay; `count` holds how many stations of this network and those before it cover each
// piece, and is kept up to date.
Chosen prune_network(const PlanInput& input, const Chosen& chosen,
                     const std::vector<std::uint8_t>& kept, std::vector<std::int32_t>& count,
                     Workspace& work);

// Adds, for each station on no cycle, the fewest candidates that put it on one through another
// station, where there are any. Once for each network of a work space.
Chosen close_loops(const PlanInput& input, const Chosen& chosen, Workspace& work);

}  // namespace vfplan
