#include "engine/proofs/relaxation.h"

#include <algorithm>
#include <cmath>

namespace vfplan {
namespace {

// Of an iteration, as it turned out: without and with ways.
constexpr std::int64_t work_by_size = 3;
constexpr std::int64_t work_with_ways = 6;
constexpr std::size_t ways_at_once = 300;
constexpr std::size_t few_ways = 2500;  // come in all at once

}  // namespace

Relaxation::Relaxation(Lines& lines, std::int64_t stations, bool ways)
    : lines_(lines), p_(lines.problem()), stations_(stations), ways_(ways) {
    const auto price = 4.0 * static_cast<double>(stations + 1);
    for (std::int32_t c = 0; c < p_.columns(); ++c) {
        lp_.add_column(std::ldexp(static_cast<double>(lines.cost(c)), -24), 1);
        if (p_.fixed[idx(c)] != 0) lp_.set_bounds(c, 1, 1);
    }
    relief_ = lp_.columns();
    lp_.add_column(price, 2);
    if (!ways) return;
    first_root_ = lp_.columns();
    const auto& roots = lines.root().columns;
    for (std::size_t k = 0; k < roots.size(); ++k) lp_.add_column(0, 1);
    const std::int32_t first_missing = lp_.columns();
    for (std::int32_t c = 0; c < p_.columns(); ++c) lp_.add_column(price, 2);
    lp_way_.assign(p_.near.to.size(), -1);
    cost_.assign(lp_way_.size(), 0);
    std::vector<LpEntry> row;
    for (std::int32_t c = 0; c < p_.columns(); ++c) {
        row = {{c, -1}, {first_missing + c, 1}};
        for (std::size_t k = 0; k < roots.size(); ++k) {
            if (roots[k] == c) row.push_back({first_root_ + static_cast<std::int32_t>(k), 1});
        }
        row_of_into_.push_back(lp_.rows());
        lp_.add_row(row, 0, true);
        line_of_row_.push_back(-1);
        idle_.push_back(0);
        for (std::size_t k = 0; k < p_.near.of(c).size(); ++k) head_.push_back(c);
    }
    add({LineKind::root, -1, {}});
    for (const std::int32_t c : roots) add({LineKind::first, c, {}});
    if (lp_way_.size() > few_ways) return;
    for (std::size_t i = 0; i < lp_way_.size(); ++i) put_way(static_cast<std::int64_t>(i));
}

void Relaxation::add(ProofLine line) {
    all_.push_back(std::move(line));
    put(static_cast<std::int32_t>(all_.size()) - 1);
}

void Relaxation::put(std::int32_t number) {
    const ProofLine& line = all_[idx(number)];
    std::vector<LpEntry> row;
    lines_.each(line, [&](std::int32_t variable, int factor) {
        std::int32_t column = variable;
        if (variable >= lines_.r(0)) {
            column = first_root_ + variable - lines_.r(0);
        } else if (variable >= lines_.y(0)) {
            column = lp_way_[idx(variable - lines_.y(0))];
        }
        if (column >= 0) row.push_back({column, static_cast<double>(factor)});
    });
    if (line.kind != LineKind::pair) row.push_back({relief_, 1});
    lp_.add_row(row, static_cast<double>(Lines::least(line.kind)), Lines::is_equation(line.kind));
    line_of_row_.push_back(number);
    idle_.push_back(0);
}

void Relaxation::put_way(std::int64_t place) {
    const std::int32_t to = head_[idx(place)];
    const std::int32_t from = p_.near.to[idx(place)];
    std::vector<LpEntry> entries = {{row_of_into_[idx(to)], 1}};
    for (std::int32_t row = p_.columns(); row < lp_.rows(); ++row) {
        const ProofLine& line = all_[idx(line_of_row_[idx(row)])];
        if (line.kind == LineKind::pair) {
            const std::int32_t other = line.within.front();
            if ((line.of == from && other == to) || (line.of == to && other == from)) {
                entries.push_back({row, -1});
            }
        } else if (line.kind == LineKind::arcs || line.kind == LineKind::arcs_of) {
            const auto has = [&](std::int32_t c) {
                return std::binary_search(line.within.begin(), line.within.end(), c);
            };
            if (has(to) && !has(from)) entries.push_back({row, 1});
        }
    }
    lp_way_[idx(place)] = lp_.columns();
    lp_.add_column(0, 1, entries);
}

void Relaxation::set_known(std::int32_t column, Known known) {
    if (p_.fixed[idx(column)] != 0) return;
    lp_.set_bounds(column, known == Known::chosen ? 1 : 0, known == Known::left_out ? 0 : 1);
}

std::vector<LineWeight> Relaxation::weights() const {
    std::vector<LineWeight> out;
    for (std::int32_t row = 0; row < lp_.rows(); ++row) {
        const std::int32_t line = line_of_row_[idx(row)];
        if (line < 0) continue;
        std::int64_t weight = std::llround(std::ldexp(lp_.weight_of_row(row), 24));
        if (!Lines::is_equation(all_[idx(line)].kind)) weight = std::max<std::int64_t>(weight, 0);
        if (weight != 0) out.push_back({line, weight});
    }
    return out;
}

std::size_t Relaxation::price(Effort& effort) {
    for (std::size_t i = 0; i < cost_.size(); ++i) {
        cost_[i] = -lp_.weight_of_row(row_of_into_[idx(head_[i])]);
    }
    std::int64_t work = static_cast<std::int64_t>(cost_.size());
    for (std::int32_t row = p_.columns(); row < lp_.rows(); ++row) {
        const double weight = lp_.weight_of_row(row);
        if (weight == 0) continue;
        lines_.each(all_[idx(line_of_row_[idx(row)])], [&](std::int32_t variable, int factor) {
            ++work;
            if (variable < lines_.y(0) || variable >= lines_.r(0)) return;
            cost_[idx(variable - lines_.y(0))] -= weight * factor;
        });
    }
    effort.spend(work);
    std::vector<std::pair<double, std::int64_t>> found;
    for (std::size_t i = 0; i < cost_.size(); ++i) {
        if (lp_way_[i] < 0 && cost_[i] < -1e-6) {
            found.emplace_back(cost_[i], static_cast<std::int64_t>(i));
        }
    }
    std::sort(found.begin(), found.end());
    if (found.size() > ways_at_once) found.resize(ways_at_once);
    for (const auto& [cost, place] : found) put_way(place);
    return found.size();
}

bool Relaxation::solve(Effort& effort) {
    const double limit = static_cast<double>(stations_ - 1) + 1e-3;
    bool primal = false;
    while (true) {
        const std::int64_t size =
            (ways_ ? work_with_ways : work_by_size) * (lp_.rows() + lp_.columns());
        const std::int64_t before = lp_.iterations();
        const LpEnd end = lp_.solve(1 + effort.left / size, limit, primal);
        effort.spend((lp_.iterations() - before + 1) * size);
        if (end == LpEnd::stopped) return false;
        if (!ways_ || price(effort) == 0) break;
        primal = true;
        if (effort.is_spent()) return false;
    }
    read();
    return true;
}

void Relaxation::read() {
    at_.x.resize(idx(p_.columns()));
    for (std::int32_t c = 0; c < p_.columns(); ++c) at_.x[idx(c)] = lp_.of_column(c);
    if (!ways_) return;
    at_.y.assign(lp_way_.size(), 0);
    for (std::size_t i = 0; i < lp_way_.size(); ++i) {
        if (lp_way_[i] >= 0) at_.y[i] = lp_.of_column(lp_way_[i]);
    }
    at_.r.resize(lines_.root().columns.size());
    for (std::size_t k = 0; k < at_.r.size(); ++k) {
        at_.r[k] = lp_.of_column(first_root_ + static_cast<std::int32_t>(k));
    }
}

void Relaxation::purge() {
    constexpr std::int32_t patience = 4;
    std::vector<std::int32_t> gone;
    for (std::int32_t row = 0; row < lp_.rows(); ++row) {
        if (line_of_row_[idx(row)] < 0) continue;
        idle_[idx(row)] = lp_.is_slack(row) ? idle_[idx(row)] + 1 : 0;
        if (idle_[idx(row)] > patience) gone.push_back(row);
    }
    lp_.delete_rows(gone);
    const auto erase = [&](std::vector<std::int32_t>& list) {
        std::size_t kept = 0;
        std::size_t next = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (next < gone.size() && idx(gone[next]) == i) {
                ++next;
            } else {
                list[kept++] = list[i];
            }
        }
        list.resize(kept);
    };
    erase(line_of_row_);
    erase(idle_);
}

}  // namespace vfplan
