#include "engine/search/problem.h"

#include <algorithm>
#include <numeric>

namespace vfplan {

bool is_plan(const Problem& problem, const Choice& choice) {
    std::vector<std::uint8_t> waiting(idx(problem.columns()), 0);
    std::vector<std::uint8_t> covered(idx(problem.rows()), 0);
    for (const std::int32_t c : choice) {
        waiting[idx(c)] = 1;
        for (const std::int32_t r : problem.rows_of.of(c)) covered[idx(r)] = 1;
    }
    if (std::find(covered.begin(), covered.end(), 0) != covered.end()) return false;
    for (std::int32_t c = 0; c < problem.columns(); ++c) {
        if (problem.fixed[idx(c)] != 0 && waiting[idx(c)] == 0) return false;
    }
    if (choice.empty()) return true;
    std::vector<std::int32_t> queue = {choice.front()};
    waiting[idx(choice.front())] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        for (const std::int32_t n : problem.near.of(queue[i])) {
            if (waiting[idx(n)] == 0) continue;
            waiting[idx(n)] = 0;
            queue.push_back(n);
        }
    }
    return queue.size() == choice.size();
}

}  // namespace vfplan
