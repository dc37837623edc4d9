#include "engine/plan/refine.h"

#include <array>
#include <numeric>

#include "engine/graphs/cuts.h"
#include "engine/plan/certify.h"
#include "engine/search/reduce.h"
#include "engine/search/search.h"
#include "engine/search/settle.h"
#include "engine/search/spacing.h"
#include "engine/search/survive.h"

namespace vfplan {
namespace {

// Where cycles do not count.
Choice searched(const Threads& threads, const Problem& whole, const Choice& start,
                const SearchOptions& options) {
    const Reduced reduced = reduce(whole);
    const Choice from = reduced_choice(reduced, whole.columns(), start);
    Choice out;
    for (const std::int32_t c : search(threads, reduced.problem, from, options)) {
        out.push_back(reduced.column[idx(c)]);
    }
    return out;
}

// Larger plans stay where they were searched.
constexpr std::size_t settled_most = 2000;
constexpr double too_near_cost = 100;  // of overlaps, each of which is 1 at most

// Stations with more overlap make more and shorter ways through the network, and those that stand
// by each other are no use to a surveyor.
Choice settled(const PlanInput& in, const Problem& problem,
               const std::vector<std::int32_t>& members, const Choice& plan) {
    if (plan.size() > settled_most) return plan;
    return settle(problem, plan, [&](std::int32_t c, const Choosing& chosen, std::int32_t without) {
        double score = 0;
        std::size_t k = 0;
        const auto near = problem.near.of(c);
        in.graph.each(members[idx(c)], [&](std::int32_t, double overlap) {
            const std::int32_t n = near[k++];
            if (n != without && chosen.is_chosen(n)) score += overlap;
        });
        if (problem.beside.size() == 0) return score;
        for (const std::int32_t n : problem.beside.of(c)) {
            if (n != without && chosen.is_chosen(n)) score -= too_near_cost;
        }
        return score;
    });
}

// By member those that stand too near by.
Sparse too_near(const PlanInput& in, const std::vector<std::int32_t>& members, double spacing_m) {
    if (spacing_m <= 0) return {};
    std::vector<Vec2d> at;
    for (const std::int32_t c : members) at.push_back(in.candidates[idx(c)].at);
    return nearer_than(at, spacing_m);
}

// Both plans of a network start from the same one, so that they can be searched at once; that with
// loops takes longer, and begins first. The proof goes with the other.
NetworkProof refine_one(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                        const SearchOptions& search, const Problem& problem,
                        const NetworkProblems& problems, Network& network) {
    const Choice start = columns_of(network.members, network.chosen);
    const auto with_loops = [&] {
        Problem p = problem;
        p.block = find_cuts(induced(in.graph, network.members)).block;
        p.loose.assign(idx(p.columns()), 1);
        return settled(in, p, network.members, vfplan::search(threads, p, start, search));
    };
    NetworkProof proof;
    const auto without = [&] {
        Choice plan = searched(threads, problem, start, search);
        if (!options.loops) plan = settled(in, problem, network.members, plan);
        proof = fast_proof(problem, problems, network, plan);
        return plan;
    };
    std::array<Choice, 2> found;
    const std::int64_t first = options.loops ? 0 : 1;
    threads.for_each(2 - first, 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t k = from + first; k < to + first; ++k) {
            found[idx(k)] = k == 0 ? with_loops() : without();
        }
    });
    const auto chosen = [&](const Choice& plan) {
        Chosen out;
        for (const std::int32_t c : plan) out.push_back(network.members[idx(c)]);
        return out;
    };
    network.chosen = chosen(found[idx(first)]);
    network.connected = found[1].size() < network.chosen.size() ? chosen(found[1]) : network.chosen;
    return proof;
}

}  // namespace

Certificate refine(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                   const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
                   std::vector<Network>& networks, Progress* progress) {
    Certificate proofs;
    proofs.networks.resize(networks.size());
    SearchOptions search{options.effort};
    if (progress != nullptr) {
        std::int64_t steps = 0;
        for (const Network& n : networks) steps += search_steps(n.chosen.size(), options.effort);
        progress->expect(options.loops ? 2 * steps : steps);
        search.done = [&](std::int64_t some) { progress->advance(some); };
    }
    each_network(threads, in, networks.size(), [&](NetworkProblems& problems, std::int64_t n) {
        Network& network = networks[idx(n)];
        Problem problem = problems.of(network.members, owner, static_cast<std::int32_t>(n), fixed,
                                      ProblemRows::needed);
        problem.beside = too_near(in, network.members, options.min_spacing_m);
        SearchOptions mine = search;
        mine.seed = static_cast<std::uint64_t>(n);
        proofs.networks[idx(n)] =
            refine_one(threads, in, options, mine, problem, problems, network);
    });
    return proofs;
}

std::int64_t make_surviving(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                            const std::vector<std::int32_t>& owner,
                            const std::vector<std::uint8_t>& fixed,
                            std::vector<Network>& networks) {
    constexpr std::int64_t steps_each = 4;  // they cost less than those of the search before
    std::vector<std::int64_t> more(networks.size(), 0);
    const auto one = [&](NetworkProblems& problems, std::int64_t n) {
        Network& network = networks[idx(n)];
        Problem problem = problems.of(network.members, owner, static_cast<std::int32_t>(n), fixed,
                                      ProblemRows::all);
        problem.beside = too_near(in, network.members, options.min_spacing_m);
        const Choice start = columns_of(network.members, network.chosen);
        const auto stations = static_cast<std::int64_t>(start.size());
        const Choice plan = survive(problem, start, steps_each * options.effort * stations,
                                    static_cast<std::uint64_t>(n));
        network.chosen.clear();
        for (const std::int32_t c : plan) network.chosen.push_back(network.members[idx(c)]);
        more[idx(n)] = static_cast<std::int64_t>(plan.size()) - stations;
    };
    each_network(threads, in, networks.size(), one);
    return std::accumulate(more.begin(), more.end(), std::int64_t{0});
}

}  // namespace vfplan
