// Sets that merge, for building spanning trees.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "kernels/index.h"

namespace vfplan {

class DisjointSets {
public:
    explicit DisjointSets(std::int64_t n) : parent_(idx(n)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    std::int32_t root(std::int32_t v) {
        while (parent_[idx(v)] != v) v = parent_[idx(v)] = parent_[idx(parent_[idx(v)])];
        return v;
    }
    bool together(std::int32_t a, std::int32_t b) { return root(a) == root(b); }
    void merge(std::int32_t a, std::int32_t b) { parent_[idx(root(a))] = root(b); }

private:
    std::vector<std::int32_t> parent_;
};

}  // namespace vfplan
