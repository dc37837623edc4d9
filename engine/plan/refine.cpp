#include "engine/plan/refine.h"

#include <algorithm>

#include "engine/graphs/cuts.h"
#include "engine/plan/network_problem.h"
#include "engine/search/improve.h"
#include "engine/search/reduce.h"

namespace vfplan {
namespace {

Choice improved(const Problem& whole, Reduce what, const Choice& start, std::int64_t effort,
                std::uint64_t seed) {
    const Reduced reduced = reduce(whole, what);
    const Choice from = reduced_choice(reduced, whole.columns(), start);
    const auto steps = effort * static_cast<std::int64_t>(from.size());
    Choice out;
    for (const std::int32_t c : improve(reduced.problem, from, {steps, seed})) {
        out.push_back(reduced.column[idx(c)]);
    }
    return out;
}

Chosen candidates_of(const Network& network, const Choice& choice) {
    Chosen out;
    for (const std::int32_t c : choice) out.push_back(network.members[idx(c)]);
    return out;
}

void refine_one(const PlanInput& in, const PlanOptions& options, Problem problem,
                std::uint64_t seed, Network& network) {
    Choice choice;
    for (const std::int32_t c : network.chosen) {
        choice.push_back(static_cast<std::int32_t>(
            std::lower_bound(network.members.begin(), network.members.end(), c) -
            network.members.begin()));
    }
    std::sort(choice.begin(), choice.end());
    choice = improved(problem, Reduce::rows_and_columns, choice, options.effort, seed);
    network.connected = candidates_of(network, choice);
    if (options.loops && choice.size() > 1) {
        problem.block = find_cuts(induced(in.graph, network.members)).block;
        problem.loose.assign(idx(problem.columns()), 1);
        choice = improved(problem, Reduce::rows, choice, options.effort, seed);
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
                refine_one(in, options,
                           problems.of(network.members, owner, static_cast<std::int32_t>(n), fixed),
                           static_cast<std::uint64_t>(n), network);
            }
        });
}

}  // namespace vfplan
