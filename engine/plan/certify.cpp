#include "engine/plan/certify.h"

#include "engine/plan/network_problem.h"
#include "engine/proofs/proof.h"

namespace vfplan {
namespace {

// In numbers of candidates and pieces instead of those of the problem.
void number(const NetworkProblems& problems, const Network& network, NetworkProof& proof) {
    renumber(network.members, problems.pieces(), proof);
    for (GoneCandidate& g : proof.gone) {
        g = {network.members[idx(g.gone)], network.members[idx(g.by)]};
    }
}

NetworkProof certify_one(const PlanOptions& options, const Problem& problem,
                         const NetworkProblems& problems, Network& network) {
    const Choice plan = columns_of(network.members, network.connected);
    Proven proven = prove(problem, plan, options.proof_effort);
    if (proven.plan.size() < plan.size()) {
        network.connected.clear();
        for (const std::int32_t c : proven.plan) {
            network.connected.push_back(network.members[idx(c)]);
        }
        if (!options.loops) network.chosen = network.connected;
    }
    number(problems, network, proven.proof);
    return std::move(proven.proof);
}

}  // namespace

NetworkProof fast_proof(const Problem& problem, const NetworkProblems& problems,
                        const Network& network, const Choice& plan) {
    NetworkProof out = weighed_proof(problem, plan);
    number(problems, network, out);
    return out;
}

Certificate certify(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                    const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
                    std::vector<Network>& networks) {
    Certificate out;
    out.networks.resize(networks.size());
    each_network(threads, in, networks.size(), [&](NetworkProblems& problems, std::int64_t n) {
        Network& network = networks[idx(n)];
        const Problem problem = problems.of(network.members, owner, static_cast<std::int32_t>(n),
                                            fixed, ProblemRows::needed);
        out.networks[idx(n)] = options.method == PlanMethod::certified
                                   ? certify_one(options, problem, problems, network)
                                   : fast_proof(problem, problems, network,
                                                columns_of(network.members, network.connected));
    });
    return out;
}

}  // namespace vfplan
