#include "engine/search/survive.h"

#include <algorithm>

#include "engine/graphs/blocks.h"
#include "engine/search/choosing.h"
#include "engine/search/dice.h"
#include "engine/search/structure.h"
#include "engine/search/ways.h"

namespace vfplan {
namespace {

class Survivor {
public:
    Survivor(const Problem& problem, const Choice& start, std::uint64_t seed)
        : p_(problem),
          c_(problem),
          structure_(problem, c_),
          dice_(seed),
          ways_(problem, c_, dice_),
          place_(idx(p_.columns()), -1),
          gain_(idx(p_.columns()), 0),
          met_(idx(p_.columns()), 0) {
        const Sparse blocks = find_blocks(p_.near);
        for (std::int32_t b = 0; b < blocks.size(); ++b) {
            block_size_.push_back(static_cast<std::int32_t>(blocks.of(b).size()));
        }
        blocks_of_ = transposed(blocks, p_.columns());
        for (const std::int32_t c : start) c_.add(c);
    }

    Choice run(std::int64_t steps) {
        std::vector<std::int32_t> all(idx(p_.rows()));
        for (std::int32_t r = 0; r < p_.rows(); ++r) all[idx(r)] = r;
        cover(all);
        join();
        strengthen();
        thin_out(c_.choice());
        if (c_.chosen().size() > survival_searched_most) return c_.choice();
        Choice best = c_.choice();
        double least_cost = cost();
        for (std::int64_t step = 0; step < steps && c_.chosen().size() > 1; ++step) {
            const double heat = 0.6 * (1 - static_cast<double>(step) / static_cast<double>(steps));
            one_step(heat);
            if (cost() >= least_cost) continue;
            least_cost = cost();
            best = c_.choice();
        }
        return best;
    }

private:
    // In stations: two that stand too near by each other count as half a one more.
    double cost() const {
        return static_cast<double>(c_.chosen().size()) +
               0.5 * static_cast<double>(c_.pairs_beside());
    }

    // Drops a ball of stations, mends, and keeps what costs no more, or seldom a little more.
    void one_step(double heat) {
        c_.forget_changes();
        const double before = cost();
        if (!ruin()) return;
        rows_.clear();
        for (const std::int32_t c : c_.changed_since(0)) {
            const auto rows = p_.rows_of.of(c);
            rows_.insert(rows_.end(), rows.begin(), rows.end());
        }
        std::sort(rows_.begin(), rows_.end());
        rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
        cover(rows_);
        join();
        strengthen();
        std::vector<std::int32_t> list;
        for (const std::int32_t c : c_.changed_since(0)) {
            if (!c_.is_chosen(c)) continue;
            list.push_back(c);
            list.insert(list.end(), c_.links(c).begin(), c_.links(c).end());
        }
        thin_out(std::move(list));
        const double worse = cost() - before;
        if (worse > 0 && dice_.unit() >= fading(worse / heat)) c_.back_to(0);
    }

    bool ruin() {
        const auto& chosen = c_.chosen();
        const std::int32_t seed =
            chosen[idx(dice_.below(static_cast<std::int64_t>(chosen.size())))];
        if (p_.fixed[idx(seed)] != 0) return false;
        const std::size_t wanted = idx(1 + dice_.below(most_dropped));
        ++now_;
        std::vector<std::int32_t> ball = {seed};
        met_[idx(seed)] = now_;
        for (std::size_t i = 0; i < ball.size() && ball.size() < wanted; ++i) {
            for (const std::int32_t n : c_.links(ball[i])) {
                if (ball.size() >= wanted) break;
                if (met_[idx(n)] == now_ || p_.fixed[idx(n)] != 0) continue;
                met_[idx(n)] = now_;
                ball.push_back(n);
            }
        }
        for (const std::int32_t c : ball) c_.remove(c);
        return true;
    }

    std::int32_t wanted(std::int32_t row) const {
        return std::min<std::int32_t>(2, static_cast<std::int32_t>(p_.columns_of.of(row).size()));
    }
    double weight(std::int32_t row) const {
        return 1.0 / static_cast<double>(p_.columns_of.of(row).size());
    }

    // Covers rows that lack it, those first that few columns cover.
    void cover(const std::vector<std::int32_t>& rows) {
        std::vector<std::int32_t> columns;
        std::int64_t lacking = 0;
        for (const std::int32_t r : rows) {
            if (c_.cover(r) >= wanted(r)) continue;
            lacking += wanted(r) - c_.cover(r);
            for (const std::int32_t c : p_.columns_of.of(r)) {
                if (c_.is_chosen(c)) continue;
                if (gain_[idx(c)] == 0) columns.push_back(c);
                gain_[idx(c)] += weight(r);
            }
        }
        const double noise = dice_.unit() * 0.5;
        const double joining = dice_.unit() * 1.5;
        while (lacking > 0) {
            double best = 0;
            std::int32_t next = -1;
            for (const std::int32_t c : columns) {
                if (gain_[idx(c)] <= least || c_.is_chosen(c)) continue;
                const auto links =
                    static_cast<double>(std::min<std::size_t>(2, c_.links(c).size()));
                const double score = gain_[idx(c)] * (1 - noise * dice_.unit()) + joining * links;
                if (score <= best) continue;
                best = score;
                next = c;
            }
            c_.add(next);
            for (const std::int32_t r : p_.rows_of.of(next)) {
                if (c_.cover(r) > wanted(r)) continue;
                --lacking;
                if (c_.cover(r) < wanted(r)) continue;
                for (const std::int32_t c : p_.columns_of.of(r)) {
                    if (!c_.is_chosen(c)) gain_[idx(c)] -= weight(r);
                }
            }
        }
        for (const std::int32_t c : columns) gain_[idx(c)] = 0;
    }

    // Joins the parts by the shortest ways.
    void join() {
        for (structure_.find_parts(); structure_.parts() > 1;) {
            const std::int32_t part = structure_.part(c_.chosen().front());
            for (const std::int32_t c :
                 way_from([&](std::int32_t c) { return structure_.part(c) == part; })) {
                c_.add(c);
                structure_.joins(c);
            }
        }
    }

    // A shortest way from the chosen that are on one side, to others that are not `apart`.
    template <class Side>
    std::vector<std::int32_t> way_from(const Side& side, std::int32_t apart = -1) {
        std::vector<std::int32_t> from;
        for (const std::int32_t c : c_.chosen()) {
            if (c != apart && side(c)) from.push_back(c);
        }
        return ways_.from(from, [&](std::int32_t n) {
            std::int32_t others = 0;
            for (const std::int32_t s : c_.links(n)) others += s != apart && !side(s) ? 1 : 0;
            return others;
        });
    }

    // The block of the graph that two columns with a link between them are in.
    std::int32_t shared_block(std::int32_t a, std::int32_t b) const {
        const auto of_a = blocks_of_.of(a);
        const auto of_b = blocks_of_.of(b);
        for (std::size_t i = 0, k = 0; i < of_a.size() && k < of_b.size();) {
            if (of_a[i] == of_b[k]) return of_a[i];
            ++(of_a[i] < of_b[k] ? i : k);
        }
        return -1;
    }

    // The plan's blocks in columns, and for each the graph's in which it lies.
    void find_plan_blocks() {
        const std::vector<std::int32_t>& chosen = c_.chosen();
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            place_[idx(chosen[i])] = static_cast<std::int32_t>(i);
        }
        Sparse links;
        for (const std::int32_t c : chosen) {
            for (const std::int32_t n : c_.links(c)) links.to.push_back(place_[idx(n)]);
            links.end_list();
        }
        blocks_ = find_blocks(links, &parts_);
        for (std::int32_t& v : blocks_.to) v = chosen[idx(v)];
        of_graph_.clear();
        for (std::int32_t b = 0; b < blocks_.size(); ++b) {
            of_graph_.push_back(shared_block(blocks_.of(b)[0], blocks_.of(b)[1]));
        }
    }

    // The plan's blocks that the graph would let be larger.
    std::vector<std::int32_t> weak_blocks() {
        find_plan_blocks();
        std::vector<std::int32_t> sorted = of_graph_;
        std::sort(sorted.begin(), sorted.end());
        std::vector<std::int32_t> out;
        for (std::int32_t b = 0; b < blocks_.size(); ++b) {
            const std::int32_t g = of_graph_[idx(b)];
            const auto [first, end] = std::equal_range(sorted.begin(), sorted.end(), g);
            const bool alone = blocks_.of(b).size() == 2 && block_size_[idx(g)] > 2;
            if (end - first > 1 || alone) out.push_back(b);
        }
        return out;
    }

    // Ways around what would part the plan, until nothing does that need not.
    void strengthen() {
        for (auto weak = weak_blocks(); !weak.empty(); weak = weak_blocks()) {
            const std::int32_t block =
                weak[idx(dice_.below(static_cast<std::int64_t>(weak.size())))];
            for (const std::int32_t c : way_around(block)) c_.add(c);
        }
    }

    std::vector<std::int32_t> way_around(std::int32_t block) {
        const auto members = blocks_.of(block);
        const std::int32_t g = of_graph_[idx(block)];
        // A station that holds the block together with another one of the same block of the graph.
        std::int32_t joint = -1;
        for (std::int32_t b = 0; b < blocks_.size() && joint < 0; ++b) {
            if (b == block || of_graph_[idx(b)] != g) continue;
            for (const std::int32_t c : blocks_.of(b)) {
                if (std::find(members.begin(), members.end(), c) != members.end()) joint = c;
            }
        }
        const std::int32_t a = members[0] == joint ? members[1] : members[0];
        // Without one: two stations and a link, which a way closes to a cycle.
        const std::int32_t b = members[0] == a ? members[1] : members[0];
        ++now_;
        std::vector<std::int32_t> queue = {a};
        met_[idx(a)] = now_;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const std::int32_t n : c_.links(queue[i])) {
                if (met_[idx(n)] == now_ || n == joint) continue;
                if (joint < 0 && queue[i] == a && n == b) continue;
                met_[idx(n)] = now_;
                queue.push_back(n);
            }
        }
        return way_from([&](std::int32_t c) { return met_[idx(c)] == now_; }, joint);
    }

    // Takes out what is not needed, in an order drawn by lot.
    void thin_out(std::vector<std::int32_t> list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        dice_.shuffle(list);
        for (const std::int32_t c : list) {
            if (!c_.is_chosen(c) || p_.fixed[idx(c)] != 0 || c_.chosen().size() < 2) continue;
            const auto rows = p_.rows_of.of(c);
            if (std::any_of(rows.begin(), rows.end(),
                            [&](std::int32_t r) { return c_.cover(r) <= wanted(r); })) {
                continue;
            }
            c_.remove(c);
            if (!weak_blocks().empty() || parts_ > 1) c_.add(c);
        }
    }

    static constexpr std::int32_t most_dropped = 8;
    static constexpr double least = 1e-9;

    const Problem& p_;
    Choosing c_;
    Structure structure_;
    Dice dice_;
    Ways ways_;
    Sparse blocks_of_;  // the graph's, by column
    std::vector<std::int32_t> block_size_;
    std::vector<std::int32_t> place_;  // of columns, among the chosen
    Sparse blocks_;                    // the plan's, in columns
    std::vector<std::int32_t> of_graph_;
    std::int32_t parts_ = 0;
    std::vector<double> gain_;
    std::vector<std::int32_t> rows_;
    std::vector<std::uint32_t> met_;
    std::uint32_t now_ = 0;
};

}  // namespace

Choice survive(const Problem& problem, const Choice& start, std::int64_t steps,
               std::uint64_t seed) {
    return Survivor(problem, start, seed).run(steps);
}

}  // namespace vfplan
