#include "engine/proofs/cases.h"

#include <algorithm>
#include <cmath>

#include "engine/search/improve.h"

namespace vfplan {
namespace {

constexpr std::size_t covers_at_once = 400;
constexpr std::size_t cuts_at_once = 80;
constexpr std::size_t node_cuts_at_once = 250;
constexpr std::int64_t rounds_of_a_case = 4;
constexpr std::int64_t rounds_of_the_first = 100000;

}  // namespace

Cases::Cases(Lines& lines, const Choice& plan, bool ways, const std::vector<ProofLine>& start)
    : lines_(lines),
      p_(lines.problem()),
      ways_(ways),
      plan_(plan),
      relaxation_(lines, static_cast<std::int64_t>(plan.size()), ways),
      broken_(lines),
      weighing_(lines),
      known_(idx(p_.columns()), Known::free) {
    for (const ProofLine& line : start) relaxation_.add(line);
    tree_.emplace_back();
    tree_.front().value = weighing_.value({}, {}, known_);
}

void Cases::run(Effort& effort, bool divided) {
    if (!tree_.front().tried) tighten(0, effort, rounds_of_the_first);
    while (divided && !effort.is_spent()) {
        std::int32_t weakest = -1;
        for (std::size_t i = 0; i < tree_.size(); ++i) {
            if (is_open(tree_[i]) && (weakest < 0 || tree_[i].value < tree_[idx(weakest)].value)) {
                weakest = static_cast<std::int32_t>(i);
            }
        }
        if (weakest < 0) return;
        if (!tree_[idx(weakest)].tried) {
            enter(weakest);
            tighten(weakest, effort, rounds_of_a_case);
            tree_[idx(weakest)].tried = true;
            if (effort.is_spent()) return;
        } else {
            enter(weakest);
            if (!relaxation_.solve(effort)) return;
        }
        if (is_open(tree_[idx(weakest)])) divide(weakest);
    }
}

std::int64_t Cases::value() const {
    std::int64_t least = Weighing::impossible;
    for (const Case& c : tree_) {
        if (c.child < 0) least = std::min(least, c.value);
    }
    return least;
}

std::int64_t Cases::bound() const {
    return std::min(stations_of(value()), static_cast<std::int64_t>(plan_.size()));
}

void Cases::enter(std::int32_t number) {
    std::vector<Known> then(known_.size(), Known::free);
    for (std::int32_t i = number; i > 0; i = tree_[idx(i)].parent) {
        then[idx(tree_[idx(i)].column)] = tree_[idx(i)].known;
    }
    for (std::size_t c = 0; c < then.size(); ++c) {
        if (then[c] != known_[c]) relaxation_.set_known(static_cast<std::int32_t>(c), then[c]);
    }
    known_ = std::move(then);
}

void Cases::tighten(std::int32_t number, Effort& effort, std::int64_t rounds) {
    double before = -1e300;
    std::int64_t stalled = 0;
    for (std::int64_t round = 0; round < rounds; ++round) {
        if (effort.is_spent() || !relaxation_.solve(effort)) return;
        std::vector<LineWeight> weights = relaxation_.weights();
        const std::int64_t value = weighing_.value(relaxation_.lines(), weights, known_);
        Case& mine = tree_[idx(number)];
        if (value > mine.value) {
            mine.value = value;
            mine.weights = std::move(weights);
        }
        if (!is_open(mine)) return;
        look_for_plan();
        if (!is_open(mine)) return;
        relaxation_.purge();
        stalled = relaxation_.value() < before + 1e-3 ? stalled + 1 : 0;
        before = std::max(before, relaxation_.value());
        if (stalled > 12) break;
        if (!add_lines(effort)) break;
    }
    tree_[idx(number)].tried = true;
}

bool Cases::add_lines(Effort& effort) {
    const Fraction& at = relaxation_.at();
    std::vector<ProofLine> found = broken_.covers(at, covers_at_once);
    const auto add = [&](std::vector<ProofLine> lines) {
        for (ProofLine& line : lines) found.push_back(std::move(line));
    };
    if (found.size() < covers_at_once / 4) {
        if (ways_) add(broken_.pairs(at, 4 * cuts_at_once));
        if (!ways_) add(broken_.nodes(at, node_cuts_at_once, effort));
        if (ways_) add(broken_.arcs(at, cuts_at_once, effort));
    }
    for (ProofLine& line : found) relaxation_.add(std::move(line));
    return !found.empty();
}

void Cases::look_for_plan() {
    Choice choice;
    bool is_whole = true;
    for (std::int32_t c = 0; c < p_.columns(); ++c) {
        const double x = relaxation_.at().x[idx(c)];
        if (x > 1e-6) choice.push_back(c);
        is_whole = is_whole && (x < 1e-6 || x > 1 - 1e-6);
    }
    if (is_whole) try_plan(choice);
}

void Cases::try_plan(const Choice& choice) {
    if (choice.size() >= plan_.size() || !is_plan(p_, choice)) return;
    plan_ = choice;
    relaxation_.set_stations(static_cast<std::int64_t>(plan_.size()));
}

std::int32_t Cases::column_to_divide_by() const {
    std::int32_t best = -1;
    double most = 1e-6;
    for (std::int32_t c = 0; c < p_.columns(); ++c) {
        const double x = relaxation_.at().x[idx(c)];
        const double half = std::min(x, 1 - x);
        // Among those near a half the one that means most.
        const double worth =
            half * (1 + 0.05 * static_cast<double>(p_.rows_of.of(c).size() + p_.near.of(c).size()));
        if (half < 1e-6 || worth <= most) continue;
        most = worth;
        best = c;
    }
    return best;
}

void Cases::divide(std::int32_t number) {
    std::int32_t column = column_to_divide_by();
    if (column < 0) {  // whole, but no plan by a hair: by any column that is still free
        for (std::int32_t c = 0; c < p_.columns() && column < 0; ++c) {
            if (known_[idx(c)] == Known::free && p_.fixed[idx(c)] == 0) column = c;
        }
        if (column < 0) return;
    }
    tree_[idx(number)].child = static_cast<std::int32_t>(tree_.size());
    const std::vector<LineWeight> weights = std::move(tree_[idx(number)].weights);
    tree_[idx(number)].weights.clear();
    for (const Known known : {Known::left_out, Known::chosen}) {
        Case next;
        next.parent = number;
        next.column = column;
        next.known = known;
        known_[idx(column)] = known;
        next.value = weighing_.value(relaxation_.lines(), weights, known_);
        next.weights = weights;
        tree_.push_back(std::move(next));
    }
    known_[idx(column)] = Known::free;
}

std::vector<ProofLine> Cases::lines_of_first() const {
    std::vector<ProofLine> out;
    for (const LineWeight& w : tree_.front().weights) {
        out.push_back(relaxation_.lines()[idx(w.line)]);
    }
    return out;
}

void Cases::write(NetworkProof& out) const {
    std::vector<std::int32_t> number(relaxation_.lines().size(), -1);
    std::vector<std::int32_t> waiting = {0};
    while (!waiting.empty()) {
        const Case& c = tree_[idx(waiting.back())];
        waiting.pop_back();
        ProofCase leaf;
        if (c.child >= 0) {
            leaf.branch = tree_[idx(c.child)].column;
            waiting.push_back(c.child + 1);
            waiting.push_back(c.child);
        }
        for (const LineWeight& w : c.weights) {
            if (number[idx(w.line)] < 0) {
                number[idx(w.line)] = static_cast<std::int32_t>(out.lines.size());
                out.lines.push_back(relaxation_.lines()[idx(w.line)]);
            }
            leaf.weights.push_back({number[idx(w.line)], w.weight});
        }
        out.cases.push_back(std::move(leaf));
    }
    out.bound = bound();
}

}  // namespace vfplan
