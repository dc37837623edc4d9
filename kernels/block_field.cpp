// Long because one walk over the rays of a block, its runs and its gaps shares all that it knows.
#include "kernels/block_field.h"

#include <emmintrin.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>
#include <utility>

#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr double past_rad = 1e-9;  // how far beside an end a ray is cast
constexpr int rounds_most = 32;

double angle_rad(const Vec2d& u, const Vec2d& v) { return angle_upper_rad(cross(u, v), u.dot(v)); }

Vec2d beside(const Vec2d& d, double rad) { return (d + rad * Vec2d(-d.y(), d.x())) / d.norm(); }

bool between(const Vec2d& from, const Vec2d& d, const Vec2d& to) {
    return cross(from, d) > 0 && cross(d, to) > 0;
}

// One bit for each place in which two packets' answers differ.
std::uint32_t differing(const PerRay<std::int32_t>& p, const PerRay<std::int32_t>& q) {
    const auto equal4 = [&](std::size_t i) {
        return _mm_cmpeq_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(&p[i])),
                               _mm_loadu_si128(reinterpret_cast<const __m128i*>(&q[i])));
    };
    const __m128i low = _mm_packs_epi32(equal4(0), equal4(4));
    const __m128i high = _mm_packs_epi32(equal4(8), equal4(12));
    return 0xffffU & ~static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
}

// One bit for each ray that met nothing.
std::uint32_t open(const PerRay<std::int32_t>& p) {
    PerRay<std::int32_t> nothing;
    nothing.fill(-1);
    return 0xffffU & ~differing(p, nothing);
}

// A wall's ends as the eye sees them: clockwise-most and counter-clockwise-most.
struct Ends {
    Vec2d begin;
    Vec2d end;
    double area;  // of their parallelogram
    Ends(const Wall& wall, const Vec2d& eye)
        : begin(wall.a - eye), end(wall.b - eye), area(cross(begin, end)) {
        if (area < 0) std::swap(begin, end);
    }
};

}  // namespace

WallEnds::WallEnds(const std::vector<Wall>& walls) : next_(2 * walls.size()) {
    std::vector<std::int32_t> order(next_.size());
    std::iota(order.begin(), order.end(), 0);
    const auto point = [&](std::int32_t end) -> const Vec2d& {
        const Wall& w = walls[idx(end / 2)];
        return end % 2 == 0 ? w.a : w.b;
    };
    std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
        const Vec2d& p = point(i);
        const Vec2d& q = point(j);
        return std::tuple(p.x(), p.y(), i) < std::tuple(q.x(), q.y(), j);
    });
    for (std::size_t i = 0; i < order.size();) {
        std::size_t end = i + 1;
        while (end < order.size() && point(order[end]) == point(order[i])) ++end;
        for (std::size_t k = i; k < end; ++k) {
            next_[idx(order[k])] = order[k + 1 < end ? k + 1 : i];
        }
        i = end;
    }
}

BlockField::BlockField(const std::vector<Wall>& walls, const WallEnds& ends, const Scanner& scanner,
                       const std::vector<Vec2d>& directions, RayTracer& tracer)
    : walls_(walls),
      ends_(ends),
      scanner_(scanner),
      directions_(directions),
      tracer_(tracer),
      tan_limit_(tan_incidence(scanner)),
      max2_(scanner.range_max_m * scanner.range_max_m),
      min2_(scanner.range_min_m * scanner.range_min_m),
      rays_(static_cast<std::int32_t>(directions.size() / packet_rays)),
      step_rad_(2 * pi / rays_),
      met_(idx(rays_)) {}

// What is observed of a wall, when nothing hides it.
void BlockField::cut_into_parts(std::int32_t wall, const Vec2d& eye) {
    const Wall& w = walls_[idx(wall)];
    const double length = w.length_m();
    const bool on_left = orient(w.a, w.b, eye) >= 0;
    one_wall_.assign(1,
                     {wall, on_left ? left : right, on_left ? 0 : length, on_left ? length : 0, 0});
    observe(walls_, scanner_, eye, one_wall_, observed_);
    parts_.clear();
    for (const Span& s : observed_) {
        parts_.push_back({true, -1, -1, w.at(s.s_begin_m) - eye, w.at(s.s_end_m) - eye});
    }
}

// Quick, and true of nearly all walls: the scanner's range does not cut it anywhere.
bool BlockField::whole(std::int32_t wall, const Vec2d& eye, Stretch& out) const {
    if (wall < 0) return false;
    const Wall& w = walls_[idx(wall)];
    const Vec2d a = w.a - eye;
    const Vec2d b = w.b - eye;
    const double area = cross(a, b);
    if (!w.scanned || tan_limit_ >= 0 || a.squaredNorm() > max2_ || b.squaredNorm() > max2_ ||
        area * area < min2_ * (w.b - w.a).squaredNorm()) {
        return false;
    }
    const bool on_left = area >= 0;
    out.observed = true;
    out.from_end = 2 * wall + (on_left ? 0 : 1);
    out.to_end = 2 * wall + (on_left ? 1 : 0);
    out.from = on_left ? a : b;
    out.to = on_left ? b : a;
    return true;
}

BlockField::Stretch BlockField::stretch(std::int32_t wall, const Vec2d& eye, const Vec2d& direction,
                                        bool& mixed) {
    mixed = false;
    Stretch out;
    if (wall < 0 || !walls_[idx(wall)].scanned || whole(wall, eye, out)) return out;
    cut_into_parts(wall, eye);
    mixed = !parts_.empty();
    for (const Stretch& part : parts_) {
        if (cross(part.from, direction) >= 0 && cross(direction, part.to) >= 0) return part;
    }
    return out;
}

// On along the walls that share the stretch's end, until they turn back or reach `enough`. Whatever
// hides them stands nearer and is observed instead.
void BlockField::extend_to(Stretch& s, const Vec2d& eye, const Vec2d& enough) const {
    while (s.to_end >= 0 && cross(s.to, enough) > 0) {
        Stretch farther;
        for (std::int32_t e = ends_.next(s.to_end); e != s.to_end; e = ends_.next(e)) {
            Stretch other;
            if (!whole(e / 2, eye, other) || other.from_end != e) continue;
            if (cross(farther.observed ? farther.to : s.to, other.to) > 0) farther = other;
        }
        if (!farther.observed) return;
        s.to = farther.to;
        s.to_end = farther.to_end;
    }
}

void BlockField::extend_from(Stretch& s, const Vec2d& eye, const Vec2d& enough) const {
    while (s.from_end >= 0 && cross(enough, s.from) > 0) {
        Stretch farther;
        for (std::int32_t e = ends_.next(s.from_end); e != s.from_end; e = ends_.next(e)) {
            Stretch other;
            if (!whole(e / 2, eye, other) || other.to_end != e) continue;
            if (cross(other.from, farther.observed ? farther.from : s.from) > 0) farther = other;
        }
        if (!farther.observed) return;
        s.from = farther.from;
        s.from_end = farther.from_end;
    }
}

void BlockField::begin_run(std::int32_t wall, std::int32_t ray, std::uint32_t eye, Run& run) {
    run.wall = wall;
    run.first = ray;
    run.mixed = false;
    run.whole = whole(wall, eyes_[eye], run.at_end);
    if (!run.whole) {
        run.at_end = stretch(wall, eyes_[eye], direction(ray, eye), run.mixed);
    }
}

// Accounts for what lies between the run's rays; at_end becomes what is observed at its last one.
void BlockField::end_run(Run& run, std::int32_t last, std::uint32_t eye) {
    if (last == run.first) return;
    if (!run.mixed) {
        if (!run.at_end.observed) unobserved_rad_[eye] += step_rad_ * (last - run.first);
        return;
    }
    const Vec2d& begin = direction(run.first, eye);
    const Vec2d& end = direction(last, eye);
    bool mixed = false;
    run.at_end = stretch(run.wall, eyes_[eye], end, mixed);
    double rad = angle_rad(begin, end);
    for (const Stretch& part : parts_) {
        const Vec2d from = cross(begin, part.from) > 0 ? part.from : begin;
        const Vec2d to = cross(part.to, end) > 0 ? part.to : end;
        if (cross(from, to) > 0) rad -= angle_rad(from, to);
    }
    unobserved_rad_[eye] += std::max(rad, 0.0);
}

// What lies between ray - 1, the last of its run, and `ray`, the first of the next.
void BlockField::between_runs(std::uint32_t eye, std::int32_t ray, const Run& run,
                              const Run& next) {
    const Vec2d& a = direction(ray == 0 ? rays_ - 1 : ray - 1, eye);
    const Vec2d& b = direction(ray, eye);
    if (run.at_end.observed && next.at_end.observed) {
        if (cross(run.at_end.to, b) <= 0 || cross(a, next.at_end.from) <= 0 ||
            cross(run.at_end.to, next.at_end.from) <= 0) {
            return;
        }
    } else if (!run.at_end.observed && !next.at_end.observed) {
        unobserved_rad_[eye] += step_rad_;
        return;
    }
    Stretch before = run.at_end;
    Stretch after = next.at_end;
    if (before.observed && after.observed) {
        extend_to(before, eyes_[eye], after.from);
        if (cross(before.to, after.from) <= 0) return;
        extend_from(after, eyes_[eye], before.to);
        if (cross(before.to, after.from) <= 0) return;
        gaps_.push_back({eye, ray, true, true, -1, before.to, after.from});
        return;
    }
    if (before.observed) {
        extend_to(before, eyes_[eye], b);
    } else {
        extend_from(after, eyes_[eye], a);
    }
    if (before.observed && cross(before.to, b) > 0) {
        gaps_.push_back({eye, ray, true, false, next.wall, before.to, b});
    } else if (after.observed && cross(a, after.from) > 0) {
        gaps_.push_back({eye, ray, false, true, run.wall, a, after.from});
    } else {
        const std::int32_t wall = before.observed ? next.wall : run.wall;
        if (wall < 0) return;  // open, but for rounding: the other wall reaches all across
        // Something that is not observed stands in front: it begins, or ends, in between.
        const Ends ends(walls_[idx(wall)], eyes_[eye]);
        const Vec2d& border = before.observed ? ends.begin : ends.end;
        if (!between(a, border, b)) {
            unobserved_rad_[eye] += step_rad_ / 2;
        } else {
            unobserved_rad_[eye] += before.observed ? angle_rad(border, b) : angle_rad(a, border);
        }
    }
}

const Vec2d& BlockField::direction(std::int32_t ray, std::uint32_t eye) const {
    return directions_[packet_rays * idx(ray) + eye];
}

// How much of the directions from `a` to `b`, between rays `ray` - 1 and `ray`, no wall covers that
// other eyes of the block met about there.
double BlockField::uncovered_rad(std::uint32_t eye, std::int32_t ray, const Vec2d& a,
                                 const Vec2d& b) {
    in_sky_.clear();
    std::array<std::int32_t, 2 * packet_rays> tried;
    std::size_t tries = 0;
    for (const std::int32_t r : {ray == 0 ? rays_ - 1 : ray - 1, ray}) {
        for (std::size_t i = 0; i < count_; ++i) {
            const std::int32_t wall = met_[idx(r)][i];
            if (wall < 0 ||
                std::find(tried.begin(), tried.begin() + tries, wall) != tried.begin() + tries) {
                continue;
            }
            tried[tries++] = wall;
            Stretch s;
            if (!whole(wall, eyes_[eye], s) || cross(s.from, b) <= 0 || cross(a, s.to) <= 0) {
                continue;
            }
            extend_from(s, eyes_[eye], a);
            extend_to(s, eyes_[eye], b);
            in_sky_.push_back(s);
        }
    }
    double rad = angle_rad(a, b);
    if (in_sky_.empty()) return rad;
    std::sort(in_sky_.begin(), in_sky_.end(),
              [](const Stretch& p, const Stretch& q) { return cross(p.from, q.from) > 0; });
    Vec2d reached = a;
    for (const Stretch& s : in_sky_) {
        const Vec2d from = cross(reached, s.from) > 0 ? s.from : reached;
        const Vec2d to = cross(s.to, b) > 0 ? s.to : b;
        if (cross(from, to) <= 0) continue;
        rad -= angle_rad(from, to);
        reached = to;
    }
    return rad;
}

// Eyes whose rays `ray` - 1 and `ray` met nothing, while other eyes' rays met walls.
void BlockField::look_into_sky(std::int32_t ray, std::uint32_t all) {
    const std::int32_t ray_before = ray == 0 ? rays_ - 1 : ray - 1;
    const std::uint32_t sky = all & open(met_[idx(ray_before)]) & open(met_[idx(ray)]);
    if (sky == all) return;
    for (std::uint32_t eyes = sky; eyes != 0; eyes &= eyes - 1) {
        const auto k = static_cast<std::uint32_t>(std::countr_zero(eyes));
        unobserved_rad_[k] +=
            uncovered_rad(k, ray, direction(ray_before, k), direction(ray, k)) - step_rad_;
    }
}

void BlockField::look_at_rays() {
    PerRay<Run> first;
    PerRay<Run> run;
    for (std::uint32_t k = 0; k < count_; ++k) {
        begin_run(met_[0][k], 0, k, run[k]);
        first[k] = run[k];
    }
    const std::uint32_t all = (1U << count_) - 1;
    for (std::int32_t i = 1; i < rays_; ++i) {
        const PerRay<std::int32_t>& is = met_[idx(i)];
        const PerRay<std::int32_t>& was = met_[idx(i - 1)];
        look_into_sky(i, all);
        for (std::uint32_t bits = all & differing(was, is); bits != 0; bits &= bits - 1) {
            const auto k = static_cast<std::uint32_t>(std::countr_zero(bits));
            Stretch stretch_here;
            if (run[k].whole && whole(is[k], eyes_[k], stretch_here) &&
                cross(run[k].at_end.to, stretch_here.from) <= 0) {  // nearly always
                run[k].at_end = stretch_here;
                run[k].wall = is[k];
                run[k].first = i;
                continue;
            }
            Run next;
            begin_run(is[k], i, k, next);
            end_run(run[k], i - 1, k);
            between_runs(k, i, run[k], next);
            run[k] = next;
        }
    }
    look_into_sky(0, all);
    for (std::uint32_t k = 0; k < count_; ++k) {
        end_run(run[k], rays_ - 1, k);
        between_runs(k, 0, run[k], first[k]);
    }
}

void BlockField::past_from(Gap& gap, std::int32_t wall, const Vec2d& direction) {
    bool mixed = false;
    Stretch s = stretch(wall, eyes_[gap.eye], direction, mixed);
    if (s.observed) extend_to(s, eyes_[gap.eye], gap.to);
    if (!s.observed || cross(gap.from, s.to) <= 0) {
        gap.open_from = false;
        return;
    }
    if (cross(s.to, gap.to) <= 0) {
        gap.closed = true;
        if (gap.open_to || gap.occluder < 0) return;
        const Vec2d border = Ends(walls_[idx(gap.occluder)], eyes_[gap.eye]).begin;
        if (between(gap.from, border, gap.to)) {
            unobserved_rad_[gap.eye] += angle_rad(border, gap.to);
        }
        return;
    }
    gap.from = s.to;
}

void BlockField::before_to(Gap& gap, std::int32_t wall, const Vec2d& direction) {
    bool mixed = false;
    Stretch s = stretch(wall, eyes_[gap.eye], direction, mixed);
    if (s.observed) extend_from(s, eyes_[gap.eye], gap.from);
    if (!s.observed || cross(s.from, gap.to) <= 0) {
        gap.open_to = false;
        return;
    }
    if (cross(gap.from, s.from) <= 0) {
        gap.closed = true;
        if (gap.occluder < 0) return;
        const Vec2d border = Ends(walls_[idx(gap.occluder)], eyes_[gap.eye]).end;
        if (between(gap.from, border, gap.to)) {
            unobserved_rad_[gap.eye] += angle_rad(gap.from, border);
        }
        return;
    }
    gap.to = s.from;
}

void BlockField::follow_gaps(FieldCounts& counts) {
    struct Ray {
        std::size_t gap;
        bool from;
    };
    PerRay<Ray> what;
    PerRay<Vec2d> eyes;
    PerRay<Vec2d> directions;
    PerRay<std::int32_t> met;
    std::size_t waiting = 0;
    const auto flush = [&] {
        if (waiting == 0) return;
        tracer_.trace(eyes.data(), directions.data(), waiting, met.data());
        ++counts.packets;
        counts.steps += static_cast<std::int64_t>(waiting);
        counts.walls += static_cast<std::int64_t>(waiting);
        for (std::size_t i = 0; i < waiting; ++i) {
            Gap& gap = gaps_[what[i].gap];
            if (gap.closed) continue;
            if (what[i].from) {
                past_from(gap, met[i], directions[i]);
            } else {
                before_to(gap, met[i], directions[i]);
            }
        }
        waiting = 0;
    };
    const auto cast = [&](std::size_t gap, bool from, const Vec2d& direction) {
        what[waiting] = {gap, from};
        eyes[waiting] = eyes_[gaps_[gap].eye];
        directions[waiting] = direction;
        if (++waiting == packet_rays) flush();
    };
    for (int round = 0; round < rounds_most && !gaps_.empty(); ++round) {
        for (std::size_t g = 0; g < gaps_.size(); ++g) {
            const Gap gap = gaps_[g];
            if (gap.open_from) cast(g, true, beside(gap.from, past_rad));
            if (gap.open_to && !gap.open_from) cast(g, false, beside(gap.to, -past_rad));
        }
        flush();
        const auto done = [&](const Gap& gap) {
            if (gap.closed || cross(gap.from, gap.to) <= 0) return true;
            if (gap.open_from || gap.open_to) return false;
            unobserved_rad_[gap.eye] += uncovered_rad(gap.eye, gap.ray, gap.from, gap.to);
            return true;
        };
        gaps_.erase(std::remove_if(gaps_.begin(), gaps_.end(), done), gaps_.end());
    }
    for (const Gap& gap : gaps_) unobserved_rad_[gap.eye] += angle_rad(gap.from, gap.to);
    gaps_.clear();
}

void BlockField::angles(const PerRay<Vec2d>& eyes, std::size_t count, PerRay<double>& vf_rad,
                        FieldCounts& counts) {
    eyes_ = eyes;
    count_ = count;
    unobserved_rad_.fill(0);
    gaps_.clear();
    tracer_.set_eyes(eyes, count);
    for (std::size_t i = 0; i < met_.size(); ++i) {
        tracer_.along(&directions_[packet_rays * i], met_[i]);
    }
    look_at_rays();
    counts.cells += static_cast<std::int64_t>(count);
    counts.packets += rays_;
    counts.steps += rays_ * static_cast<std::int64_t>(count);
    follow_gaps(counts);
    for (std::size_t i = 0; i < count; ++i) {
        vf_rad[i] = std::clamp(2 * pi - unobserved_rad_[i], 0.0, 2 * pi);
    }
}

}  // namespace vfplan
