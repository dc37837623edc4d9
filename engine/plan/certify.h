// How few stations each network could do with (docs/planning.md, "Bounds and certificates").
#pragma once

#include <cstdint>
#include <vector>

#include "engine/config/options.h"
#include "engine/plan/network_problem.h"
#include "engine/plan/workspace.h"
#include "engine/runtime/parallel.h"
#include "kernels/certificate.h"

namespace vfplan {

// Of a network's last problem, in numbers of candidates and pieces. `plan`: one of its plans.
NetworkProof fast_proof(const Problem& problem, const NetworkProblems& problems,
                        const Network& network, const Choice& plan);

// Proves a bound for each network as it was before loops counted, which holds with loops as well:
// fast ones, or, by the method `certified`, as good ones as its effort allows. A better plan that
// is met on the way becomes the network's. Arguments as refine() has them. The number of threads
// changes nothing.
Certificate certify(const Threads& threads, const PlanInput& input, const PlanOptions& options,
                    const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
                    std::vector<Network>& networks);

}  // namespace vfplan
