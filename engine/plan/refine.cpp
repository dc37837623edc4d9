#include "engine/plan/refine.h"

#include "engine/graphs/cuts.h"
#include "engine/plan/network_problem.h"
#include "engine/search/reduce.h"
#include "engine/search/search.h"

namespace vfplan {
namespace {

Choice searched(const Threads& threads, const Problem& whole, Reduce what, const Choice& start,
                const SearchOptions& options) {
    const Reduced reduced = reduce(whole, what);
    const Choice from = reduced_choice(reduced, whole.columns(), start);
    Choice out;
    for (const std::int32_t c : search(threads, reduced.problem, from, options)) {
        out.push_back(reduced.column[idx(c)]);
    }
    return out;
}

// A network's better plan, where loops count or do not.
Chosen refined(const Threads& threads, const PlanInput& in, const SearchOptions& options,
               Problem problem, bool loops, const Network& network) {
    const Choice choice = columns_of(network.members, network.chosen);
    if (loops) {
        problem.block = find_cuts(induced(in.graph, network.members)).block;
        problem.loose.assign(idx(problem.columns()), 1);
    }
    Chosen out;
    for (const std::int32_t c : searched(
             threads, problem, loops ? Reduce::rows : Reduce::rows_and_columns, choice, options)) {
        out.push_back(network.members[idx(c)]);
    }
    return out;
}

}  // namespace

void refine(const Threads& threads, const PlanInput& in, const PlanOptions& options,
            const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
            std::vector<Network>& networks) {
    // Both plans of a network start from the same one, so that they can be searched at once.
    const std::int64_t plans = options.loops ? 2 : 1;
    std::vector<Chosen> found(networks.size() * idx(plans));
    threads.for_each(
        static_cast<std::int64_t>(found.size()), 1, [&](std::int64_t from, std::int64_t to) {
            NetworkProblems problems(in);
            for (std::int64_t task = from; task < to; ++task) {
                const std::int64_t n = task / plans;
                found[idx(task)] =
                    refined(threads, in, {options.effort, static_cast<std::uint64_t>(n)},
                            problems.of(networks[idx(n)].members, owner,
                                        static_cast<std::int32_t>(n), fixed),
                            task % plans > 0, networks[idx(n)]);
            }
        });
    for (std::size_t n = 0; n < networks.size(); ++n) {
        const std::size_t first = n * idx(plans);
        networks[n].chosen = std::move(found[first + idx(plans) - 1]);
        networks[n].connected = networks[n].chosen;
        if (options.loops && found[first].size() < networks[n].connected.size()) {
            networks[n].connected = std::move(found[first]);
        }
    }
}

}  // namespace vfplan
