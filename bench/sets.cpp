#include "bench/sets.h"

#include <algorithm>
#include <map>
#include <memory>
#include <queue>

#include "bench/networks.h"
#include "engine/search/dice.h"
#include "engine/search/reduce.h"

namespace vfplan::bench {
namespace {

constexpr std::size_t dense_most_bytes = std::size_t{1} << 26;

}  // namespace

Sets::Sets(Sparse of, std::vector<double> lengths)
    : lists(std::move(of)),
      listed_by(transposed(lists, static_cast<std::int32_t>(lengths.size()))),
      blocks(lists),
      words(lengths.size() / 64 + 1),
      length_m(std::move(lengths)),
      covered(length_m.size(), 0),
      open_bits(words, 0),
      open_m(length_m),
      all_there(words, ~std::uint64_t{0}),
      there(length_m.size(), 1) {
    if (words * 8 * idx(lists.size()) <= dense_most_bytes) {
        dense.assign(words * idx(lists.size()), 0);
    }
    for (std::int32_t i = 0; i < lists.size(); ++i) {
        signature.push_back(0);
        for (const std::int32_t n : lists.of(i)) {
            signature.back() |= bit(n);
            if (!dense.empty()) dense[words * idx(i) + idx(n / 64)] |= bit(n);
        }
    }
    const std::int32_t stride = std::max(1, lists.size() / 5000);
    for (std::int32_t i = 0; i < lists.size(); i += stride) asked.push_back(i);
    start_plan();
}

// A cover by the greedy rule; half of it is the state that gains are asked in.
void Sets::start_plan() {
    std::vector<std::uint8_t> seen(length_m.size(), 0);
    const auto gain = [&](std::int32_t i) {
        const auto list = lists.of(i);
        return std::count_if(list.begin(), list.end(),
                             [&](std::int32_t n) { return seen[idx(n)] == 0; });
    };
    std::priority_queue<std::pair<std::int64_t, std::int32_t>> queue;
    for (std::int32_t i = 0; i < lists.size(); ++i) queue.emplace(gain(i), i);
    std::vector<std::int32_t> plan;
    while (!queue.empty()) {
        const auto [was, i] = queue.top();
        queue.pop();
        const std::int64_t now = gain(i);
        if (now < was && now > 0) queue.emplace(now, i);
        if (now < was || now == 0) continue;
        for (const std::int32_t n : lists.of(i)) seen[idx(n)] = 1;
        plan.push_back(i);
    }
    Dice dice(1);
    dice.shuffle(plan);
    std::vector<std::uint8_t> chosen(idx(lists.size()), 0);
    for (const std::int32_t i : plan) chosen[idx(i)] = 1;
    for (std::size_t k = 0; k < plan.size() / 2; ++k) {
        for (const std::int32_t n : lists.of(plan[k])) covered[idx(n)] = 1;
    }
    for (std::size_t n = 0; n < covered.size(); ++n) {
        if (covered[n] != 0) open_m[n] = 0;
        if (covered[n] == 0) open_bits[n / 64] |= bit(static_cast<std::int32_t>(n));
    }
    ruined.push_back(plan);  // taken and put once as a whole
    // So many that what a run makes ready and hands back does not count beside them.
    for (std::size_t k = 0; k < 4000 && !plan.empty(); ++k) {
        const std::int32_t seed = plan[k % plan.size()];
        std::vector<std::int32_t> ball = {seed};
        for (const std::int32_t n : lists.of(seed)) {
            for (const std::int32_t c : listed_by.of(n)) {
                if (chosen[idx(c)] != 0 && ball.size() < 8 &&
                    std::find(ball.begin(), ball.end(), c) == ball.end()) {
                    ball.push_back(c);
                }
            }
        }
        ruined.push_back(std::move(ball));
    }
}

const Sets* sets(const std::string& site, const std::string& kind) {
    static std::map<std::string, std::unique_ptr<Sets>> all;
    std::unique_ptr<Sets>& s = all[site + kind];
    const MainNetwork* n = main_network(site);
    if (s || n == nullptr) return s.get();
    if (kind == "table") {
        s = std::make_unique<Sets>(n->table, n->piece_length_m);
    } else if (kind == "network") {
        s = std::make_unique<Sets>(n->problem.rows_of, n->row_length_m);
    } else if (kind == "rows") {
        s = std::make_unique<Sets>(n->problem.columns_of,
                                   std::vector<double>(idx(n->problem.columns()), 1.0));
    } else {
        const Reduced reduced = reduce(n->problem);
        std::vector<double> length;
        for (const std::int32_t r : reduced.row) length.push_back(n->row_length_m[idx(r)]);
        s = std::make_unique<Sets>(reduced.problem.rows_of, std::move(length));
    }
    return s.get();
}

}  // namespace vfplan::bench
