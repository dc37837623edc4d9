// What planning works on, and the room that its steps share.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/graphs/cycles.h"
#include "engine/graphs/graph.h"
#include "kernels/candidate.h"
#include "kernels/overlap_rows.h"

namespace vfplan {

// The coverage table without geometry. Refers to what outlives it.
struct PlanInput {
    const std::vector<Candidate>& candidates;
    const OverlapRows& rows;
    const std::vector<double>& piece_length_m;
    // Before a plan: `covered` where some candidate covers the piece, else why none does.
    const std::vector<PieceStatus>& status;
    const Graph& graph;  // over the candidates, by the job's ratio and threshold
};

// A network in the making: candidates in the order in which they were chosen.
using Chosen = std::vector<std::int32_t>;

// A candidate next to chosen ones, as it was when it entered a queue; both numbers may be out of
// date.
struct FrontierEntry {
    double gain_m;
    double overlap;
    std::int32_t candidate;
    bool operator<(const FrontierEntry& o) const {  // the greatest is taken first
        return std::tuple(gain_m, overlap, -candidate) <
               std::tuple(o.gain_m, o.overlap, -o.candidate);
    }
};

// What the steps note by candidate. Made once and shared by all networks, so that a small network
// costs what it holds, not what the graph holds: a step leaves the arrays as it found them.
struct Workspace {
    explicit Workspace(const Graph& graph)
        : mark(idx(graph.size()), 0),
          overlap(mark.size(), 0),
          step(mark.size(), 0),
          hops(mark.size(), far_away),
          before(mark.size(), -1),
          stations(graph) {}

    static constexpr std::int32_t far_away = 0x7fffffff;
    std::vector<std::uint8_t> mark;    // 0
    std::vector<double> overlap;       // 0
    std::vector<double> step;          // 0
    std::vector<std::int32_t> hops;    // far_away
    std::vector<std::int32_t> before;  // -1
    Cycles stations;                   // of the networks whose loops are closed
};

}  // namespace vfplan
