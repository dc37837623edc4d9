#include "engine/plan/refine.h"

#include <algorithm>

#include "engine/graphs/cuts.h"
#include "engine/plan/network_problem.h"
#include "engine/search/reduce.h"
#include "engine/search/search.h"

namespace vfplan {
namespace {

// The same choice in a reduced problem: what went is replaced by what stands for it.
Choice reduced_choice(const Reduced& reduced, std::int32_t columns, const Choice& whole) {
    std::vector<std::int32_t> by(idx(columns));
    for (std::int32_t c = 0; c < columns; ++c) by[idx(c)] = c;
    for (auto g = reduced.gone.rbegin(); g != reduced.gone.rend(); ++g) {
        by[idx(g->gone)] = by[idx(g->by)];
    }
    std::vector<std::int32_t> number(idx(columns), -1);
    for (std::size_t i = 0; i < reduced.column.size(); ++i) {
        number[idx(reduced.column[i])] = static_cast<std::int32_t>(i);
    }
    Choice out;
    for (const std::int32_t c : whole) out.push_back(number[idx(by[idx(c)])]);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

Choice improved(const Threads& threads, const Problem& whole, Reduce what, const Choice& start,
                const SearchOptions& options) {
    const Reduced reduced = reduce(whole, what);
    const Choice from = reduced_choice(reduced, whole.columns(), start);
    Choice out;
    for (const std::int32_t c : search(threads, reduced.problem, from, options)) {
        out.push_back(reduced.column[idx(c)]);
    }
    return out;
}

Chosen candidates_of(const Network& network, const Choice& choice) {
    Chosen out;
    for (const std::int32_t c : choice) out.push_back(network.members[idx(c)]);
    return out;
}

void refine_one(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                Problem problem, std::uint64_t seed, Network& network) {
    Choice choice;
    for (const std::int32_t c : network.chosen) {
        choice.push_back(static_cast<std::int32_t>(
            std::lower_bound(network.members.begin(), network.members.end(), c) -
            network.members.begin()));
    }
    std::sort(choice.begin(), choice.end());
    choice = improved(threads, problem, Reduce::rows_and_columns, choice, {options.effort, seed});
    network.connected = candidates_of(network, choice);
    if (options.loops && choice.size() > 1) {
        problem.block = find_cuts(induced(in.graph, network.members)).block;
        problem.loose.assign(idx(problem.columns()), 1);
        choice = improved(threads, problem, Reduce::rows, choice, {options.effort, seed});
    }
    network.chosen = candidates_of(network, choice);
}

}  // namespace

void refine(const Threads& threads, const PlanInput& in, const PlanOptions& options,
            const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
            std::vector<Network>& networks) {
    threads.for_each(
        static_cast<std::int64_t>(networks.size()), 1, [&](std::int64_t from, std::int64_t to) {
            NetworkProblems problems(in);
            for (std::int64_t n = from; n < to; ++n) {
                Network& network = networks[idx(n)];
                refine_one(threads, in, options,
                           problems.of(network.members, owner, static_cast<std::int32_t>(n), fixed),
                           static_cast<std::uint64_t>(n), network);
            }
        });
}

}  // namespace vfplan
