#include "engine/joining/contested.h"

#include <map>
#include <tuple>
#include <utility>

#include "engine/joining/meetings.h"
#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Whether a place that shares some of its pieces may overlap another by as much: one that sees just
// these, and from as near as can be.
bool may_reach(const JoinProblem& p, const SeenTotal& total, const SeenRow& row,
               const std::vector<std::int32_t>& some, double least) {
    SeenTotal part;
    for (std::size_t i = 0, k = 0; i < row.piece.size() && k < some.size(); ++i) {
        if (row.piece[i] != some[k]) continue;
        ++k;
        part.length_m += row.length_of(i);
        if (!row.angle_rad.empty()) part.angle_rad += static_cast<double>(row.angle_rad[i]);
    }
    const SeenTotal other{part.length_m, 2 * pi};
    return overlap(p.rule.ratio, total, other, {part.length_m, part.angle_rad, other.angle_rad}) >=
           least - overlap_rounding;
}

}  // namespace

Contested contested_of(const JoinProblem& p, const std::vector<SeenTotal>& totals,
                       const std::vector<std::int32_t>& set, const std::vector<std::int32_t>& kind,
                       double least) {
    const OverlapRows& all = p.local.rows;
    const std::vector<double>& length_m = p.local.piece_length_m;
    std::vector<std::int32_t> seen_from(p.local.piece_length_m.size(), sees_nothing);
    for (std::int32_t n = 0; n < all.size(); ++n) {
        if (set[idx(n)] == left_out) continue;
        for (const std::int32_t piece : all.row(n)) {
            std::int32_t& from = seen_from[idx(piece)];
            from = seen_together(from, set[idx(n)]);
        }
    }
    const auto shared = [&](std::int32_t piece) { return seen_from[idx(piece)] == sees_several; };
    // Of equal rows in one set, by lengths, the one that sees least besides overlaps most.
    const bool by_angle = formula(p.rule.ratio).by_angle;
    std::vector<std::int32_t> kept;
    std::map<std::tuple<std::int32_t, std::int32_t, std::vector<std::int32_t>>, std::int32_t> best;
    for (std::int32_t n = 0; n < all.size(); ++n) {
        if (set[idx(n)] == left_out) continue;
        std::vector<std::int32_t> pieces;
        for (const std::int32_t piece : all.row(n)) {
            if (shared(piece)) pieces.push_back(piece);
        }
        if (pieces.empty() || !may_reach(p, totals[idx(n)], all.seen(n, length_m), pieces, least)) {
            continue;
        }
        if (by_angle) {
            kept.push_back(n);
            continue;
        }
        const auto [known, news] =
            best.emplace(std::tuple(set[idx(n)], kind[idx(n)], std::move(pieces)), n);
        if (!news && totals[idx(n)].length_m < totals[idx(known->second)].length_m) {
            known->second = n;
        }
    }
    for (const auto& [key, n] : best) kept.push_back(n);
    std::sort(kept.begin(), kept.end(), [&](std::int32_t a, std::int32_t b) {
        return std::pair(set[idx(a)], a) < std::pair(set[idx(b)], b);
    });
    Contested out;
    for (const std::int32_t n : kept) {
        const SeenRow row = all.seen(n, {});
        for (std::size_t i = 0; i < row.piece.size(); ++i) {
            if (!shared(row.piece[i])) continue;
            out.rows.piece.push_back(row.piece[i]);
            if (!row.angle_rad.empty()) out.rows.angle_rad.push_back(row.angle_rad[i]);
        }
        out.rows.begin.push_back(static_cast<std::int64_t>(out.rows.piece.size()));
        out.node.push_back(n);
    }
    out.next_set.resize(kept.size());
    for (std::size_t r = kept.size(), next = r; r-- > 0;) {
        if (r + 1 < kept.size() && set[idx(kept[r])] != set[idx(kept[r + 1])]) next = r + 1;
        out.next_set[r] = static_cast<std::int32_t>(next);
    }
    return out;
}

std::int64_t pairs_across(const Contested& contested, std::int64_t pieces) {
    const PieceIndex index = index_of(contested.rows, pieces);
    std::int64_t sum = 0;
    for (std::int32_t r = 0; r < contested.rows.size(); ++r) {
        for (const std::int32_t piece : contested.rows.row(r)) {
            const std::span<const std::int32_t> viewers = index.rows_of(piece);
            sum += viewers.end() -
                   std::lower_bound(viewers.begin(), viewers.end(), contested.next_set[idx(r)]);
        }
    }
    return sum;
}

}  // namespace vfplan
