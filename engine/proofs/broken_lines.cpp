#include "engine/proofs/broken_lines.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vfplan {
namespace {

constexpr double grains = 1 << 20;
constexpr double broken = 0.02;     // by how much, at least
constexpr double something = 1e-6;  // less is nothing

std::int64_t in_grains(double value) {
    // A grain even where nothing flows, so that a cut that crosses fewer is less.
    return static_cast<std::int64_t>(std::llround(std::max(0.0, value) * grains)) + 1;
}

std::vector<ProofLine> most_broken(std::vector<std::pair<double, ProofLine>>& found,
                                   std::size_t most) {
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (found.size() > most) found.resize(most);
    std::vector<ProofLine> out;
    for (auto& f : found) out.push_back(std::move(f.second));
    return out;
}

// Lets the flow end in these columns only.
void open(Flow& flow, const std::vector<std::int32_t>& ends,
          std::span<const std::int32_t> columns) {
    flow.restore();
    for (const std::int32_t c : columns) {
        if (ends[idx(c)] >= 0) flow.set(ends[idx(c)], Flow::endless);
    }
}

void add_both(ProofLine lesser, ProofLine larger, std::vector<ProofLine>& out) {
    const bool two = lesser.within != larger.within;
    out.push_back(std::move(lesser));
    if (two) out.push_back(std::move(larger));
}

// Flow through some columns, each of which lets through what it is chosen for: columns come twice,
// 2k where the flow comes in and 2k + 1 where it leaves. Its source are the root candidates and,
// where `open`, all columns around.
class NodeFlow {
public:
    // place[column]: in `columns`, or -1.
    NodeFlow(const Problem& p, const Root& root, const std::vector<double>& x,
             const std::vector<std::int32_t>& columns, const std::vector<std::int32_t>& place,
             bool open)
        : columns_(columns),
          place_(place),
          source_(2 * static_cast<std::int32_t>(columns.size())),
          flow_(source_ + 2) {
        for (std::int32_t k = 0; 2 * k < source_; ++k) {
            const std::int32_t c = columns[idx(k)];
            flow_.add(2 * k, 2 * k + 1, in_grains(x[idx(c)]));
            end_.push_back(flow_.add(2 * k + 1, source_ + 1, 0));
            bool at_border = std::binary_search(root.columns.begin(), root.columns.end(), c);
            for (const std::int32_t b : p.near.of(c)) {
                const std::int32_t from = place[idx(b)];
                if (from >= 0) flow_.add(2 * from + 1, 2 * k, Flow::endless);
                at_border = at_border || (open && from < 0);
            }
            if (at_border) flow_.add(source_, 2 * k, Flow::endless);
        }
        flow_.keep();
    }

    std::int64_t run(std::span<const std::int32_t> ends, std::int64_t enough) {
        flow_.restore();
        for (const std::int32_t c : ends) {
            const std::int32_t k = place_[idx(c)];
            if (k >= 0) flow_.set(end_[idx(k)], Flow::endless);
        }
        return flow_.run(source_, source_ + 1, enough);
    }
    std::int64_t work() const { return flow_.work(); }

    // After a flow that was not enough. Columns that still reach the end, and those of the cut too;
    // columns that are not reached any more.
    std::vector<std::int32_t> near_sink() const { return side(flow_.sink_side(source_ + 1), 0, 1); }
    std::vector<std::int32_t> behind() const { return side(flow_.sink_side(source_ + 1), 1, 1); }
    std::vector<std::int32_t> far_from_source() const {
        return side(flow_.source_side(source_), 0, 0);
    }

private:
    std::vector<std::int32_t> side(const std::vector<std::uint8_t>& of, std::int32_t end,
                                   std::uint8_t wanted) const {
        std::vector<std::int32_t> out;
        for (std::int32_t k = 0; 2 * k < source_; ++k) {
            if (of[idx(2 * k + end)] == wanted) out.push_back(columns_[idx(k)]);
        }
        return out;
    }

    const std::vector<std::int32_t>& columns_;
    const std::vector<std::int32_t>& place_;
    std::int32_t source_;
    Flow flow_;
    std::vector<std::int32_t> end_;
};

}  // namespace

BrokenLines::BrokenLines(Lines& lines)
    : lines_(lines), p_(lines.problem()), dice_(0), by_way_(p_.columns() + 2) {
    const std::int32_t n = p_.columns();
    for (std::int32_t c = 0; c < n; ++c) {
        way_end_.push_back(by_way_.add(c, n + 1, 0));
        for (const std::int32_t b : p_.near.of(c)) {
            way_.push_back(by_way_.add(b, c, 0));
        }
    }
    for (const std::int32_t c : lines.root().columns) {
        root_.push_back(by_way_.add(n, c, 0));
    }
    by_way_.keep();
}

std::vector<std::int32_t> BrokenLines::drawn(std::int32_t count) {
    std::vector<std::int32_t> order(idx(count));
    std::iota(order.begin(), order.end(), 0);
    dice_.shuffle(order);
    return order;
}

std::vector<ProofLine> BrokenLines::covers(const Fraction& at, std::size_t most) const {
    std::vector<std::pair<double, ProofLine>> found;
    for (std::int32_t r = 0; r < p_.rows(); ++r) {
        double sum = 0;
        for (const std::int32_t c : p_.columns_of.of(r)) sum += at.x[idx(c)];
        if (sum < 1 - 1e-6) found.push_back({1 - sum, {LineKind::cover, r, {}}});
    }
    return most_broken(found, most);
}

std::vector<ProofLine> BrokenLines::pairs(const Fraction& at, std::size_t most) const {
    std::vector<std::pair<double, ProofLine>> found;
    for (std::int32_t c = 0; c < p_.columns(); ++c) {
        const auto near = p_.near.of(c);
        for (std::size_t k = 0; k < near.size(); ++k) {
            const std::int32_t b = near[k];
            if (b > c) break;
            const double both =
                at.y[idx(p_.near.begin[idx(c)]) + k] + at.y[idx(lines_.place(c, b))];
            for (const auto& [of, other] : {std::pair(b, c), std::pair(c, b)}) {
                const double by = both - at.x[idx(of)];
                if (by > broken) found.push_back({by, {LineKind::pair, of, {other}}});
            }
        }
    }
    return most_broken(found, most);
}

std::vector<ProofLine> BrokenLines::nodes(const Fraction& at, std::size_t most, Effort& effort) {
    const std::int32_t n = p_.columns();
    // Whether a row is cut off is told by the few columns that are chosen at all.
    std::vector<std::int32_t> few;
    std::vector<std::int32_t> number(idx(n), -1);
    for (std::int32_t c = 0; c < n; ++c) {
        if (at.x[idx(c)] <= something) continue;
        number[idx(c)] = static_cast<std::int32_t>(few.size());
        few.push_back(c);
    }
    NodeFlow quick(p_, lines_.root(), at.x, few, number, false);
    const auto order = drawn(p_.rows());
    std::vector<std::uint8_t> inside(idx(n), 0);  // of a cut found by now
    std::vector<std::int32_t> place(idx(n), -1);
    std::vector<ProofLine> out;
    std::int64_t work = 0;
    constexpr auto enough = static_cast<std::int64_t>((1 - broken) * grains);
    for (const std::int32_t row : order) {
        if (out.size() >= most || work + quick.work() > effort.left) break;
        const auto columns = p_.columns_of.of(row);
        const auto is_inside = [&](std::int32_t c) { return inside[idx(c)] != 0; };
        if (std::all_of(columns.begin(), columns.end(), is_inside)) continue;
        if (quick.run(columns, enough) >= enough) continue;
        // A cut crosses columns that are not chosen as well, and should cross few of them: those
        // around what lies behind the cut are looked at, the rest is taken for the source.
        std::vector<std::int32_t> region(columns.begin(), columns.end());
        for (const std::int32_t c : quick.behind()) region.push_back(c);
        std::sort(region.begin(), region.end());
        region.erase(std::unique(region.begin(), region.end()), region.end());
        for (std::size_t i = 0; i < region.size(); ++i) place[idx(region[i])] = 0;
        std::size_t from = 0;
        for (int hops = 0; hops < 2; ++hops) {
            const std::size_t to = region.size();
            for (; from < to; ++from) {
                for (const std::int32_t b : p_.near.of(region[from])) {
                    if (place[idx(b)] == 0 || (hops > 0 && number[idx(b)] >= 0)) continue;
                    place[idx(b)] = 0;
                    region.push_back(b);
                }
            }
        }
        std::sort(region.begin(), region.end());
        for (std::size_t i = 0; i < region.size(); ++i) {
            place[idx(region[i])] = static_cast<std::int32_t>(i);
        }
        NodeFlow local(p_, lines_.root(), at.x, region, place, true);
        const bool cut = local.run(columns, enough) < enough;
        work += local.work();
        for (const std::int32_t c : region) place[idx(c)] = -1;
        if (!cut) continue;
        ProofLine lesser{LineKind::nodes, row, local.near_sink()};
        ProofLine larger{LineKind::nodes, row, local.far_from_source()};
        for (const std::int32_t c : larger.within) inside[idx(c)] = 1;
        for (const std::int32_t c : columns) inside[idx(c)] = 1;
        add_both(std::move(lesser), std::move(larger), out);
    }
    effort.spend(work + quick.work());
    return out;
}

std::vector<ProofLine> BrokenLines::arcs(const Fraction& at, std::size_t most, Effort& effort) {
    const std::int32_t n = p_.columns();
    by_way_.restore();
    for (std::size_t i = 0; i < way_.size(); ++i) by_way_.set(way_[i], in_grains(at.y[i]));
    for (std::size_t k = 0; k < root_.size(); ++k) by_way_.set(root_[k], in_grains(at.r[k]));
    by_way_.keep();
    Flow quick(n + 2);
    std::vector<std::int32_t> quick_end;
    std::size_t place = 0;
    for (std::int32_t c = 0; c < n; ++c) {
        quick_end.push_back(quick.add(c, n + 1, 0));
        for (const std::int32_t b : p_.near.of(c)) {
            if (at.y[place] > something) quick.add(b, c, in_grains(at.y[place]));
            ++place;
        }
    }
    for (std::size_t k = 0; k < at.r.size(); ++k) {
        if (at.r[k] > something) quick.add(n, lines_.root().columns[k], in_grains(at.r[k]));
    }
    quick.keep();
    // Rows first, then columns that are chosen in part.
    std::vector<std::int32_t> order = drawn(p_.rows());
    std::vector<std::int32_t> columns;
    for (std::int32_t c = 0; c < n; ++c) {
        if (at.x[idx(c)] > broken) columns.push_back(c);
    }
    dice_.shuffle(columns);
    for (const std::int32_t c : columns) order.push_back(p_.rows() + c);
    std::vector<std::uint8_t> inside(idx(n), 0);
    std::vector<ProofLine> out;
    const std::int64_t before = by_way_.work();
    for (const std::int32_t number : order) {
        const std::int64_t work = by_way_.work() - before + quick.work();
        if (out.size() >= most || work > effort.left) break;
        const std::int32_t column = number - p_.rows();
        std::span<const std::int32_t> ends(&column, 1);
        double wanted = 1;
        if (column < 0) {
            ends = p_.columns_of.of(number);
        } else {
            wanted = at.x[idx(column)];
        }
        const auto is_inside = [&](std::int32_t c) { return inside[idx(c)] != 0; };
        if (std::all_of(ends.begin(), ends.end(), is_inside)) continue;
        const auto enough = static_cast<std::int64_t>((wanted - broken) * grains);
        open(quick, quick_end, ends);
        if (quick.run(n, n + 1, enough) >= enough) continue;
        open(by_way_, way_end_, ends);
        if (by_way_.run(n, n + 1, enough) >= enough) continue;
        const auto near_sink = by_way_.sink_side(n + 1);
        const auto near_source = by_way_.source_side(n);
        const LineKind kind = column < 0 ? LineKind::arcs : LineKind::arcs_of;
        ProofLine lesser{kind, column < 0 ? number : column, {}};
        ProofLine larger = lesser;
        for (std::int32_t c = 0; c < n; ++c) {
            if (near_sink[idx(c)] != 0) lesser.within.push_back(c);
            if (near_source[idx(c)] == 0) larger.within.push_back(c);
        }
        for (const std::int32_t c : lesser.within) inside[idx(c)] = 1;
        add_both(std::move(lesser), std::move(larger), out);
    }
    effort.spend(by_way_.work() - before + quick.work());
    return out;
}

}  // namespace vfplan
