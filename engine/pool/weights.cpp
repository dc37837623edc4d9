#include "engine/pool/weights.h"

#include <algorithm>
#include <queue>
#include <utility>

#include "engine/proofs/multipliers.h"
#include "engine/search/problem.h"

namespace vfplan {
namespace {

constexpr std::int64_t rounds = 200;

// A number that two candidates hardly share (the finaliser of MurmurHash3).
std::uint64_t mixed(std::uint64_t x) {
    x ^= x >> 33U;
    x *= 0xff51afd7ed558ccdULL;
    x ^= x >> 33U;
    x *= 0xc4ceb9fe1a85ec53ULL;
    return x ^ x >> 33U;
}

// Pieces that the same candidates cover, told by the sum of these candidates' numbers: should two
// sets ever have one sum, their pieces are weighed as one, and nothing else comes of it.
struct Classes {
    std::vector<std::int32_t> of;     // by piece; -1 where nobody covers it
    std::vector<std::int32_t> size;   // by class
    std::vector<std::int32_t> first;  // a piece of it
};

Classes classes_of(const Sparse& rows, std::int64_t pieces) {
    std::vector<std::pair<std::uint64_t, std::int32_t>> sums(idx(pieces));
    for (std::size_t p = 0; p < sums.size(); ++p) sums[p] = {0, static_cast<std::int32_t>(p)};
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        for (const std::int32_t p : rows.of(c)) {
            sums[idx(p)].first += mixed(static_cast<std::uint64_t>(c) + 1);
        }
    }
    std::sort(sums.begin(), sums.end());
    Classes out;
    out.of.resize(idx(pieces), -1);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const auto& [sum, piece] = sums[i];
        if (sum == 0) continue;
        if (i == 0 || sum != sums[i - 1].first) {
            out.size.push_back(0);
            out.first.push_back(piece);
        }
        out.of[idx(piece)] = static_cast<std::int32_t>(out.size.size()) - 1;
        ++out.size.back();
    }
    return out;
}

Problem cover_problem(const Sparse& rows, const Classes& classes) {
    Problem out;
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        for (const std::int32_t p : rows.of(c)) {
            const std::int32_t mine = classes.of[idx(p)];
            if (classes.first[idx(mine)] == p) out.rows_of.to.push_back(mine);
        }
        std::sort(out.rows_of.to.begin() + out.rows_of.begin.back(), out.rows_of.to.end());
        out.rows_of.end_list();
        out.near.end_list();
    }
    out.columns_of = transposed(out.rows_of, static_cast<std::int32_t>(classes.size.size()));
    out.fixed.assign(idx(rows.size()), 0);
    return out;
}

// Stations of a cover by the greedy rule: the column next that covers most that is open.
std::int64_t greedy_cover(const Problem& p) {
    std::vector<std::int32_t> gain;
    std::priority_queue<std::pair<std::int32_t, std::int32_t>> queue;  // gain once, -column
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        gain.push_back(static_cast<std::int32_t>(p.rows_of.of(c).size()));
        queue.emplace(gain.back(), -c);
    }
    std::vector<std::uint8_t> open(idx(p.rows()), 1);
    std::int64_t stations = 0;
    while (!queue.empty() && queue.top().first > 0) {
        const auto [then, minus] = queue.top();
        queue.pop();
        const std::int32_t c = -minus;
        if (gain[idx(c)] < then) {
            queue.emplace(gain[idx(c)], minus);
            continue;
        }
        ++stations;
        for (const std::int32_t r : p.rows_of.of(c)) {
            if (open[idx(r)] == 0) continue;
            open[idx(r)] = 0;
            for (const std::int32_t other : p.columns_of.of(r)) --gain[idx(other)];
        }
    }
    return stations;
}

}  // namespace

std::vector<std::int64_t> weigh_pieces(const Sparse& rows, std::int64_t pieces) {
    const Classes classes = classes_of(rows, pieces);
    const Problem problem = cover_problem(rows, classes);
    const std::vector<std::int64_t> weight =
        weigh_rows(problem, greedy_cover(problem), rounds, WeighUntil::spent);
    std::vector<std::int64_t> out(idx(pieces), 0);
    for (std::size_t p = 0; p < out.size(); ++p) {
        const std::int32_t mine = classes.of[p];
        if (mine >= 0) out[p] = weight[idx(mine)] / classes.size[idx(mine)];
    }
    return out;
}

}  // namespace vfplan
