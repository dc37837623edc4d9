#include "engine/check/survival_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "kernels/index.h"

namespace vfplan {
namespace {

// Numbers what hangs together of the members that are `in`, without one of them; -1 elsewhere.
template <class In>
std::int32_t number_parts(const NetworkToLose& n, std::int32_t without, const In& in,
                          std::vector<std::int32_t>& part) {
    for (const std::int32_t c : n.members) part[idx(c)] = -1;
    std::int32_t parts = 0;
    std::vector<std::int32_t> queue;
    for (const std::int32_t seed : n.members) {
        if (!in(seed) || seed == without || part[idx(seed)] >= 0) continue;
        queue.assign(1, seed);
        part[idx(seed)] = parts;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const std::int32_t k : n.near[idx(queue[i])]) {
                if (!in(k) || k == without || part[idx(k)] >= 0) continue;
                part[idx(k)] = parts;
                queue.push_back(k);
            }
        }
        ++parts;
    }
    return parts;
}

}  // namespace

Survival check_survival(const NetworkToLose& n) {
    Survival out;
    std::vector<std::int32_t> could(n.owner.size(), 0);
    std::vector<std::int32_t> does(n.owner.size(), 0);
    for (const std::int32_t c : n.members) {
        for (const std::int32_t p : n.rows.row(c)) {
            if (n.owner[idx(p)] != n.mine) continue;
            ++could[idx(p)];
            does[idx(p)] += n.chosen[idx(c)];
        }
    }
    for (std::size_t p = 0; p < could.size(); ++p) {
        if (could[p] == 1) ++out.pieces_alone;
        if (could[p] > 1 && does[p] < 2 && out.wrong.empty()) {
            out.wrong = fmt::format("piece {} is lost with one station, and need not be", p);
        }
    }
    std::vector<std::int32_t> of_plan(n.near.size(), -1);
    std::vector<std::int32_t> of_all(n.near.size(), -1);
    const auto stands = [&](std::int32_t c) { return n.chosen[idx(c)] != 0; };
    for (const std::int32_t lost : n.members) {
        if (!stands(lost) || number_parts(n, lost, stands, of_plan) < 2) continue;
        ++out.parting;
        const auto all = number_parts(
            n, lost, [](std::int32_t) { return true; }, of_all);
        std::vector<std::int32_t> met(idx(all), -1);  // the plan's part in each of these
        for (const std::int32_t c : n.members) {
            if (!stands(c) || c == lost) continue;
            std::int32_t& known = met[idx(of_all[idx(c)])];
            if (known < 0) known = of_plan[idx(c)];
            if (known != of_plan[idx(c)] && out.wrong.empty()) {
                out.wrong = fmt::format(
                    "the loss of the station at candidate {} parts it, and need not", lost);
            }
        }
    }
    return out;
}

}  // namespace vfplan
