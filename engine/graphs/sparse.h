// Lists of numbers, one after another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/index.h"

namespace vfplan {

// A list of numbers for each of size() things, as compressed sparse rows.
struct Sparse {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> to;

    std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::span<const std::int32_t> of(std::int32_t i) const {
        return {to.data() + begin[idx(i)], to.data() + begin[idx(i) + 1]};
    }
    void add_list(std::span<const std::int32_t> list) {
        to.insert(to.end(), list.begin(), list.end());
        end_list();
    }
    void end_list() { begin.push_back(static_cast<std::int64_t>(to.size())); }
};

// For each number below `count` what it is listed by, ascending.
Sparse transposed(const Sparse& lists, std::int32_t count);

}  // namespace vfplan
