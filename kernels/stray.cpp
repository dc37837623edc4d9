#include "kernels/stray.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace vfplan {
namespace {

constexpr double times_least = 10;
constexpr double step_least = 1.5;  // one step takes away a third
constexpr int steps_most = 32;

using Members = std::vector<std::size_t>;

Box around(const std::vector<Box>& boxes, const Members& members) {
    Box out;
    for (const std::size_t i : members) {
        out.add(boxes[i].min);
        out.add(boxes[i].max);
    }
    return out;
}

double area(const Box& box, double margin) {
    // A line covers something too.
    constexpr double thinnest = 1e-3;
    const Vec2d size = box.size() + Vec2d(2 * margin, 2 * margin);
    return std::max(size.x(), thinnest) * std::max(size.y(), thinnest);
}

// The smaller side of the widest strip, across an axis, that no box reaches into; empty where there
// is none.
Members beyond_widest_gap(const std::vector<Box>& boxes, Members members, int axis) {
    std::sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(boxes[a].min[axis], a) < std::pair(boxes[b].min[axis], b);
    });
    double reached = -std::numeric_limits<double>::infinity();
    double widest = 0;
    std::size_t cut = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        const Box& box = boxes[members[i]];
        if (i > 0 && box.min[axis] - reached > widest) {
            widest = box.min[axis] - reached;
            cut = i;
        }
        reached = std::max(reached, box.max[axis]);
    }
    if (cut == 0) return {};
    const auto middle = members.begin() + static_cast<std::ptrdiff_t>(cut);
    Members low(members.begin(), middle);
    Members high(middle, members.end());
    // Of equal sides the one that the file begins with stays.
    const bool first_is_low =
        *std::min_element(low.begin(), low.end()) < *std::min_element(high.begin(), high.end());
    const bool low_stays = low.size() != high.size() ? low.size() > high.size() : first_is_low;
    return low_stays ? high : low;
}

// The boxes that alone make up a side of what is covered, at most four.
Members outermost(const std::vector<Box>& boxes, const Members& members) {
    Members out;
    for (const int axis : {0, 1}) {
        const auto by = [&](auto&& key) {
            out.push_back(*std::max_element(
                members.begin(), members.end(),
                [&](std::size_t a, std::size_t b) { return key(boxes[a]) < key(boxes[b]); }));
        };
        by([&](const Box& b) { return b.max[axis]; });
        by([&](const Box& b) { return -b.min[axis]; });
    }
    return out;
}

Members without(const Members& members, Members gone) {
    std::sort(gone.begin(), gone.end());
    Members out;
    std::set_difference(members.begin(), members.end(), gone.begin(), gone.end(),
                        std::back_inserter(out));
    return out;
}

}  // namespace

Strays find_strays(const std::vector<Box>& boxes, double margin) {
    Members members;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!boxes[i].empty()) members.push_back(i);
    }
    Strays out;
    out.whole = out.rest = around(boxes, members);
    if (members.size() < 2) return out;
    const Members all = members;
    const std::size_t most = std::max<std::size_t>(1, members.size() / 10);
    const double whole = area(out.whole, margin);
    double covered = whole;
    for (int step = 0; step < steps_most; ++step) {
        std::vector<Members> choices = {beyond_widest_gap(boxes, members, 0),
                                        beyond_widest_gap(boxes, members, 1)};
        // Of two that lie apart, neither is less far from the other: order decides, not size.
        if (members.size() > 2 || (choices[0].empty() && choices[1].empty())) {
            for (const std::size_t i : outermost(boxes, members)) choices.push_back({i});
        }
        Members best;
        double best_area = covered / step_least;
        for (const Members& gone : choices) {
            if (gone.empty() || all.size() - members.size() + gone.size() > most) continue;
            Members kept = without(members, gone);
            const double left = area(around(boxes, kept), margin);
            if (left < best_area) {
                best_area = left;
                best = std::move(kept);
            }
        }
        if (best.empty()) break;
        members = std::move(best);
        covered = best_area;
    }
    if (whole <= times_least * covered) return out;
    const Box rest = around(boxes, members);
    const Members gone = without(all, members);
    if (std::any_of(gone.begin(), gone.end(), [&](std::size_t i) {
            return boxes[i].contains(rest.min) && boxes[i].contains(rest.max);
        })) {
        return out;
    }
    out.boxes = gone;
    out.rest = rest;
    out.times = whole / covered;
    return out;
}

}  // namespace vfplan
