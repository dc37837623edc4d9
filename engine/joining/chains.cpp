#include "engine/joining/chains.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <tuple>
#include <utility>

#include "engine/joining/contested.h"
#include "kernels/disjoint_sets.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

class Joiner {
public:
    Joiner(const Threads& threads, const JoinProblem& p)
        : threads_(threads),
          p_(p),
          totals_(seen_totals(p.local.rows, p.local.piece_length_m)),
          sets_(p.components + p.cells()),
          left_(p.components),
          steps_(idx(p.cells()), 0),
          next_(idx(p.cells()), joins_nothing) {}

    Joined run(std::int64_t viewers) {
        join_by_one_cell();
        complete_ = viewers_of_loose_cells() <= viewers;
        for (std::int32_t steps = 1; left_ > 1; ++steps) {
            std::vector<Edge> edges;
            if (!meetings(steps, viewers, edges)) {
                complete_ = false;
                break;
            }
            // A chain over cells that are farther from candidates is longer than this.
            join_over(edges, steps + 1);
            if (step_on(steps)) continue;
            join_over(edges, std::numeric_limits<std::int32_t>::max());
            break;
        }
        if (complete_) join_the_rest();
        return result();
    }

private:
    // Two cells that overlap enough, of different sets.
    struct Edge {
        std::int32_t length = 0;  // cells of the chain that leads over both
        std::int32_t a = 0;
        std::int32_t b = 0;
        auto order() const { return std::tuple(length, a, b); }
    };

    std::int32_t element(std::int32_t node) const {
        return node < p_.candidates()
                   ? p_.component[idx(node)]
                   : static_cast<std::int32_t>(p_.components) + node - p_.candidates();
    }
    std::int32_t of_cell(std::int32_t cell) const { return element(p_.candidates() + cell); }

    bool merge(std::int32_t component_or_cell, std::int32_t other) {
        if (sets_.together(component_or_cell, other)) return false;
        sets_.merge(component_or_cell, other);
        return true;
    }

    // The components that each cell overlaps enough with, a pair of numbers each, ascending.
    std::vector<std::pair<std::int32_t, std::int32_t>> beside() const {
        std::vector<std::int32_t> components = p_.component;  // those that there are
        std::sort(components.begin(), components.end());
        components.erase(std::unique(components.begin(), components.end()), components.end());
        // Some cells at a time: an index of all would be as large as their rows.
        constexpr std::int32_t at_once = 1 << 15;
        std::vector<std::pair<std::int32_t, std::int32_t>> out;
        for (std::int32_t from = p_.candidates(); from < p_.local.rows.size(); from += at_once) {
            beside(components, from, std::min(from + at_once, p_.local.rows.size()), out);
        }
        return out;
    }

    // The same for the nodes from..to, which are cells.
    void beside(const std::vector<std::int32_t>& components, std::int32_t from, std::int32_t to,
                std::vector<std::pair<std::int32_t, std::int32_t>>& out) const {
        constexpr std::size_t bits = 64;
        const std::size_t words = components.size() / bits + 1;
        std::vector<std::uint64_t> found(words * idx(to - from), 0);  // one found is enough
        const auto& length_m = p_.local.piece_length_m;
        const PieceIndex index =
            index_of(p_.local.rows, static_cast<std::int64_t>(length_m.size()), from, to);
        threads_.for_each(p_.candidates(), rows_at_once, [&](std::int64_t begin, std::int64_t end) {
            PairSearch search(p_.local.rows, index, length_m, formula(p_.rule.ratio).by_angle);
            for (std::int64_t r = begin; r < end; ++r) {
                const std::size_t k = idx(
                    std::lower_bound(components.begin(), components.end(), p_.component[idx(r)]) -
                    components.begin());
                const std::uint64_t bit = std::uint64_t{1} << k % bits;
                const auto word = [&](std::int32_t n) {
                    return std::atomic_ref<std::uint64_t>(found[words * idx(n - from) + k / bits]);
                };
                search.after(
                    static_cast<std::int32_t>(r),
                    [&](std::int32_t n) {
                        return (word(n).load(std::memory_order_relaxed) & bit) == 0;
                    },
                    [&](std::int32_t n, const SeenJointly& joint) {
                        const double o =
                            overlap(p_.rule.ratio, totals_[idx(r)], totals_[idx(n)], joint);
                        if (p_.rule.enough(o)) word(n).fetch_or(bit, std::memory_order_relaxed);
                    });
            }
        });
        for (std::int32_t n = from; n < to; ++n) {
            for (std::size_t k = 0; k < components.size(); ++k) {
                if ((found[words * idx(n - from) + k / bits] >> k % bits & 1U) == 0) continue;
                out.emplace_back(n - p_.candidates(), components[k]);
            }
        }
    }

    void join_by_one_cell() {
        const auto pairs = beside();
        struct Group {
            std::size_t from;
            std::size_t to;
        };
        std::vector<Group> groups;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (i == 0 || pairs[i].first != pairs[i - 1].first) groups.push_back({i, i});
            ++groups.back().to;
        }
        // Who joins most goes first.
        std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
            return a.to - a.from > b.to - b.from;
        });
        for (const Group& g : groups) {
            const std::int32_t cell = pairs[g.from].first;
            bool joins = false;
            for (std::size_t i = g.from + 1; i < g.to; ++i) {
                if (!merge(pairs[i].second, pairs[g.from].second)) continue;
                joins = true;
                --left_;
            }
            if (joins) connectors_.push_back(cell);
            merge(of_cell(cell), pairs[g.from].second);
            steps_[idx(cell)] = 1;
            next_[idx(cell)] = beside_a_candidate;
        }
    }

    bool is_left_out(std::int32_t cell) const { return !complete_ && steps_[idx(cell)] == 0; }

    // What it takes to look at all pairs of cells that are beside no candidate.
    std::int64_t viewers_of_loose_cells() const {
        std::vector<std::int64_t> viewers(p_.local.piece_length_m.size(), 0);
        for (const std::int32_t piece : p_.local.rows.piece) ++viewers[idx(piece)];
        std::int64_t sum = 0;
        for (std::int32_t c = 0; c < p_.cells(); ++c) {
            if (steps_[idx(c)] > 0) continue;
            for (const std::int32_t piece : p_.local.rows.row(p_.candidates() + c)) {
                sum += viewers[idx(piece)];
            }
        }
        return sum;
    }

    std::vector<std::int32_t> roots() {
        std::vector<std::int32_t> out(idx(p_.local.rows.size()));
        for (std::int32_t n = 0; n < p_.local.rows.size(); ++n) {
            const bool out_of_it = n >= p_.candidates() && is_left_out(n - p_.candidates());
            out[idx(n)] = out_of_it ? left_out : sets_.root(element(n));
        }
        return out;
    }

    // Where sets meet. On the way, of the cells that are on no chain yet those beside one that is
    // `steps` from a candidate: reached_. False when there are too many pairs to look at.
    bool meetings(std::int32_t steps, std::int64_t most, std::vector<Edge>& out) {
        const std::int32_t first = p_.candidates();
        std::vector<std::int32_t> kind(idx(p_.local.rows.size()), 0);
        for (std::int32_t c = 0; c < p_.cells(); ++c) kind[idx(first + c)] = steps_[idx(c)];
        const std::vector<std::int32_t> set = roots();
        const Contested contested = contested_of(p_, totals_, set, kind, p_.rule.threshold);
        const auto pieces = static_cast<std::int64_t>(p_.local.piece_length_m.size());
        if (pairs_across(contested, pieces) > most) return false;
        std::vector<std::vector<Edge>> found(contested.node.size() / rows_at_once + 1);
        constexpr std::int32_t nobody = std::numeric_limits<std::int32_t>::max();
        reached_.assign(idx(p_.cells()), nobody);
        const auto reach = [&](std::int32_t cell, std::int32_t from) {
            const std::atomic_ref<std::int32_t> least(reached_[idx(cell)]);
            std::int32_t known = least.load(std::memory_order_relaxed);
            while (from < known && !least.compare_exchange_weak(known, from)) continue;
        };
        across(
            threads_, p_, totals_, contested,
            [&](std::int32_t, std::int32_t) { return p_.rule.threshold; },
            [&](std::int64_t block, std::int32_t a, std::int32_t b, double o) {
                if (a < first || !p_.rule.enough(o)) return;  // candidates: done by one cell
                a -= first;
                b -= first;
                const std::int32_t to_a = steps_[idx(a)];
                const std::int32_t to_b = steps_[idx(b)];
                if (to_a > 0 && to_b > 0) {
                    found[idx(block)].push_back({to_a + to_b, a, b});
                } else if (to_a == steps) {
                    reach(b, a);
                } else if (to_b == steps) {
                    reach(a, b);
                }
            });
        for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
        std::sort(out.begin(), out.end(),
                  [](const Edge& p, const Edge& q) { return p.order() < q.order(); });
        return true;
    }

    void join_over(const std::vector<Edge>& edges, std::int32_t longest) {
        for (const Edge& e : edges) {
            if (e.length > longest || !merge(of_cell(e.a), of_cell(e.b))) continue;
            --left_;
            for (std::int32_t end : {e.a, e.b}) {
                for (; end >= 0; end = next_[idx(end)]) connectors_.push_back(end);
            }
        }
    }

    // Takes in the cells that are reached; false where there are none.
    bool step_on(std::int32_t steps) {
        bool any = false;
        for (std::int32_t c = 0; c < p_.cells(); ++c) {
            const std::int32_t from = reached_[idx(c)];
            if (from == std::numeric_limits<std::int32_t>::max()) continue;
            any = true;
            steps_[idx(c)] = steps + 1;
            next_[idx(c)] = from;
            merge(of_cell(c), of_cell(from));
        }
        return any;
    }

    // Sets of cells alone, and what else overlaps where there is one set of candidates by now.
    void join_the_rest() {
        const std::vector<std::int32_t> set = roots();
        const Contested contested = contested_of(
            p_, totals_, set, std::vector<std::int32_t>(set.size(), 0), p_.rule.threshold);
        std::mutex merging;
        across(
            threads_, p_, totals_, contested,
            [&](std::int32_t, std::int32_t) { return p_.rule.threshold; },
            [&](std::int64_t, std::int32_t a, std::int32_t b, double o) {
                if (!p_.rule.enough(o)) return;
                const std::lock_guard lock(merging);
                merge(element(a), element(b));
            });
    }

    Joined result() {
        Joined out;
        std::vector<std::int32_t> name(idx(p_.components + p_.cells()), -1);
        const auto name_of = [&](std::int32_t element) {
            std::int32_t& n = name[idx(sets_.root(element))];
            if (n < 0) n = element;
            return n;
        };
        for (std::int32_t c = 0; c < p_.components; ++c) out.set_of_component.push_back(name_of(c));
        for (std::int32_t c = 0; c < p_.cells(); ++c)
            out.set_of_cell.push_back(is_left_out(c) ? left_out : name_of(of_cell(c)));
        out.complete = complete_;
        out.next = std::move(next_);
        out.connectors = std::move(connectors_);
        std::sort(out.connectors.begin(), out.connectors.end());
        out.connectors.erase(std::unique(out.connectors.begin(), out.connectors.end()),
                             out.connectors.end());
        return out;
    }

    const Threads& threads_;
    const JoinProblem& p_;
    std::vector<SeenTotal> totals_;
    DisjointSets sets_;  // of components, then of cells
    std::int64_t left_;  // sets with candidates
    bool complete_ = true;
    std::vector<std::int32_t> steps_;  // of each cell, to a candidate; 0: not known
    std::vector<std::int32_t> next_;
    std::vector<std::int32_t> reached_;
    std::vector<std::int32_t> connectors_;
};

}  // namespace

Joined join(const Threads& threads, const JoinProblem& problem, std::int64_t viewers) {
    return Joiner(threads, problem).run(viewers);
}

std::vector<SetPair> largest_overlaps(const Threads& threads, const JoinProblem& p,
                                      const Joined& joined) {
    if (!joined.complete) return {};
    const std::vector<SeenTotal> totals = seen_totals(p.local.rows, p.local.piece_length_m);
    std::vector<std::int32_t> set;
    for (const std::int32_t c : p.component) set.push_back(joined.set_of_component[idx(c)]);
    set.insert(set.end(), joined.set_of_cell.begin(), joined.set_of_cell.end());
    const Contested contested =
        contested_of(p, totals, set, std::vector<std::int32_t>(set.size(), 0), 0);
    // The largest ones found so far, by sets numbered anew: nobody looks for less.
    std::vector<std::int32_t> rank(set.size(), 0);
    std::size_t sets = 0;
    for (std::size_t r = 0; r < contested.node.size(); ++r) {
        const bool first = r == 0 || set[idx(contested.node[r])] != set[idx(contested.node[r - 1])];
        if (first) ++sets;
        rank[idx(contested.node[r])] = static_cast<std::int32_t>(sets - 1);
    }
    constexpr std::size_t sets_most = 1024;
    std::vector<std::atomic<double>> known(sets <= sets_most ? sets * sets : 0);
    const auto known_of = [&](std::int32_t a, std::int32_t b) -> std::atomic<double>& {
        const auto [low, high] = std::minmax(rank[idx(a)], rank[idx(b)]);
        return known[idx(low) * sets + idx(high)];
    };
    using Best = std::map<std::pair<std::int32_t, std::int32_t>, double>;
    std::vector<Best> best(contested.node.size() / rows_at_once + 1);
    across(
        threads, p, totals, contested,
        [&](std::int32_t a, std::int32_t b) {
            return known.empty() ? 0.0 : known_of(a, b).load(std::memory_order_relaxed);
        },
        [&](std::int64_t block, std::int32_t a, std::int32_t b, double o) {
            if (o <= 0) return;
            double& most = best[idx(block)][std::minmax(set[idx(a)], set[idx(b)])];
            most = std::max(most, o);
            if (known.empty()) return;
            std::atomic<double>& so_far = known_of(a, b);
            double before = so_far.load(std::memory_order_relaxed);
            while (before < o && !so_far.compare_exchange_weak(before, o)) continue;
        });
    Best all;
    for (const Best& some : best) {
        for (const auto& [pair, o] : some) all[pair] = std::max(all[pair], o);
    }
    std::vector<SetPair> out;
    for (const auto& [pair, o] : all) out.push_back({pair.first, pair.second, o});
    return out;
}

}  // namespace vfplan
