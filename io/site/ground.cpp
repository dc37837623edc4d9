#include "io/site/ground.h"

#include <algorithm>
#include <cmath>

#include "io/site/passages.h"
#include "io/site/planar.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

class Finder : Passages {
public:
    Finder(const Subdivision& s, const std::vector<bool>& wall, const std::vector<bool>& shut,
           const SiteOptions& options)
        : Passages(s, wall, shut, options.snap_m), options_(options) {}

    Ground find() {
        flow_in_from_outside();
        inside_ = named_or_enclosed();
        keep_what_can_be_stood_on();
        reach();
        list_dropped();
        return std::move(out_);
    }

private:
    // Marks all that can be come to from the triangles in `front` over sides that `pass` lets
    // through.
    template <class Pass>
    void flood(std::vector<std::int32_t> front, std::vector<bool>& marked, Pass&& pass) const {
        for (const std::int32_t t : front) marked[idx(t)] = true;
        while (!front.empty()) {
            const std::int32_t t = front.back();
            front.pop_back();
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int32_t to = over(t, i);
                if (to < 0 || marked[idx(to)] || !pass(t, i, to)) continue;
                marked[idx(to)] = true;
                front.push_back(to);
            }
        }
    }

    struct Part {
        std::vector<std::int32_t> triangles;
        double area_m2 = 0;
    };
    // The parts of the triangles in `among` that hang together over sides that `pass` lets through.
    template <class Pass>
    std::vector<Part> parts(const std::vector<bool>& among, Pass&& pass) const {
        std::vector<Part> out;
        std::vector<bool> seen(n_, false);
        for (std::int32_t first = 0; idx(first) < n_; ++first) {
            if (!among[idx(first)] || seen[idx(first)]) continue;
            Part part;
            part.triangles.push_back(first);
            seen[idx(first)] = true;
            for (std::size_t k = 0; k < part.triangles.size(); ++k) {
                const std::int32_t t = part.triangles[k];
                part.area_m2 += triangle_m2(t);
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::int32_t to = over(t, i);
                    if (to < 0 || !among[idx(to)] || seen[idx(to)] || !pass(t, i)) continue;
                    seen[idx(to)] = true;
                    part.triangles.push_back(to);
                }
            }
            out.push_back(std::move(part));
        }
        return out;
    }

    // Too small to be more than a corner of what it was cut from.
    bool corner_like(const Part& part) const {
        Box box;
        for (const std::int32_t t : part.triangles) {
            for (std::size_t i = 0; i < 3; ++i) box.add(corner(s_.triangles.triangles[idx(t)], i));
        }
        return box.size().norm() * options_.snap_m <= 2 * options_.min_width_m;
    }

    // True when no wall parts some triangle of a part from one that is in `others`.
    bool touches(const Part& part, const std::vector<bool>& others) const {
        return std::any_of(part.triangles.begin(), part.triangles.end(), [&](std::int32_t t) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int32_t to = over(t, i);
                if (to >= 0 && others[idx(to)]) return true;
            }
            return false;
        });
    }

    // A circle of radius min_width_m fits into a part.
    bool roomy(const Part& part) const {
        const double radius = options_.min_width_m / options_.snap_m;
        std::vector<bool> in(n_, false);
        for (const std::int32_t t : part.triangles) {
            in[idx(t)] = true;
            const Triangle& tr = s_.triangles.triangles[idx(t)];
            const double a = (corner(tr, 1) - corner(tr, 2)).norm();
            const double b = (corner(tr, 2) - corner(tr, 0)).norm();
            const double c = (corner(tr, 0) - corner(tr, 1)).norm();
            if (orient(corner(tr, 0), corner(tr, 1), corner(tr, 2)) >= radius * (a + b + c)) {
                return true;  // within one triangle already
            }
        }
        std::vector<Line> border;
        for (const std::int32_t t : part.triangles) {
            const Triangle& tr = s_.triangles.triangles[idx(t)];
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int32_t to = over(t, i);
                if (to >= 0 && in[idx(to)]) continue;
                border.push_back({corner(tr, (i + 1) % 3), corner(tr, (i + 2) % 3)});
            }
        }
        return planar::inscribed_radius(border, radius / 100) >= radius;
    }

    void flow_in_from_outside() {
        outside_.assign(n_, false);
        std::vector<std::int32_t> front = at_the_rim();
        flood(std::move(front), outside_, [&](std::int32_t t, std::size_t i, std::int32_t to) {
            return !is_shut(t, i) && width_m(t, i) > options_.max_opening_m && !named(to) &&
                   !taken(to);
        });
    }

    std::vector<bool> named_or_enclosed() {
        Kinds all = 0;
        for (const Kinds k : s_.kinds) all = static_cast<Kinds>(all | k);
        std::vector<bool> inside(n_, false);
        outlined_ = (all & bit(outline_area)) != 0;
        if (outlined_) {
            for (std::int32_t t = 0; idx(t) < n_; ++t) {
                inside[idx(t)] = (s_.kinds[idx(t)] & bit(outline_area)) != 0 && !taken(t);
            }
        } else if ((all & bit(room_area)) != 0) {
            constexpr Kinds rooms = bit(room_area) | bit(doorway_area);
            std::vector<bool> between(n_, false);
            for (std::int32_t t = 0; idx(t) < n_; ++t) {
                inside[idx(t)] = (s_.kinds[idx(t)] & rooms) != 0 && !taken(t);
                between[idx(t)] = !inside[idx(t)] && !taken(t) && !outside_[idx(t)];
            }
            const std::vector<bool> rooms_only = inside;
            for (const Part& p : parts(between, [&](std::int32_t t, std::size_t i) {
                     return !is_shut(t, i) && width_m(t, i) >= options_.min_width_m;
                 })) {
                if (p.area_m2 <= options_.max_gap_m2 && touches(p, rooms_only)) {
                    for (const std::int32_t t : p.triangles) inside[idx(t)] = true;
                } else if (p.area_m2 > options_.max_gap_m2 && roomy(p)) {
                    drop(p, DropReason::unnamed);
                }
            }
        } else {
            for (std::int32_t t = 0; idx(t) < n_; ++t) {
                inside[idx(t)] = !outside_[idx(t)] && !taken(t);
            }
        }
        return inside;
    }

    void keep_what_can_be_stood_on() {
        out_.free.assign(n_, false);
        std::vector<bool> rest = inside_;
        for (const Part& p : parts(inside_, [&](std::int32_t t, std::size_t i) {
                 return width_m(t, i) >= options_.min_width_m;
             })) {
            if (p.area_m2 < options_.min_room_m2 || !roomy(p)) continue;
            ++out_.parts;
            out_.area_m2 += p.area_m2;
            for (const std::int32_t t : p.triangles) {
                out_.free[idx(t)] = true;
                rest[idx(t)] = false;
            }
        }
        // Corners that were cut off are no gap: they belong to the ground they lie at.
        const std::vector<bool> kept = out_.free;
        const auto everywhere = [](std::int32_t, std::size_t) { return true; };
        for (const Part& p : parts(rest, everywhere)) {
            if (corner_like(p) && touches(p, kept)) {
                out_.area_m2 += p.area_m2;
                for (const std::int32_t t : p.triangles) out_.free[idx(t)] = true;
            } else {
                drop(p, DropReason::narrow);
            }
        }
    }

    void reach() {
        out_.reached.assign(n_, false);
        std::vector<std::int32_t> front;
        for (std::int32_t t = 0; idx(t) < n_; ++t) {
            if (out_.free[idx(t)]) front.push_back(t);
        }
        flood(std::move(front), out_.reached, [&](std::int32_t, std::size_t, std::int32_t to) {
            return !outside_[idx(to)] && !taken(to);
        });
    }

    void drop(const Part& p, DropReason why) {
        const std::int32_t largest = *std::max_element(
            p.triangles.begin(), p.triangles.end(),
            [&](std::int32_t a, std::int32_t b) { return triangle_m2(a) < triangle_m2(b); });
        const Triangle& tr = s_.triangles.triangles[idx(largest)];
        dropped_.push_back({p,
                            {(corner(tr, 0) + corner(tr, 1) + corner(tr, 2)) / 3 * options_.snap_m,
                             why, p.area_m2, 0}});
    }

    // Faces count where they are dropped with no ground: in what is neither reached nor outside.
    // Beyond an outline there is no ground that could be.
    void list_dropped() {
        std::vector<bool> listed(n_, false);
        for (auto& [part, dropped] : dropped_) {
            for (const std::int32_t t : part.triangles) listed[idx(t)] = true;
        }
        std::vector<bool> voids(n_, false);
        for (std::int32_t t = 0; idx(t) < n_; ++t) {
            voids[idx(t)] = !listed[idx(t)] && !taken(t) && !outside_[idx(t)] &&
                            !out_.reached[idx(t)] && (inside_[idx(t)] || !outlined_);
        }
        out_.left_out.assign(n_, false);
        for (std::int32_t t = 0; idx(t) < n_; ++t) {
            out_.left_out[idx(t)] = (listed[idx(t)] || voids[idx(t)]) && !out_.free[idx(t)];
        }
        const auto everywhere = [](std::int32_t, std::size_t) { return true; };
        for (const Part& p : parts(voids, everywhere)) drop(p, DropReason::narrow);
        for (auto& [part, dropped] : dropped_) {
            for (const std::int32_t t : part.triangles) {
                if (out_.reached[idx(t)]) continue;
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::int32_t edge = s_.triangles.triangles[idx(t)].wall[i];
                    if (edge < 0 || !wall_[idx(edge)]) continue;
                    if (s_.cls[idx(edge)] == WallClass::obstacle) continue;
                    dropped.faces_m += width_m(t, i);
                }
            }
            out_.dropped.push_back(dropped);
        }
        std::sort(out_.dropped.begin(), out_.dropped.end(), [](const Dropped& a, const Dropped& b) {
            return std::tuple(-a.area_m2, a.at.x(), a.at.y()) <
                   std::tuple(-b.area_m2, b.at.x(), b.at.y());
        });
    }

    const SiteOptions& options_;
    std::vector<bool> outside_;
    std::vector<bool> inside_;
    bool outlined_ = false;  // outlines say what is inside
    std::vector<std::pair<Part, Dropped>> dropped_;
    Ground out_;
};

}  // namespace

Ground find_ground(const Subdivision& s, const std::vector<bool>& wall,
                   const std::vector<bool>& shut, const SiteOptions& options) {
    return Finder(s, wall, shut, options).find();
}

}  // namespace vfplan
