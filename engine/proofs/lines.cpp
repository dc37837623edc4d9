#include "engine/proofs/lines.h"

#include <algorithm>

namespace vfplan {

Root root_of(const Problem& p) {
    Root out;
    const auto fixed = std::find(p.fixed.begin(), p.fixed.end(), 1);
    if (fixed != p.fixed.end()) {
        out.column = static_cast<std::int32_t>(fixed - p.fixed.begin());
        out.columns = {out.column};
        return out;
    }
    for (std::int32_t r = 0; r < p.rows(); ++r) {
        if (out.row < 0 || p.columns_of.of(r).size() < p.columns_of.of(out.row).size()) out.row = r;
    }
    const auto columns = p.columns_of.of(out.row);
    out.columns.assign(columns.begin(), columns.end());
    return out;
}

Lines::Lines(const Problem& problem, const Root& root, std::vector<std::int64_t> cost)
    : p_(problem),
      r_(root),
      cost_(std::move(cost)),
      first_root_(p_.columns() + static_cast<std::int32_t>(p_.near.to.size())),
      root_(idx(p_.columns()), -1),
      in_(root_.size(), 0),
      met_(root_.size(), 0) {
    for (std::size_t k = 0; k < r_.columns.size(); ++k) {
        root_[idx(r_.columns[k])] = static_cast<std::int32_t>(k);
    }
}

std::int64_t Lines::place(std::int32_t from, std::int32_t to) const {
    const auto list = p_.near.of(to);
    return p_.near.begin[idx(to)] +
           (std::lower_bound(list.begin(), list.end(), from) - list.begin());
}

}  // namespace vfplan
