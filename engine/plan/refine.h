// From greedy plans to better ones (docs/planning.md).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/config/options.h"
#include "engine/plan/network_problem.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"
#include "kernels/certificate.h"

namespace vfplan {

// Makes each network better, without loops and then, where the options ask for them, with. Rows of
// network k are the pieces with owner[piece] == k; fixed[candidate] stays. Gives fast proofs of how
// few stations the networks could do with. The number of threads changes nothing.
Certificate refine(const Threads& threads, const PlanInput& input, const PlanOptions& options,
                   const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
                   std::vector<Network>& networks, Progress* progress);

// Makes each network survive the loss of any one of its stations (engine/search/survive.h); returns
// how many stations more that takes in all. The number of threads changes nothing.
std::int64_t make_surviving(const Threads& threads, const PlanInput& input,
                            const PlanOptions& options, const std::vector<std::int32_t>& owner,
                            const std::vector<std::uint8_t>& fixed, std::vector<Network>& networks);

}  // namespace vfplan
