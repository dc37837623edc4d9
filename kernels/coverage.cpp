#include "kernels/coverage.h"

#include <algorithm>
#include <cmath>

#include "kernels/angle.h"

namespace vfplan {
namespace {

struct Part {
    std::int32_t piece;
    double length_m;
    double angle_rad;
};

}  // namespace

Pieces cut_into_pieces(const std::vector<Wall>& walls, double partition_m) {
    Pieces out;
    out.first_of.assign(2 * walls.size(), -1);
    out.count_of.assign(2 * walls.size(), 0);
    for (std::size_t w = 0; w < walls.size(); ++w) {
        if (!walls[w].scanned) continue;
        const double length = walls[w].length_m();
        const auto n =
            static_cast<std::int32_t>(std::max(1.0, std::ceil(length / partition_m - 1e-9)));
        for (const Side side : {left, right}) {
            if (!walls[w].free_side[side]) continue;
            out.first_of[2 * w + side] = static_cast<std::int32_t>(out.wall.size());
            out.count_of[2 * w + side] = n;
            for (std::int32_t k = 0; k < n; ++k) {
                out.wall.push_back(static_cast<std::int32_t>(w));
                out.side.push_back(side);
                out.s0_m.push_back(length * k / n);
                out.s1_m.push_back(length * (k + 1) / n);
            }
        }
    }
    return out;
}

CoverageRow coverage_row(const std::vector<Wall>& walls, const Pieces& pieces, const Vec2d& eye,
                         const View& observed, double visible_fraction) {
    std::vector<Part> parts;
    for (const Span& span : observed) {
        const auto w = static_cast<std::size_t>(span.wall);
        const std::size_t face = 2 * w + span.side;
        if (pieces.first_of[face] < 0) continue;
        const Wall& wall = walls[w];
        const double length = wall.length_m();
        const Vec2d e = (wall.b - wall.a) / length;
        const double foot = (eye - wall.a).dot(e);
        const double height = std::abs(cross(e, eye - wall.a));
        const double from = std::min(span.s_begin_m, span.s_end_m);
        const double to = std::max(span.s_begin_m, span.s_end_m);
        const std::int32_t n = pieces.count_of[face];
        const auto clamp = [&](double v) {
            return static_cast<std::int32_t>(std::clamp(std::floor(v), 0.0, n - 1.0));
        };
        for (std::int32_t k = clamp(from / length * n); k <= clamp(to / length * n); ++k) {
            const std::int32_t piece = pieces.first_of[face] + k;
            const double lo = std::max(from, pieces.s0_m[static_cast<std::size_t>(piece)]);
            const double hi = std::min(to, pieces.s1_m[static_cast<std::size_t>(piece)]);
            if (!(hi > lo)) continue;
            parts.push_back(
                {piece, hi - lo,
                 angle_upper_rad(height * (hi - lo), height * height + (lo - foot) * (hi - foot))});
        }
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& p, const Part& q) { return p.piece < q.piece; });
    CoverageRow row;
    for (std::size_t i = 0; i < parts.size();) {
        Part sum = parts[i];
        for (++i; i < parts.size() && parts[i].piece == sum.piece; ++i) {
            sum.length_m += parts[i].length_m;
            sum.angle_rad += parts[i].angle_rad;
        }
        const double fraction = std::min(1.0, sum.length_m / pieces.length_m(sum.piece));
        if (fraction + 1e-9 < visible_fraction) continue;
        row.push_back({sum.piece, static_cast<float>(fraction), static_cast<float>(sum.angle_rad)});
    }
    return row;
}

void CoverageTable::add(const CoverageRow& row) {
    seen.insert(seen.end(), row.begin(), row.end());
    begin.push_back(static_cast<std::int64_t>(seen.size()));
}

InvertedIndex invert(const CoverageTable& table, std::int64_t pieces) {
    InvertedIndex out;
    out.begin.assign(static_cast<std::size_t>(pieces) + 1, 0);
    for (const Seen& s : table.seen) ++out.begin[static_cast<std::size_t>(s.piece) + 1];
    for (std::size_t p = 0; p < static_cast<std::size_t>(pieces); ++p) {
        out.begin[p + 1] += out.begin[p];
    }
    out.row.resize(table.seen.size());
    std::vector<std::int64_t> next(out.begin.begin(), out.begin.end() - 1);
    for (std::int64_t r = 0; r < table.rows(); ++r) {
        for (const Seen* s = table.row_begin(r); s != table.row_end(r); ++s) {
            out.row[static_cast<std::size_t>(next[static_cast<std::size_t>(s->piece)]++)] =
                static_cast<std::int32_t>(r);
        }
    }
    return out;
}

}  // namespace vfplan
