#include "engine/search/settle.h"

#include <algorithm>
#include <utility>

#include "engine/search/structure.h"

namespace vfplan {
namespace {

constexpr int rounds = 4;
constexpr std::size_t most_tried = 6;  // places for a station in a round
constexpr double least_gain = 1e-6;

class Settling {
public:
    Settling(const Problem& problem, const Choice& start, const PlaceScore& score)
        : p_(problem), c_(problem), structure_(problem, c_), score_(score) {
        for (const std::int32_t c : start) c_.add(c);
        loose_ = loose();
    }

    Choice run() {
        bool moved = true;
        for (int round = 0; round < rounds && moved; ++round) {
            moved = false;
            for (const std::int32_t c : c_.choice()) moved = move(c) || moved;
        }
        for (const std::int32_t c : c_.choice()) {
            if (c_.alone(c) == 0) replace(c, -1);
        }
        return c_.choice();
    }

private:
    std::int64_t loose() { return p_.loose.empty() ? 0 : structure_.find_cycles(); }

    bool move(std::int32_t c) {
        if (p_.fixed[idx(c)] != 0 || c_.chosen().size() < 2) return false;
        const double now = score_(c, c_, c);
        places_.clear();
        each_place(c, [&](std::int32_t other) {
            const double there = score_(other, c_, c);
            if (there > now + least_gain) places_.emplace_back(-there, other);
        });
        std::sort(places_.begin(), places_.end());
        for (std::size_t i = 0; i < std::min(places_.size(), most_tried); ++i) {
            if (replace(c, places_[i].second)) return true;
        }
        return false;
    }

    // Columns that cover all that only c does.
    template <class F>
    void each_place(std::int32_t c, const F& f) {
        rows_.clear();
        for (const std::int32_t r : p_.rows_of.of(c)) {
            if (c_.cover(r) == 1) rows_.push_back(r);
        }
        std::sort(rows_.begin(), rows_.end(), [&](std::int32_t a, std::int32_t b) {
            return std::pair(p_.columns_of.of(a).size(), a) <
                   std::pair(p_.columns_of.of(b).size(), b);
        });
        for (const std::int32_t other :
             rows_.empty() ? p_.near.of(c) : p_.columns_of.of(rows_.front())) {
            const auto row = p_.rows_of.of(other);
            if (!c_.is_chosen(other) && std::all_of(rows_.begin(), rows_.end(), [&](auto r) {
                    return std::binary_search(row.begin(), row.end(), r);
                })) {
                f(other);
            }
        }
    }

    // Takes `other` (-1: nothing) in place of c, if that leaves a plan as good.
    bool replace(std::int32_t c, std::int32_t other) {
        if (p_.fixed[idx(c)] != 0 || c_.chosen().size() < 2) return false;
        c_.forget_changes();
        if (other >= 0) c_.add(other);
        const bool joined = other < 0 || !c_.links(other).empty();
        if (joined && structure_.can_go(c)) {
            c_.remove(c);
            if (other < 0 || c_.chosen().size() < 2 || !c_.links(other).empty()) {
                const std::int64_t then = loose();
                if (then <= loose_) {
                    loose_ = then;
                    return true;
                }
            }
        }
        c_.back_to(0);
        return false;
    }

    const Problem& p_;
    Choosing c_;
    Structure structure_;
    const PlaceScore& score_;
    std::int64_t loose_ = 0;
    std::vector<std::int32_t> rows_;
    std::vector<std::pair<double, std::int32_t>> places_;
};

}  // namespace

Choice settle(const Problem& problem, const Choice& start, const PlaceScore& score) {
    return Settling(problem, start, score).run();
}

}  // namespace vfplan
