// Rows of places that may reach from one set of places into another, and the search for pairs of
// them across sets: the heart of chains.cpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/joining/chains.h"
#include "engine/runtime/parallel.h"
#include "kernels/overlap_rows.h"

namespace vfplan {

inline constexpr std::int64_t rows_at_once = 16;

// Bounds of overlaps are off by less.
inline constexpr double overlap_rounding = 1e-9;

// The rows of those who may reach into another set, and of these only the pieces that are seen from
// several sets: what two sets share is in there, whole and in order.
struct Contested {
    OverlapRows rows;                    // set by set
    std::vector<std::int32_t> node;      // of each row
    std::vector<std::int32_t> next_set;  // of each row, the first row of the set after its own
};

// `set` and `kind` of each node: nodes of one kind in one set stand for each other. Who cannot
// overlap anyone by `least` is left out, and who is of no set.
Contested contested_of(const JoinProblem& p, const std::vector<SeenTotal>& totals,
                       const std::vector<std::int32_t>& set, const std::vector<std::int32_t>& kind,
                       double least);

// How often across() looks at a row for a piece of another.
std::int64_t pairs_across(const Contested& contested, std::int64_t pieces);

// Calls f(block, a, b, overlap) for nodes a < b of different sets that share a piece, from any
// thread; a block is one thread's at a time. at_least(a, b): overlaps below it need not come.
template <class AtLeast, class F>
void across(const Threads& threads, const JoinProblem& p, const std::vector<SeenTotal>& totals,
            const Contested& contested, AtLeast&& at_least, F&& f) {
    const std::vector<double>& length_m = p.local.piece_length_m;
    const PieceIndex index = index_of(contested.rows, static_cast<std::int64_t>(length_m.size()));
    const std::vector<SeenTotal> parts = seen_totals(contested.rows, length_m);
    const std::int64_t blocks = (contested.rows.size() + rows_at_once - 1) / rows_at_once;
    const bool by_angle = formula(p.rule.ratio).by_angle;
    threads.for_each(blocks, 1, [&](std::int64_t from, std::int64_t to) {
        SharedLengths shared;
        for (std::int64_t i = from * rows_at_once; i < to * rows_at_once; ++i) {
            // Rows from everywhere first: what is found early spares looking for less.
            const std::int64_t block = i / rows_at_once;
            const std::int64_t r = (i % rows_at_once) * blocks + block;
            if (r >= contested.rows.size()) continue;
            const auto row = static_cast<std::int32_t>(r);
            const std::int32_t a = contested.node[idx(r)];
            const SeenTotal& x = parts[idx(r)];
            for (const std::int32_t piece : contested.rows.row(row)) {
                const std::span<const std::int32_t> viewers = index.rows_of(piece);
                for (auto n = std::lower_bound(viewers.begin(), viewers.end(),
                                               contested.next_set[idx(r)]);
                     n != viewers.end(); ++n) {
                    const std::int32_t b = contested.node[idx(*n)];
                    const SeenTotal& y = parts[idx(*n)];
                    const SeenJointly most{std::min(x.length_m, y.length_m), x.angle_rad,
                                           y.angle_rad};
                    if (overlap(p.rule.ratio, totals[idx(a)], totals[idx(b)], most) >=
                        at_least(a, b) - overlap_rounding) {
                        shared.add(*n, length_m[idx(piece)]);
                    }
                }
            }
            shared.take([&](std::int32_t n, double length) {
                const std::int32_t b = contested.node[idx(n)];
                const SeenJointly joint = by_angle
                                              ? seen_jointly(contested.rows.seen(row, length_m),
                                                             contested.rows.seen(n, length_m))
                                              : SeenJointly{length, 0, 0};
                const double o = overlap(p.rule.ratio, totals[idx(a)], totals[idx(b)], joint);
                f(block, std::min(a, b), std::max(a, b), o);
            });
        }
    });
}

}  // namespace vfplan
