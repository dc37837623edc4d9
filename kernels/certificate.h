// The proof of a lower bound: that no plan over the candidates has fewer stations than a number
// (docs/planning.md, "Bounds and certificates").
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kernels/names.h"

namespace vfplan {

// What a line says of every plan of a network, whatever its set W of candidates. A plan is told by
// x(c) = 1 where c is a station; by its root, its first station among those of which every plan has
// one, r(c) = 1 for that; and by a tree of links outward from there, y(b, c) = 1 where it goes
// from b to c: so x(c) = y(into c) + r(c). N(W) are the candidates that overlap enough with one of
// W and are not in it.
enum class LineKind : std::uint8_t {
    cover,     // x(those that cover piece `of`) >= 1
    nodes,     // x(N(W), those not in W that cover `of`, root candidates in W) >= 1
    nodes_of,  // x(N(W), root candidates in W) - x(of) >= 0, where `of` is in W
    root,      // r(root candidates) = 1
    pair,      // x(of) - y(of, w) - y(w, of) >= 0, where W = {w} overlaps enough with `of`
    first,     // r(root candidates up to `of`) - x(of) >= 0, where `of` is one of them
    arcs,      // y(into W) + r(W) + x(those not in W that cover `of`) >= 1
    arcs_of,   // y(into W) + r(W) - x(of) >= 0, where `of` is in W
};
template <>
struct Names<LineKind> {
    static constexpr std::array<std::string_view, 8> all = {
        "cover", "nodes", "nodes_of", "root", "pair", "first", "arcs", "arcs_of"};
};

// Whether such a line is of a piece; others are of a candidate, `root` of nothing.
constexpr bool is_of_piece(LineKind kind) {
    return kind == LineKind::cover || kind == LineKind::nodes || kind == LineKind::arcs;
}

struct ProofLine {
    LineKind kind = LineKind::cover;
    std::int32_t of = -1;              // a piece or a candidate
    std::vector<std::int32_t> within;  // W, ascending
};

struct LineWeight {
    std::int32_t line = 0;
    std::int64_t weight = 0;  // in parts of proof_scale; not negative where the line is no equation
};
inline constexpr std::int64_t proof_scale = std::int64_t{1} << 24;

// A node of a tree of cases, in the order of a walk: first the case itself, then, where it is
// divided, the whole tree of the case without `branch`, then that of the case with it.
struct ProofCase {
    std::int32_t branch = -1;         // a candidate; -1 for a leaf
    std::vector<LineWeight> weights;  // of a leaf
};

// The candidate `gone` is not needed, because `by` stands for it.
struct GoneCandidate {
    std::int32_t gone = 0;
    std::int32_t by = 0;
};

struct NetworkProof {
    std::int64_t bound = 0;  // stations that the network needs, at least
    std::vector<GoneCandidate> gone;
    // Every plan has one of the root candidates: those that cover the piece, or the one station
    // that must stand. At most one of the two is told.
    std::int32_t root_piece = -1;
    std::int32_t root_station = -1;
    std::vector<ProofLine> lines;
    std::vector<ProofCase> cases;
};

// Networks in their order.
struct Certificate {
    std::vector<NetworkProof> networks;

    std::int64_t bound() const {
        std::int64_t sum = 0;
        for (const NetworkProof& n : networks) sum += n.bound;
        return sum;
    }
};

}  // namespace vfplan
