// What a case of a proof proves, in whole numbers.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/proofs/lines.h"

namespace vfplan {

// What is known of a column in a case.
enum class Known : std::uint8_t { free, chosen, left_out };

// Adds weighted lines up. The number of stations, less what the weighted lines give at least, is a
// sum over columns; each is asked for the least that it can be. Refers to the lines. Not
// thread-safe.
class Weighing {
public:
    explicit Weighing(Lines& lines) : lines_(lines), sum_(idx(lines.size()), 0) {}

    // No plan of the case has fewer stations than this, in parts of proof_scale; `impossible` where
    // it has no plan.
    std::int64_t value(std::span<const ProofLine> lines, std::span<const LineWeight> weights,
                       std::span<const Known> known);
    static constexpr std::int64_t impossible = std::numeric_limits<std::int64_t>::max() / 4;

    // What a free column adds to the value when it is chosen; of the last value().
    std::int64_t cost(std::int32_t column) const { return cost_[idx(column)]; }

private:
    Lines& lines_;
    std::vector<std::int64_t> sum_;
    std::vector<std::int64_t> cost_;
};

// Stations of a value: rounded up.
constexpr std::int64_t stations_of(std::int64_t value) {
    return value <= 0 ? 0 : (value + proof_scale - 1) / proof_scale;
}

}  // namespace vfplan
