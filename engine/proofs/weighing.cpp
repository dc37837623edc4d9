#include "engine/proofs/weighing.h"

#include <algorithm>

namespace vfplan {

std::int64_t Weighing::value(std::span<const ProofLine> lines, std::span<const LineWeight> weights,
                             std::span<const Known> known) {
    const Problem& p = lines_.problem();
    const Root& root = lines_.root();
    std::int64_t total = 0;
    bool any_way = false;  // whether ways weigh at all
    for (const auto& [number, weight] : weights) {
        const ProofLine& line = lines[idx(number)];
        total += weight * Lines::least(line.kind);
        any_way = any_way || (line.kind != LineKind::cover && line.kind != LineKind::nodes &&
                              line.kind != LineKind::nodes_of);
        lines_.each(line, [&, weight = weight](std::int32_t variable, std::int64_t factor) {
            sum_[idx(variable)] += weight * factor;
        });
    }
    constexpr std::int64_t nothing = std::numeric_limits<std::int64_t>::min() / 4;
    cost_.assign(idx(p.columns()), 0);
    bool none = false;
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        // A chosen column is the root or has one way into it.
        std::int64_t most = nothing;
        const std::int64_t first = p.near.begin[idx(c)];
        const auto near = p.near.of(c);
        for (std::size_t k = 0; k < near.size(); ++k) {
            if (known[idx(near[k])] == Known::left_out) continue;
            most = std::max(most, sum_[idx(lines_.y(first + static_cast<std::int64_t>(k)))]);
            if (!any_way) break;
        }
        cost_[idx(c)] = most;
    }
    for (std::size_t k = 0; k < root.columns.size(); ++k) {
        std::int64_t& most = cost_[idx(root.columns[k])];
        most = std::max(most, sum_[idx(lines_.r(k))]);
    }
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        std::int64_t& cost = cost_[idx(c)];
        const bool cut_off = cost == nothing;
        cost = lines_.cost(c) - sum_[idx(lines_.x(c))] - (cut_off ? 0 : cost);
        const bool must = p.fixed[idx(c)] != 0 || known[idx(c)] == Known::chosen;
        if (known[idx(c)] == Known::left_out) {
            none = none || must;
        } else if (cut_off) {
            none = none || must;
        } else if (must || cost < 0) {
            total += cost;
        }
    }
    for (const auto& [number, weight] : weights) {
        lines_.each(lines[idx(number)],
                    [&](std::int32_t variable, std::int64_t) { sum_[idx(variable)] = 0; });
    }
    return none ? impossible : total;
}

}  // namespace vfplan
