// Candidates, stations and links: what the planner chooses from and what it chose.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kernels/certificate.h"
#include "kernels/names.h"
#include "kernels/overlap.h"
#include "kernels/vec.h"

namespace vfplan {

// Why a point became a candidate.
enum class CandidateKind : std::uint8_t {
    joint,      // where ridges meet
    middle,     // of a ridge without joints
    ring,       // one of two opposite points of a closed ridge
    end,        // of a ridge, where it adds coverage
    split,      // inserted on a ridge for overlap
    rescue,     // sees a piece that no other candidate covers
    connector,  // inserted between components of the overlap graph
    required,   // asked for by the user
    existing,   // a scan that already exists
    pool,       // off the ridges (docs/method.md 6)
};

template <>
struct Names<CandidateKind> {
    static constexpr std::array<std::string_view, 10> all = {
        "joint",  "middle",    "ring",     "end",      "split",
        "rescue", "connector", "required", "existing", "pool"};
};

struct Candidate {
    Vec2d at{0, 0};          // site frame, metres
    std::int64_t cell = -1;  // of the grid; -1 for a point that is no cell's centre
    CandidateKind kind = CandidateKind::joint;
    float vf_rad = 0;  // VF there
};

// The candidates that a plan is made of. A bound holds over these alone, so they are told beside
// each.
enum class CandidatePool : std::uint8_t {
    axis,  // those of the skeleton, and what rescues and joins
    pool,  // these and more, off the ridges
};
template <>
struct Names<CandidatePool> {
    static constexpr std::array<std::string_view, 2> all = {"axis", "pool"};
};

// How a piece fares, before and after planning.
enum class PieceStatus : std::uint8_t {
    covered,         // by a station of the main network
    no_viewpoint,    // no free cell sees enough of it
    off_candidates,  // a free cell sees it, but no candidate does
    unreached,       // seen only from networks that cannot be joined to the main one
};

template <>
struct Names<PieceStatus> {
    static constexpr std::array<std::string_view, 4> all = {"covered", "no_viewpoint",
                                                            "off_candidates", "unreached"};
};

// A chosen candidate.
struct Station {
    std::int32_t candidate = -1;
    std::int32_t network = 0;  // 0 is the main one
    std::int32_t order = 0;    // in which it was chosen, from 0
    double new_length_m = 0;   // covered by it and by no station chosen before it
    double seen_length_m = 0;  // covered by it
    // What it is to the plan.
    double only_length_m = 0;   // covered by it and no other station
    bool articulation = false;  // its network falls apart without it
    bool bridge_end = false;    // a link of it is the only way between its two sides
    double needed_overlap = 0;  // weakest link at it that its network's strongest tree runs along
};

// Two stations that overlap by at least the threshold. Indices of stations, from < to.
struct Link {
    std::int32_t from = 0;
    std::int32_t to = 0;
    double overlap = 0;                                // by the ratio of the job
    std::array<double, overlap_ratio_count> ratios{};  // all of them, in the order of OverlapRatio
};

struct Plan {
    std::vector<Station> stations;
    std::vector<Link> links;
    std::vector<PieceStatus> pieces;
    Certificate certificate;  // of how few stations could do
};

}  // namespace vfplan
