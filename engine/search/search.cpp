#include "engine/search/search.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "engine/search/choosing.h"
#include "engine/search/dice.h"
#include "engine/search/improve.h"
#include "engine/search/window.h"

namespace vfplan {
namespace {

// The search of a plan with fewer stations takes as many steps as if it had these: they cost
// little.
constexpr std::int64_t small_plan = 100;

// Plans of more than `above` stations are searched in windows of `stations`, all of them so many
// times. Larger windows find more and make steps dearer. Each costs a look at the whole: that of a
// large plan is taken for districts, which are searched in windows themselves.
struct Level {
    std::size_t above;
    std::size_t stations;
    std::int64_t rounds;
};
constexpr std::array<Level, 2> levels = {Level{400, 250, 4}, Level{20'000, 8'000, 2}};

using Stations = std::vector<std::int32_t>;
using Done = std::function<void(std::int64_t)>;

Choice search_plan(const Threads& threads, const Problem& problem, std::int32_t nodes,
                   const Choice& start, const ImproveOptions& options, const Done& done);

class WindowSearch {
public:
    // `nodes`: columns at the end that stand for what stands still outside the problem.
    // options.steps: for each station.
    WindowSearch(const Threads& threads, const Problem& problem, std::int32_t nodes,
                 const Choice& start, const ImproveOptions& options, const Level& level,
                 const Done& done)
        : threads_(threads),
          p_(problem),
          stations_end_(problem.columns() - nodes),
          plan_(problem),
          dice_(options.seed),
          options_(options),
          level_(level),
          done_(done) {
        for (const std::int32_t c : start) plan_.add(c);
    }

    Choice run() {
        const std::int64_t rounds = level_.rounds;
        for (std::int64_t round = 0; round < rounds; ++round) {
            work_on(divided(),
                    options_.steps * (round + 1) / rounds - options_.steps * round / rounds, false);
        }
        if (!options_.finish) return plan_.choice();
        work_on(divided(), 0, true);
        return close_all(p_, plan_.choice());
    }

private:
    // The plan in windows, grown along links.
    std::vector<Stations> divided() {
        std::vector<Stations> out;
        Stations order = plan_.choice();
        dice_.shuffle(order);
        std::vector<std::uint8_t> taken(idx(p_.columns()), 0);
        for (const std::int32_t seed : order) {
            if (taken[idx(seed)] != 0 || seed >= stations_end_) continue;
            Stations window = {seed};
            taken[idx(seed)] = 1;
            for (std::size_t i = 0; i < window.size(); ++i) {
                for (const std::int32_t n : plan_.links(window[i])) {
                    if (taken[idx(n)] != 0 || n >= stations_end_ ||
                        window.size() >= level_.stations) {
                        continue;
                    }
                    taken[idx(n)] = 1;
                    window.push_back(n);
                }
            }
            out.push_back(std::move(window));
        }
        return out;
    }

    // Sets of windows no two of which have stations that see a piece in common.
    std::vector<std::vector<std::size_t>> apart(const std::vector<Stations>& windows) const {
        std::vector<std::int32_t> window_of(idx(p_.columns()), -1);
        for (std::size_t w = 0; w < windows.size(); ++w) {
            for (const std::int32_t s : windows[w])
                window_of[idx(s)] = static_cast<std::int32_t>(w);
        }
        std::vector<std::int32_t> colour(windows.size(), -1);
        std::vector<std::vector<std::size_t>> out;
        for (std::size_t w = 0; w < windows.size(); ++w) {
            std::vector<std::uint8_t> near(out.size() + 1, 0);
            const auto touch = [&](std::int32_t c) {
                const std::int32_t other = window_of[idx(c)];
                if (other >= 0 && colour[idx(other)] >= 0) near[idx(colour[idx(other)])] = 1;
            };
            for (const std::int32_t s : windows[w]) {
                for (const std::int32_t n : plan_.links(s)) touch(n);
                for (const std::int32_t r : p_.rows_of.of(s)) {
                    if (plan_.cover(r) < 2) continue;
                    for (const std::int32_t c : p_.columns_of.of(r)) touch(c);
                }
            }
            const auto free =
                static_cast<std::size_t>(std::find(near.begin(), near.end(), 0) - near.begin());
            colour[w] = static_cast<std::int32_t>(free);
            if (free == out.size()) out.emplace_back();
            out[free].push_back(w);
        }
        return out;
    }

    void work_on(const std::vector<Stations>& windows, std::int64_t effort, bool finish) {
        for (const std::vector<std::size_t>& set : apart(windows)) {
            std::vector<Stations> better(set.size());
            std::vector<std::uint64_t> seeds;
            for (std::size_t i = 0; i < set.size(); ++i) seeds.push_back(dice_.next());
            threads_.for_each(
                static_cast<std::int64_t>(set.size()), 1, [&](std::int64_t from, std::int64_t to) {
                    for (auto i = idx(from); i < idx(to); ++i) {
                        better[i] = better_window(windows[set[i]], effort, seeds[i], finish);
                    }
                });
            // Each alone is right; all together they could part what each of them holds together
            // by way of the others.
            plan_.forget_changes();
            for (std::size_t i = 0; i < set.size(); ++i) replace(windows[set[i]], better[i]);
            if (is_plan(p_, plan_.choice())) continue;
            plan_.back_to(0);
            for (std::size_t i = 0; i < set.size(); ++i) {
                plan_.forget_changes();
                replace(windows[set[i]], better[i]);
                if (!is_plan(p_, plan_.choice())) plan_.back_to(0);
            }
        }
    }

    Stations better_window(const Stations& stations, std::int64_t effort, std::uint64_t seed,
                           bool finish) const {
        const Window w = make_window(p_, plan_, stations);
        const auto nodes = static_cast<std::int32_t>(
            std::count(w.column.begin(), w.column.end(), std::int32_t{-1}));
        Stations out;
        for (const std::int32_t c :
             search_plan(threads_, w.problem, nodes, w.start, {effort, seed, finish}, done_)) {
            if (w.column[idx(c)] >= 0) out.push_back(w.column[idx(c)]);
        }
        return out;
    }

    void replace(const Stations& before, const Stations& after) {
        for (const std::int32_t s : before) plan_.remove(s);
        for (const std::int32_t s : after) {
            if (!plan_.is_chosen(s)) plan_.add(s);  // else another window took it as well
        }
        plan_.bared().clear();
        plan_.spared().clear();
    }

    const Threads& threads_;
    const Problem& p_;
    std::int32_t stations_end_;
    Choosing plan_;
    Dice dice_;
    ImproveOptions options_;
    Level level_;
    const Done& done_;
};

// Whole, or in windows, or in districts of windows. options.steps: for each station.
Choice search_plan(const Threads& threads, const Problem& problem, std::int32_t nodes,
                   const Choice& start, const ImproveOptions& options, const Done& done) {
    const std::size_t stations = start.size() - idx(nodes);
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
        if (stations <= level->above) continue;
        return WindowSearch(threads, problem, nodes, start, options, *level, done).run();
    }
    const std::int64_t steps = options.steps * static_cast<std::int64_t>(stations);
    Choice out = improve(problem, start, {steps, options.seed, options.finish});
    if (done) done(steps);
    return out;
}

}  // namespace

std::int64_t search_steps(std::size_t stations, std::int64_t effort) {
    return effort * std::max(small_plan, static_cast<std::int64_t>(stations));
}

Choice search(const Threads& threads, const Problem& problem, const Choice& start,
              const SearchOptions& options) {
    if (static_cast<std::int64_t>(start.size()) < small_plan) {
        const std::int64_t steps = search_steps(start.size(), options.effort);
        Choice out = improve(problem, start, {steps, options.seed, true});
        if (options.done) options.done(steps);
        return out;
    }
    return search_plan(threads, problem, 0, start, {options.effort, options.seed, true},
                       options.done);
}

}  // namespace vfplan
