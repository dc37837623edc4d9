// Coverage tables and graphs made by hand, without geometry.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "engine/plan/greedy.h"
#include "engine/plan/loops.h"
#include "engine/plan/piece_places.h"
#include "engine/plan/workspace.h"

namespace vfplan::test {

struct HandMade {
    std::vector<Candidate> candidates;
    std::vector<double> length_m;  // of each piece
    std::vector<PieceStatus> status;
    OverlapRows rows;
    Graph graph;

    std::int32_t pieces() const { return static_cast<std::int32_t>(length_m.size()); }
    PlanInput input() const { return {candidates, rows, length_m, status, graph}; }
    // One wall of each piece's own, without a second side.
    PiecePlaces places(const std::vector<Wall>& walls) const {
        Pieces each;
        for (const double length : length_m) each.add_wall(length, 1, 0);
        return {walls, each};
    }
    std::vector<std::int32_t> everyone() const {
        std::vector<std::int32_t> all(candidates.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
        return all;
    }
    std::vector<std::uint8_t> wanted() const {
        std::vector<std::uint8_t> out(status.size());
        for (std::size_t p = 0; p < out.size(); ++p) out[p] = status[p] == PieceStatus::covered;
        return out;
    }
    bool covers(std::int32_t candidate, std::int32_t piece) const {
        const auto row = rows.row(candidate);
        return std::find(row.begin(), row.end(), piece) != row.end();
    }
    bool covered_by(const Chosen& chosen, std::int32_t piece) const {
        return std::any_of(chosen.begin(), chosen.end(),
                           [&](std::int32_t c) { return covers(c, piece); });
    }
    bool connected(Chosen chosen) const {
        std::sort(chosen.begin(), chosen.end());
        const auto number = components(induced(graph, chosen));
        return std::all_of(number.begin(), number.end(), [](std::int32_t n) { return n == 0; });
    }
};

// The steps on one network, each in a work space of its own.
inline Chosen greedy_alone(const HandMade& h, const std::vector<std::int32_t>& members,
                           const std::vector<std::int32_t>& forced,
                           std::vector<std::uint8_t>& wanted) {
    Workspace work(h.graph);
    return choose_greedily(h.input(), members, forced, wanted, work);
}
inline Chosen loops_alone(const HandMade& h, const Chosen& chosen) {
    Workspace work(h.graph);
    return close_loops(h.input(), chosen, work);
}

// rows[i]: pieces that candidate i covers. Pieces that nobody covers have no viewpoint.
inline HandMade hand_made(const std::vector<double>& lengths,
                          const std::vector<std::vector<std::int32_t>>& rows,
                          std::vector<OverlapPair> edges) {
    HandMade h;
    h.length_m = lengths;
    h.status.assign(lengths.size(), PieceStatus::no_viewpoint);
    for (const auto& row : rows) {
        for (const std::int32_t p : row) {
            h.rows.piece.push_back(p);
            h.rows.angle_rad.push_back(0.1F);
            h.status[static_cast<std::size_t>(p)] = PieceStatus::covered;
        }
        h.rows.begin.push_back(static_cast<std::int64_t>(h.rows.piece.size()));
    }
    h.candidates.resize(rows.size());
    std::sort(edges.begin(), edges.end(), [](const OverlapPair& p, const OverlapPair& q) {
        return std::pair(p.from, p.to) < std::pair(q.from, q.to);
    });
    h.graph = make_graph(static_cast<std::int32_t>(rows.size()), edges);
    return h;
}

// A connected graph over `nodes` candidates that cover runs of pieces.
inline HandMade random_hand_made(std::uint64_t seed, std::int32_t nodes, std::int32_t pieces) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> number(0.3, 1);
    std::vector<double> lengths(static_cast<std::size_t>(pieces));
    for (double& l : lengths) l = number(random);
    std::vector<std::vector<std::int32_t>> rows(static_cast<std::size_t>(nodes));
    for (auto& row : rows) {
        for (std::int32_t p = 0; p < pieces; ++p) {
            if (random() % 5 == 0) row.push_back(p);
        }
    }
    std::vector<OverlapPair> edges;
    for (std::int32_t b = 1; b < nodes; ++b) {
        const auto a = static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(b));
        for (std::int32_t k = 0; k < b; ++k) {
            if (k == a || random() % 8 == 0) edges.push_back({k, b, number(random)});
        }
    }
    return hand_made(lengths, rows, edges);
}

}  // namespace vfplan::test
