#include "engine/plan/greedy.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <queue>
#include <tuple>

#include "kernels/index.h"

namespace vfplan {
namespace {

class Greedy {
public:
    Greedy(const PlanInput& input, const std::vector<std::int32_t>& members,
           std::vector<std::uint8_t>& wanted, Workspace& work)
        : in_(input),
          members_(members),
          wanted_(wanted),
          chosen_(work.mark),
          overlap_(work.overlap),
          hops_(work.hops),
          step_(work.step),
          before_(work.before),
          ranked_(most_hops + 1) {}

    // Leaves the work space as it was.
    Chosen run(const std::vector<std::int32_t>& forced) {
        take(forced.empty() ? seed() : forced.front());
        for (const std::int32_t v : forced) {
            if (chosen_[idx(v)] == 0) take_path_to(v);
        }
        for (bool more = true; more;) {
            const std::int32_t next = best_of_frontier();
            if (next >= 0) {
                take(next);
            } else {
                more = take_nearest_gain();
            }
        }
        for (const std::int32_t c : members_) {
            chosen_[idx(c)] = 0;
            overlap_[idx(c)] = 0;
            hops_[idx(c)] = Workspace::far_away;
        }
        return std::move(order_);
    }

private:
    // Length that a candidate would add.
    double gain_m(std::int32_t c) const {
        double sum = 0;
        for (const std::int32_t p : in_.rows.row(c)) {
            if (wanted_[idx(p)] != 0) sum += in_.piece_length_m[idx(p)];
        }
        return sum;
    }

    // Most covered length, ties by VF, then x, then y.
    std::int32_t seed() const {
        std::int32_t best = members_.front();
        const auto key = [&](std::int32_t c) {
            const Candidate& k = in_.candidates[idx(c)];
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
        chosen_[idx(c)] = 1;
        order_.push_back(c);
        for (const std::int32_t p : in_.rows.row(c)) wanted_[idx(p)] = 0;
        in_.graph.each(c, [&](std::int32_t n, double overlap) {
            if (chosen_[idx(n)] != 0 || overlap <= overlap_[idx(n)]) return;
            overlap_[idx(n)] = overlap;
            frontier_.push({gain_m(n), overlap, n});
        });
        update_hops(c);
    }

    // Hops from the chosen set, as far as most_hops; they only shrink.
    void update_hops(std::int32_t c) {
        hops_[idx(c)] = 0;
        std::vector<std::int32_t> level = {c};
        for (std::int32_t hops = 1; hops <= most_hops && !level.empty(); ++hops) {
            std::vector<std::int32_t> next;
            for (const std::int32_t v : level) {
                in_.graph.each(v, [&](std::int32_t n, double) {
                    if (hops_[idx(n)] <= hops) return;
                    hops_[idx(n)] = hops;
                    ranked_[idx(hops)].fresh.push_back(n);
                    if (hops == most_hops) rim_.push_back(n);
                    next.push_back(n);
                });
            }
            level = std::move(next);
        }
    }

    // Takes the fewest hops from the chosen set to a candidate with a gain; false when there is
    // none. Among those equally far: most gain, then highest overlap with the step before it, then
    // lowest id.
    bool take_nearest_gain() {
        std::vector<std::int32_t> goals;
        for (std::int32_t hops = 1; hops <= most_hops && goals.empty(); ++hops) {
            goals = most_gain_at(hops);
        }
        std::vector<std::int32_t> level;
        if (goals.empty()) level = rim();
        while (goals.empty() && !level.empty()) {
            level = beyond(level);
            double most = 0;
            for (const std::int32_t c : level) {
                const double gain = gain_m(c);
                if (gain > most) goals.clear();
                if (gain > 0 && gain >= most) goals.push_back(c);
                most = std::max(most, gain);
            }
        }
        if (goals.empty()) return false;
        const auto key = [&](std::int32_t c) {
            double step = 0;
            in_.graph.each(c, [&](std::int32_t n, double overlap) {
                if (hops_[idx(n)] == hops_[idx(c)] - 1) step = std::max(step, overlap);
            });
            return std::pair(step, -c);
        };
        std::int32_t goal = goals.front();
        for (const std::int32_t c : goals) {
            if (key(c) > key(goal)) goal = c;
        }
        take_path_to(goal);
        return true;
    }

    // Those so many hops away that have the most gain; none when none has any. Gains only shrink
    // and candidates only come nearer, so most of what lies there is never looked at again.
    std::vector<std::int32_t> most_gain_at(std::int32_t hops) {
        Ranked& there = ranked_[idx(hops)];
        for (const std::int32_t c : there.fresh) {
            if (hops_[idx(c)] != hops) continue;
            if (const double gain = gain_m(c); gain > 0) there.by_gain.emplace(gain, c);
        }
        there.fresh.clear();
        std::vector<std::int32_t> out;
        double most = 0;
        while (!there.by_gain.empty() && (out.empty() || there.by_gain.top().first == most)) {
            const auto [gain, c] = there.by_gain.top();
            there.by_gain.pop();
            if (hops_[idx(c)] != hops) continue;
            const double now = gain_m(c);
            if (now == gain) {
                most = gain;
                out.push_back(c);
            } else if (now > 0) {
                there.by_gain.emplace(now, c);
            }
        }
        for (const std::int32_t c : out) there.by_gain.emplace(most, c);
        return out;
    }

    // Takes the fewest hops from the chosen set to v.
    // REQUIRES: v is joined to the chosen set.
    void take_path_to(std::int32_t v) {
        std::vector<std::int32_t> level;
        if (hops_[idx(v)] == Workspace::far_away) level = rim();
        while (hops_[idx(v)] == Workspace::far_away) level = beyond(level);
        take_path(v);
    }

    // What is most_hops away.
    const std::vector<std::int32_t>& rim() {
        std::erase_if(rim_, [&](std::int32_t c) { return hops_[idx(c)] != most_hops; });
        return rim_;
    }

    // What is one hop beyond all that is at `level`. Known until the next path is taken.
    std::vector<std::int32_t> beyond(const std::vector<std::int32_t>& level) {
        std::vector<std::int32_t> out;
        for (const std::int32_t v : level) {
            in_.graph.each(v, [&](std::int32_t n, double) {
                if (hops_[idx(n)] <= hops_[idx(v)] + 1) return;
                hops_[idx(n)] = hops_[idx(v)] + 1;
                out.push_back(n);
            });
        }
        beyond_.insert(beyond_.end(), out.begin(), out.end());
        return out;
    }

    // Takes the best path to `goal`, looking only at the shortest ones that lead there.
    void take_path(std::int32_t goal) {
        const std::int32_t hops = hops_[idx(goal)];
        std::vector<std::vector<std::int32_t>> levels = {{goal}};
        std::vector<std::int32_t> touched = levels.back();
        for (const std::int32_t c : touched) before_[idx(c)] = reached;
        for (std::int32_t h = hops; h > 1; --h) {
            std::vector<std::int32_t> nearer;
            for (const std::int32_t v : levels.back()) {
                in_.graph.each(v, [&](std::int32_t n, double) {
                    if (hops_[idx(n)] != h - 1 || before_[idx(n)] == reached) return;
                    before_[idx(n)] = reached;
                    nearer.push_back(n);
                    touched.push_back(n);
                });
            }
            levels.push_back(std::move(nearer));
        }
        std::reverse(levels.begin(), levels.end());
        for (const std::int32_t c : levels.front()) step_[idx(c)] = overlap_[idx(c)];
        for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
            std::sort(levels[k].begin(), levels[k].end());
            for (const std::int32_t v : levels[k]) {
                in_.graph.each(v, [&](std::int32_t n, double overlap) {
                    const bool on_a_path =
                        hops_[idx(n)] == hops_[idx(v)] + 1 && before_[idx(n)] != nowhere;
                    if (!on_a_path || overlap <= step_[idx(n)]) return;
                    step_[idx(n)] = overlap;
                    before_[idx(n)] = v;
                });
            }
        }
        std::vector<std::int32_t> path;
        for (std::int32_t v = goal; v >= 0; v = before_[idx(v)]) path.push_back(v);
        for (const std::int32_t c : touched) {
            before_[idx(c)] = nowhere;
            step_[idx(c)] = 0;
        }
        for (const std::int32_t c : beyond_) hops_[idx(c)] = Workspace::far_away;
        beyond_.clear();
        for (auto v = path.rbegin(); v != path.rend(); ++v) take(*v);
    }

    // Gains only shrink, so an entry whose gain is still true is the best one.
    std::int32_t best_of_frontier() {
        while (!frontier_.empty()) {
            const FrontierEntry top = frontier_.top();
            frontier_.pop();
            if (chosen_[idx(top.candidate)] != 0 || top.overlap != overlap_[idx(top.candidate)]) {
                continue;  // a newer entry stands for it
            }
            const double now = gain_m(top.candidate);
            if (now <= 0) continue;
            if (now == top.gain_m) return top.candidate;
            frontier_.push({now, top.overlap, top.candidate});
        }
        return -1;
    }

    // Candidates equally many hops away. Some have come nearer or gained less since.
    struct Ranked {
        std::vector<std::int32_t> fresh;  // not looked at yet
        std::priority_queue<std::pair<double, std::int32_t>> by_gain;
    };

    static constexpr std::int32_t most_hops = 8;  // kept up to date; beyond, beyond() looks
    static constexpr std::int32_t nowhere = -1;   // before_: on no path
    static constexpr std::int32_t reached = -2;   // before_: on a path, nothing before it yet

    const PlanInput& in_;
    const std::vector<std::int32_t>& members_;
    std::vector<std::uint8_t>& wanted_;
    std::vector<std::uint8_t>& chosen_;
    std::vector<double>& overlap_;     // highest with the chosen set
    std::vector<std::int32_t>& hops_;  // from the chosen set
    std::vector<double>& step_;        // best overlap with the step before, on the paths at hand
    std::vector<std::int32_t>& before_;
    std::vector<Ranked> ranked_;        // by hops
    std::vector<std::int32_t> rim_;     // most_hops away; some have come nearer
    std::vector<std::int32_t> beyond_;  // farther than that, found for one path
    std::priority_queue<FrontierEntry> frontier_;
    Chosen order_;
};

}  // namespace

Chosen choose_greedily(const PlanInput& input, const std::vector<std::int32_t>& members,
                       const std::vector<std::int32_t>& forced, std::vector<std::uint8_t>& wanted,
                       Workspace& work) {
    assert(!members.empty());
    return Greedy(input, members, wanted, work).run(forced);
}

}  // namespace vfplan
