#include "engine/graphs/sparse.h"

#include <numeric>

namespace vfplan {

Sparse transposed(const Sparse& lists, std::int32_t count) {
    Sparse out;
    out.begin.assign(idx(count) + 1, 0);
    for (const std::int32_t n : lists.to) ++out.begin[idx(n) + 1];
    std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
    out.to.resize(lists.to.size());
    std::vector<std::int64_t> next(out.begin.begin(), out.begin.end() - 1);
    for (std::int32_t i = 0; i < lists.size(); ++i) {
        for (const std::int32_t n : lists.of(i)) out.to[idx(next[idx(n)]++)] = i;
    }
    return out;
}

}  // namespace vfplan
