// Shortest ways through columns that are not chosen.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/search/choosing.h"
#include "engine/search/dice.h"

namespace vfplan {

// Room for many searches, each at the cost of what it looks at. Refers to all three.
class Ways {
public:
    Ways(const Problem& problem, const Choosing& choosing, Dice& dice)
        : p_(problem),
          c_(choosing),
          dice_(dice),
          met_(idx(problem.columns()), 0),
          before_(idx(problem.columns()), -1) {}

    // Breadth first from chosen columns to one that is worth something: worth(column) > 0; of the
    // first level where any is, the one worth most, drawn by lot among equals. The columns of the
    // way there, the farthest first; empty where there is none.
    template <class Worth>
    const std::vector<std::int32_t>& from(const std::vector<std::int32_t>& chosen,
                                          const Worth& worth) {
        way_.clear();
        ++now_;
        level_ = chosen;
        for (const std::int32_t c : level_) met_[idx(c)] = now_;
        while (!level_.empty()) {
            next_.clear();
            std::int32_t best = 0;
            std::int32_t found = -1;
            std::int32_t ties = 0;
            for (const std::int32_t c : level_) {
                for (const std::int32_t n : p_.near.of(c)) {
                    if (met_[idx(n)] == now_ || c_.is_chosen(n)) continue;
                    met_[idx(n)] = now_;
                    before_[idx(n)] = c;
                    next_.push_back(n);
                    const std::int32_t value = worth(n);
                    if (value <= 0 || value < best) continue;
                    if (value > best) ties = 0;
                    best = value;
                    if (dice_.below(++ties) == 0) found = n;
                }
            }
            if (found >= 0) {
                for (std::int32_t c = found; !c_.is_chosen(c); c = before_[idx(c)]) {
                    way_.push_back(c);
                }
                break;
            }
            std::swap(level_, next_);
        }
        return way_;
    }

private:
    const Problem& p_;
    const Choosing& c_;
    Dice& dice_;
    std::vector<std::uint32_t> met_;
    std::uint32_t now_ = 0;
    std::vector<std::int32_t> before_;
    std::vector<std::int32_t> level_;
    std::vector<std::int32_t> next_;
    std::vector<std::int32_t> way_;
};

}  // namespace vfplan
