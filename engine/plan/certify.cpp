#include "engine/plan/certify.h"

#include <algorithm>

#include "engine/plan/network_problem.h"
#include "engine/proofs/proof.h"

namespace vfplan {
namespace {

// From numbers of a network's problem to those of the coverage table.
void renumber(const std::vector<std::int32_t>& members, const std::vector<std::int32_t>& pieces,
              NetworkProof& proof) {
    const auto candidate = [&](std::int32_t& c) {
        if (c >= 0) c = members[idx(c)];
    };
    const auto piece = [&](std::int32_t& r) {
        if (r >= 0) r = pieces[idx(r)];
    };
    for (GoneCandidate& g : proof.gone) {
        candidate(g.gone);
        candidate(g.by);
    }
    piece(proof.root_piece);
    candidate(proof.root_station);
    for (ProofLine& line : proof.lines) {
        is_of_piece(line.kind) ? piece(line.of) : candidate(line.of);
        for (std::int32_t& c : line.within) candidate(c);
    }
    for (ProofCase& c : proof.cases) candidate(c.branch);
}

NetworkProof certify_one(const PlanOptions& options, const Problem& problem, Network& network) {
    Choice plan;
    for (const std::int32_t c : network.connected) {
        plan.push_back(static_cast<std::int32_t>(
            std::lower_bound(network.members.begin(), network.members.end(), c) -
            network.members.begin()));
    }
    std::sort(plan.begin(), plan.end());
    if (options.method != PlanMethod::certified) return weighed_proof(problem, plan);
    Proven proven = prove(problem, plan, options.proof_effort);
    if (proven.plan.size() < plan.size()) {
        network.connected.clear();
        for (const std::int32_t c : proven.plan) {
            network.connected.push_back(network.members[idx(c)]);
        }
        if (!options.loops) network.chosen = network.connected;
    }
    return std::move(proven.proof);
}

}  // namespace

Certificate certify(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                    const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
                    std::vector<Network>& networks) {
    Certificate out;
    out.networks.resize(networks.size());
    threads.for_each(
        static_cast<std::int64_t>(networks.size()), 1, [&](std::int64_t from, std::int64_t to) {
            NetworkProblems problems(in);
            for (std::int64_t n = from; n < to; ++n) {
                Network& network = networks[idx(n)];
                const Problem problem =
                    problems.of(network.members, owner, static_cast<std::int32_t>(n), fixed);
                out.networks[idx(n)] = certify_one(options, problem, network);
                renumber(network.members, problems.pieces(), out.networks[idx(n)]);
            }
        });
    return out;
}

}  // namespace vfplan
