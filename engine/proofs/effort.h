// How much a proof may do, counted and not timed, so that it ends the same everywhere.
#pragma once

#include <cstdint>

namespace vfplan {

// Numbers looked at, about: some hundred million a second.
struct Effort {
    std::int64_t left = 0;

    void spend(std::int64_t work) { left -= work; }
    bool is_spent() const { return left <= 0; }
};

}  // namespace vfplan
