// Whether a plan stands the loss of any one of its stations, station by station.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/overlap_rows.h"

namespace vfplan {

// One network of a plan: all candidates of its component (ascending), which of all candidates stand
// in it, neighbours of all candidates, and the pieces that it has to cover (owner[piece] == mine).
struct NetworkToLose {
    const std::vector<std::int32_t>& members;
    const std::vector<std::uint8_t>& chosen;
    const std::vector<std::vector<std::int32_t>>& near;
    const OverlapRows& rows;
    const std::vector<std::int32_t>& owner;
    std::int32_t mine;
};

struct Survival {
    std::int64_t pieces_alone = 0;  // that one candidate alone covers
    std::int64_t parting = 0;       // stations whose loss parts the network, and must
    std::string wrong;              // the first thing that is; empty where all is right
};

// Each piece that two candidates cover is covered by two stations; what the loss of a station
// parts, the same candidate's loss parts among all candidates. Time O(stations x their links), and
// O(candidates x their neighbours) for each parting station.
Survival check_survival(const NetworkToLose& network);

}  // namespace vfplan
