#include "engine/proofs/multipliers.h"

#include <algorithm>
#include <cmath>

#include "kernels/certificate.h"

namespace vfplan {

std::vector<std::int64_t> weigh_rows(const Problem& p, std::int64_t stations, std::int64_t rounds,
                                     WeighUntil until) {
    const std::size_t rows = idx(p.rows());
    // What a fixed column covers weighs nothing.
    std::vector<std::uint8_t> open(rows, 1);
    std::int64_t fixed = 0;
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        if (p.fixed[idx(c)] == 0) continue;
        ++fixed;
        for (const std::int32_t r : p.rows_of.of(c)) open[idx(r)] = 0;
    }
    std::vector<double> u(rows, 0);
    for (std::size_t r = 0; r < rows; ++r) {
        if (open[r] == 0) continue;
        double least = 1;
        for (const std::int32_t c : p.columns_of.of(static_cast<std::int32_t>(r))) {
            least = std::min(least, 1 / static_cast<double>(p.rows_of.of(c).size()));
        }
        u[r] = least;
    }
    std::vector<double> best_u = u;
    std::vector<double> way(rows, 0);  // the direction, with what is left of those before
    std::vector<double> slack(rows);
    const double goal = static_cast<double>(stations - fixed);
    double best = -1e300;
    double pace = 1;
    std::int64_t since = 0;
    for (std::int64_t round = 0; round < rounds; ++round) {
        double value = 0;
        for (std::size_t r = 0; r < rows; ++r) {
            slack[r] = open[r];
            value += u[r];
        }
        for (std::int32_t c = 0; c < p.columns(); ++c) {
            if (p.fixed[idx(c)] != 0) continue;
            double cost = 1;
            for (const std::int32_t r : p.rows_of.of(c)) cost -= u[idx(r)];
            if (cost >= 0) continue;
            value += cost;
            for (const std::int32_t r : p.rows_of.of(c)) slack[idx(r)] -= open[idx(r)];
        }
        if (value > best + 1e-4 * std::max(1.0, std::abs(best))) since = 0;
        if (value > best) {
            best = value;
            best_u = u;
        }
        if (until == WeighUntil::proven && best > goal - 1 + 1e-6) break;
        if (++since > 15) {
            pace *= 0.7;
            since = 0;
            u = best_u;
            std::fill(way.begin(), way.end(), 0.0);
            if (pace < 1e-3) break;
            continue;
        }
        double length = 0;
        for (std::size_t r = 0; r < rows; ++r) {
            if (u[r] == 0 && slack[r] < 0) slack[r] = 0;
            way[r] = slack[r] + 0.6 * way[r];
            length += way[r] * way[r];
        }
        if (length == 0) break;
        const double step = pace * (1.02 * goal - value) / length;
        for (std::size_t r = 0; r < rows; ++r) u[r] = std::max(0.0, u[r] + step * way[r]);
    }
    std::vector<std::int64_t> out(rows);
    for (std::size_t r = 0; r < rows; ++r) {
        out[r] = std::llround(std::ldexp(best_u[r], 24));
    }
    return out;
}

}  // namespace vfplan
