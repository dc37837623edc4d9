#include <algorithm>
#include <cassert>
#include <queue>
#include <tuple>

#include "engine/planner.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// A frontier candidate as it was when it entered the queue; both numbers may be out of date.
struct Entry {
    double gain_m;
    double overlap;
    std::int32_t candidate;
    bool operator<(const Entry& o) const {  // the greatest is taken first
        return std::tuple(gain_m, overlap, -candidate) <
               std::tuple(o.gain_m, o.overlap, -o.candidate);
    }
};

class Greedy {
public:
    Greedy(const PlanInput& input, const std::vector<std::int32_t>& members,
           std::vector<std::uint8_t>& wanted)
        : in_(input),
          members_(members),
          wanted_(wanted),
          chosen_(at(input.graph.size()), 0),
          overlap_(at(input.graph.size()), 0) {}

    Chosen run(const std::vector<std::int32_t>& forced) {
        take(forced.empty() ? seed() : forced.front());
        for (const std::int32_t v : forced) {
            if (chosen_[at(v)] == 0) take_path([&](std::int32_t c) { return c == v; });
        }
        while (true) {
            const std::int32_t next = best_of_frontier();
            if (next >= 0) {
                take(next);
            } else if (!take_path([&](std::int32_t c) { return gain_m(c) > 0; })) {
                return std::move(order_);
            }
        }
    }

private:
    // Length that a candidate would add.
    double gain_m(std::int32_t c) const {
        double sum = 0;
        for (const Seen* s = in_.table.row_begin(c); s != in_.table.row_end(c); ++s) {
            if (wanted_[at(s->piece)] != 0) sum += in_.pieces.length_m(s->piece);
        }
        return sum;
    }

    // Most covered length, ties by VF, then x, then y.
    std::int32_t seed() const {
        std::int32_t best = members_.front();
        const auto key = [&](std::int32_t c) {
            const Candidate& k = in_.candidates[at(c)];
            return std::tuple(gain_m(c), k.vf_rad, -k.at.x(), -k.at.y());
        };
        auto best_key = key(best);
        for (const std::int32_t c : members_) {
            if (auto k = key(c); k > best_key) {
                best = c;
                best_key = k;
            }
        }
        return best;
    }

    void take(std::int32_t c) {
        chosen_[at(c)] = 1;
        order_.push_back(c);
        for (const Seen* s = in_.table.row_begin(c); s != in_.table.row_end(c); ++s) {
            wanted_[at(s->piece)] = 0;
        }
        in_.graph.each(c, [&](std::int32_t n, double overlap) {
            if (chosen_[at(n)] != 0 || overlap <= overlap_[at(n)]) return;
            overlap_[at(n)] = overlap;
            frontier_.push({gain_m(n), overlap, n});
        });
    }

    // Gains only shrink, so an entry whose gain is still true is the best one.
    std::int32_t best_of_frontier() {
        while (!frontier_.empty()) {
            const Entry top = frontier_.top();
            frontier_.pop();
            if (chosen_[at(top.candidate)] != 0 || top.overlap != overlap_[at(top.candidate)]) {
                continue;  // a newer entry stands for it
            }
            const double now = gain_m(top.candidate);
            if (now <= 0) continue;
            if (now == top.gain_m) return top.candidate;
            frontier_.push({now, top.overlap, top.candidate});
        }
        return -1;
    }

    // Takes the fewest hops from the chosen set to a candidate that `is_goal` likes. Among goals
    // equally far: most gain, then highest overlap with the step before it, then lowest id.
    template <class F>
    bool take_path(F&& is_goal) {
        std::vector<std::int32_t> before(at(in_.graph.size()), -1);
        std::vector<double> step(before.size(), 0);
        std::vector<std::int32_t> level = order_;
        std::vector<std::uint8_t> seen = chosen_;
        while (!level.empty()) {
            std::sort(level.begin(), level.end());
            std::vector<std::int32_t> next;
            for (const std::int32_t v : level) {
                in_.graph.each(v, [&](std::int32_t n, double overlap) {
                    if (seen[at(n)] == 1) return;
                    if (seen[at(n)] == 0) {
                        seen[at(n)] = 2;  // reached in this level
                        next.push_back(n);
                    }
                    if (overlap > step[at(n)]) {
                        step[at(n)] = overlap;
                        before[at(n)] = v;
                    }
                });
            }
            std::int32_t goal = -1;
            std::tuple<double, double, std::int32_t> best;
            for (const std::int32_t n : next) {
                seen[at(n)] = 1;
                if (!is_goal(n)) continue;
                const std::tuple key(gain_m(n), step[at(n)], -n);
                if (goal < 0 || key > best) {
                    goal = n;
                    best = key;
                }
            }
            if (goal >= 0) {
                std::vector<std::int32_t> path;
                for (std::int32_t v = goal; chosen_[at(v)] == 0; v = before[at(v)]) {
                    path.push_back(v);
                }
                for (auto v = path.rbegin(); v != path.rend(); ++v) take(*v);
                return true;
            }
            level = std::move(next);
        }
        return false;
    }

    const PlanInput& in_;
    const std::vector<std::int32_t>& members_;
    std::vector<std::uint8_t>& wanted_;
    std::vector<std::uint8_t> chosen_;
    std::vector<double> overlap_;  // highest with the chosen set
    std::priority_queue<Entry> frontier_;
    Chosen order_;
};

}  // namespace

Chosen greedy_network(const PlanInput& input, const std::vector<std::int32_t>& members,
                      const std::vector<std::int32_t>& forced, std::vector<std::uint8_t>& wanted) {
    assert(!members.empty());
    return Greedy(input, members, wanted).run(forced);
}

}  // namespace vfplan
