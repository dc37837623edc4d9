#include "engine/search/improve.h"

#include <algorithm>
#include <cassert>

#include "engine/search/choosing.h"
#include "engine/search/dice.h"
#include "engine/search/ears.h"
#include "engine/search/structure.h"
#include "engine/search/ways.h"

namespace vfplan {
namespace {

// Costs and weights are whole numbers, so that sums do not depend on their order.
constexpr std::int64_t one = 1 << 20;

class Improver {
public:
    Improver(const Problem& problem, const Choice& start, const ImproveOptions& options)
        : p_(problem),
          c_(problem),
          structure_(problem, c_),
          dice_(options.seed),
          ways_(problem, c_, dice_),
          ears_(problem, c_, structure_, ways_, dice_),
          steps_(options.steps),
          cycles_(!problem.loose.empty()),
          finish_(options.finish),
          gain_(idx(p_.columns()), 0),
          listed_(idx(p_.columns()), 0),
          met_(idx(p_.columns()), 0) {
        for (const std::int32_t c : start) c_.add(c);
        for (std::int32_t r = 0; r < p_.rows(); ++r) {
            weight_.push_back(one / static_cast<std::int64_t>(p_.columns_of.of(r).size()));
        }
    }

    Choice close_all() {
        if (cycles_) ears_.close(Ears::any_cost);
        return c_.choice();
    }

    Choice run() {
        if (cycles_) loose_ = ears_.close(finish_ ? Ears::any_cost : worth);
        thin_out(c_.choice());
        c_.forget_changes();
        best_ = c_.choice();
        cost_ = best_cost_ = cost();
        const double hot = 0.6;
        for (std::int64_t step = 0; step < steps_ && c_.chosen().size() > 1; ++step) {
            const double heat = hot * (1 - static_cast<double>(step) / static_cast<double>(steps_));
            if (!one_step(heat)) continue;
            if (cost_ < best_cost_) {
                best_ = c_.choice();
                best_cost_ = cost_;
            }
        }
        if (!cycles_ || !finish_) return best_;
        take(best_);
        loose_ = ears_.close(Ears::any_cost);
        thin_out(c_.choice());
        return c_.choice();
    }

private:
    void take(const Choice& choice) {
        for (const std::int32_t c : c_.choice()) c_.remove(c);
        for (const std::int32_t c : choice) c_.add(c);
        c_.forget_changes();
    }

    std::int64_t cost() const {
        const auto size = static_cast<std::int64_t>(c_.chosen().size());
        return size * one + loose_ * loose_cost + c_.pairs_beside() * beside_cost;
    }

    // Returns whether the choice is another one now.
    bool one_step(double heat) {
        c_.forget_changes();
        c_.bared().clear();
        c_.spared().clear();
        if (!ruin()) return false;
        cover_again();
        join();
        if (cycles_) loose_ = ears_.close(worth);
        thin_out_around();
        const std::int64_t now = cost();
        const auto worse = static_cast<double>(now - cost_) / static_cast<double>(one);
        if (worse > 0 && dice_.unit() >= fading(worse / heat)) {
            c_.back_to(0);
            return false;
        }
        cost_ = now;
        return true;
    }

    // Drops chosen columns around one of them, by links.
    bool ruin() {
        const auto& chosen = c_.chosen();
        std::int32_t seed = -1;
        for (int tries = 0; seed < 0 && tries < 32; ++tries) {
            const auto any = dice_.below(static_cast<std::int64_t>(chosen.size()));
            if (p_.fixed[idx(chosen[idx(any)])] == 0) seed = chosen[idx(any)];
        }
        if (seed < 0) return false;
        const std::size_t wanted = idx(2 + dice_.below(most_dropped - 1));
        ++now_;
        ball_.assign(1, seed);
        met_[idx(seed)] = now_;
        for (std::size_t i = 0; i < ball_.size() && ball_.size() < wanted; ++i) {
            const auto& links = c_.links(ball_[i]);
            const auto count = static_cast<std::int64_t>(links.size());
            const std::int32_t turn = count > 0 ? dice_.below(count) : 0;
            for (std::int64_t k = 0; k < count && ball_.size() < wanted; ++k) {
                const std::int32_t n = links[idx((k + turn) % count)];
                if (met_[idx(n)] == now_ || p_.fixed[idx(n)] != 0) continue;
                met_[idx(n)] = now_;
                ball_.push_back(n);
            }
        }
        for (const std::int32_t c : ball_) c_.remove(c);
        return true;
    }

    void choose(std::int32_t column) {
        c_.add(column);
        structure_.joins(column);
    }

    // Covers the bared rows: by their weight, which is more for rows that few columns cover, and by
    // the parts that a column would join.
    void cover_again() {
        structure_.find_parts();
        columns_.clear();
        bare_ = 0;
        for (const std::int32_t r : c_.bared()) {
            if (c_.cover(r) > 0) continue;
            ++bare_;
            for (const std::int32_t c : p_.columns_of.of(r)) {
                if (listed_[idx(c)] == 0) {
                    listed_[idx(c)] = 1;
                    columns_.push_back(c);
                }
                gain_[idx(c)] += weight_[idx(r)];
            }
        }
        c_.bared().clear();
        const double joining = dice_.unit() * 1.5 * static_cast<double>(one);
        const double noise = dice_.unit() * 0.5;
        while (bare_ > 0) {
            double best = -1e300;
            std::int32_t next = -1;
            for (const std::int32_t c : columns_) {
                if (gain_[idx(c)] == 0) continue;
                const double gain = static_cast<double>(gain_[idx(c)]) * (1 - noise * dice_.unit());
                const auto links = static_cast<std::int32_t>(c_.links(c).size());
                const std::int32_t most = std::min({links, structure_.parts(), 4}) - 1;
                if (gain + joining * most <= best) continue;
                const std::int32_t joined = most > 0 ? structure_.touches(c) - 1 : most;
                const double score = gain + joining * std::min(joined, most);
                if (score > best) {
                    best = score;
                    next = c;
                }
            }
            for (const std::int32_t r : p_.rows_of.of(next)) {
                if (c_.cover(r) > 0) continue;
                --bare_;
                for (const std::int32_t c : p_.columns_of.of(r)) gain_[idx(c)] -= weight_[idx(r)];
            }
            choose(next);
        }
        for (const std::int32_t c : columns_) {
            listed_[idx(c)] = 0;
            gain_[idx(c)] = 0;
        }
    }

    // Joins the parts: from the lightest, by the fewest columns to another one.
    void join() {
        while (structure_.parts() > 1) {
            std::int32_t part = -1;
            for (const std::int32_t c : c_.chosen()) {
                const std::int32_t mine = structure_.part(c);
                if (part < 0 || structure_.weight(mine) < structure_.weight(part)) part = mine;
            }
            members_.clear();
            for (const std::int32_t c : c_.chosen()) {
                if (structure_.part(c) == part) members_.push_back(c);
            }
            for (const std::int32_t c : ways_.from(members_, [&](std::int32_t n) {
                     const std::vector<std::int32_t>& links = c_.links(n);
                     const bool mine = std::any_of(links.begin(), links.end(), [&](std::int32_t s) {
                         return structure_.part(s) == part;
                     });
                     return structure_.touches(n) - (mine ? 1 : 0);
                 })) {
                choose(c);
            }
        }
    }

    void thin_out_around() {
        std::vector<std::int32_t> list = c_.spared();
        for (const std::int32_t c : c_.changed_since(0)) {
            if (c_.is_chosen(c)) list.push_back(c);
            // Where cycles count, most of what covers nothing alone closes one, and to ask is dear.
            for (const std::int32_t n : c_.links(c)) {
                if (!cycles_ || dice_.below(asked_in) == 0) list.push_back(n);
            }
        }
        thin_out(std::move(list));
    }

    // Takes out what is not needed.
    void thin_out(std::vector<std::int32_t> list) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        dice_.shuffle(list);
        for (const std::int32_t c : list) {
            if (!c_.is_chosen(c) || p_.fixed[idx(c)] != 0 || c_.alone(c) > 0 ||
                c_.chosen().size() < 2 || !structure_.can_go(c)) {
                continue;
            }
            c_.remove(c);
            if (!cycles_) continue;
            const std::int64_t then = structure_.find_cycles();
            if ((then - loose_) * loose_cost >= one) {
                c_.add(c);
            } else {
                loose_ = then;
            }
        }
    }

    static constexpr std::int32_t most_dropped = 15;
    static constexpr std::int32_t asked_in = 4;
    static constexpr double worth = 2;  // stations, of one that is not loose any more
    static constexpr std::int64_t beside_cost = one / 2;
    static constexpr auto loose_cost = static_cast<std::int64_t>(worth) * one;

    const Problem& p_;
    Choosing c_;
    Structure structure_;
    Dice dice_;
    Ways ways_;
    Ears ears_;
    std::int64_t steps_;
    bool cycles_;
    bool finish_;
    std::vector<std::int64_t> weight_;  // of rows
    std::int64_t loose_ = 0;            // stations, since the last close() or thin_out()
    std::int64_t cost_ = 0;
    std::int64_t best_cost_ = 0;
    Choice best_;
    std::int64_t bare_ = 0;  // rows
    std::vector<std::int64_t> gain_;
    std::vector<std::uint8_t> listed_;
    std::vector<std::int32_t> columns_;  // that cover bared rows
    std::vector<std::uint32_t> met_;
    std::uint32_t now_ = 0;
    std::vector<std::int32_t> ball_;
    std::vector<std::int32_t> members_;  // of a part
};

}  // namespace

Choice improve(const Problem& problem, const Choice& start, const ImproveOptions& options) {
    return Improver(problem, start, options).run();
}

Choice close_all(const Problem& problem, const Choice& start) {
    return Improver(problem, start, {}).close_all();
}

}  // namespace vfplan
