// A small town with the statistics that the paper gives for its own (appendix "Time and Space
// Complexity"): streets first, houses along them, then as many as each crop's share asks for.
#include "engine/generate/town.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/generate/shapes.h"
#include "engine/generate/town_crops.h"

namespace vfplan::generate {
namespace {

struct Street {
    Line line;
    double half_width = 3.5;
    double charm = 0;  // streets with more of it fill up first
};

// One building or a row of touching ones; kept or left out as a whole.
struct Lot {
    std::vector<Rect> rects;
    std::vector<std::vector<Vec2d>> outlines;
    int ring = 0;
    double score = 0;
    bool fixed = false;  // neither left out nor scaled
};

class Town {
public:
    Town(std::uint64_t seed, int attempt, const std::array<double, rings>& size)
        : random_(seed, 1, static_cast<std::uint64_t>(attempt)), size_(size) {}

    void build() {
        main_roads();
        districts();
        border_houses();
        civic();
        for (const Street& s : streets_) {
            for (const int side : {1, -1}) houses_along(s, side);
        }
    }

    // Picks the lots and scales them to the areas; false when a ring has too few, when houses
    // would have to grow, or when the town stops short of a border. `size` is then better for the
    // next attempt.
    bool choose(std::array<double, rings>& size, std::vector<RingMm>& out) {
        std::stable_sort(lots_.begin(), lots_.end(), [](const Lot& a, const Lot& b) {
            return a.fixed != b.fixed ? a.fixed : a.score > b.score;
        });
        bool good = borders_reached_ == 4;
        for (int r = 0; r < rings; ++r) {
            std::vector<const Lot*> chosen;
            int missing = ring_count(r);
            double fixed_m2 = 0;
            double free_m2 = 0;
            for (const Lot& lot : lots_) {
                const auto n = static_cast<int>(lot.outlines.size());
                if (lot.ring != r || n > missing) continue;
                missing -= n;
                chosen.push_back(&lot);
                for (const auto& o : lot.outlines)
                    (lot.fixed ? fixed_m2 : free_m2) += area_m2(to_mm(o));
            }
            const double scale2 = (ring_area(r) - fixed_m2) / free_m2;
            auto& s = size[static_cast<std::size_t>(r)];
            if (missing > 0) {
                s *= 0.97;
                good = false;
            } else if (scale2 > 1 || scale2 < 0.85) {
                s *= std::sqrt(scale2) * 1.03;
                good = false;
            }
            if (!good) continue;
            for (const Lot* lot : chosen) append(*lot, lot->fixed ? 1 : std::sqrt(scale2), out);
        }
        return good;
    }

private:
    static void append(const Lot& lot, double scale, std::vector<RingMm>& out) {
        Vec2d centre{0, 0};
        for (const Rect& r : lot.rects) centre += r.c / static_cast<double>(lot.rects.size());
        for (const auto& outline : lot.outlines) {
            RingMm ring;
            for (const Vec2d& p : outline) ring.push_back(to_mm(centre + (p - centre) * scale));
            out.push_back(std::move(ring));
        }
    }

    void main_roads() {
        const auto j = [&](double v) { return v + random_.range(-16, 16); };
        const std::array<Line, 4> bends{{{{-20, j(205)},
                                          {190, j(240)},
                                          {390, j(185)},
                                          {600, j(230)},
                                          {800, j(275)},
                                          {996, j(235)}},
                                         {{-20, j(500)},
                                          {180, j(470)},
                                          {400, j(520)},
                                          {640, j(475)},
                                          {820, j(520)},
                                          {996, j(480)}},
                                         {{j(330), -20},
                                          {j(300), 150},
                                          {j(370), 330},
                                          {j(320), 520},
                                          {j(380), 700},
                                          {j(330), 913}},
                                         {{j(650), -20},
                                          {j(690), 180},
                                          {j(640), 350},
                                          {j(700), 520},
                                          {j(640), 700},
                                          {j(720), 913}}}};
        for (std::size_t i = 0; i < bends.size(); ++i) {
            roads_[i] = rounded(bends[i]);
            streets_.push_back({roads_[i], 4.5, 1.0});
        }
    }

    // 3 x 3 districts between the main roads, each with its own street direction.
    int district_of(const Vec2d& p) const {
        const int row = (p.y() > across(roads_[0], 0, p.x()) ? 1 : 0) +
                        (p.y() > across(roads_[1], 0, p.x()) ? 1 : 0);
        const int column = (p.x() > across(roads_[2], 1, p.y()) ? 1 : 0) +
                           (p.x() > across(roads_[3], 1, p.y()) ? 1 : 0);
        return 3 * row + column;
    }

    void districts() {
        for (int k = 0; k < 9; ++k) {
            const int row = k / 3;
            const Vec2d middle{165 + 325.0 * (k % 3), 110 + 300.0 * row};
            const Vec2d d = direction(random_.below(direction_count));
            const Rect frame{middle, d, 320, 320};
            const double bend = random_.range(-30, 30);
            double charm = 0;
            const auto add = [&](const auto& point) {
                charm = random_.unit();
                Line run;
                for (double s = -320; s <= 320; s += 8) {
                    const Vec2d p = point(s);
                    const bool inside = p.x() > -20 && p.x() < town_w + 20 && p.y() > -20 &&
                                        p.y() < town_h + 20 && district_of(p) == k;
                    if (inside) run.push_back(p);
                    if (!inside || s + 8 > 320) {
                        if (run.size() > 4) streets_.push_back({run, 3.2, charm});
                        run.clear();
                    }
                }
            };
            for (double t = -320 + random_.range(0, 50); t < 320; t += random_.range(53, 62)) {
                add([&](double s) { return frame.at(s, t + bend * (s / 200) * (s / 200)); });
            }
            for (double s = -320 + random_.range(0, 120); s < 320; s += random_.range(130, 200)) {
                add([&](double t) { return frame.at(s, t); });
            }
        }
    }

    // Inside the town, apart from streets and other lots, and clear of the crops' borders, so
    // that scaling moves no building from one ring to another.
    bool fits(const Rect& r, double gap, double street_gap) const {
        const Vec2d h = r.half_box();
        if (r.c.x() < h.x() || r.c.y() < h.y() || r.c.x() > town_w - h.x() ||
            r.c.y() > town_h - h.y()) {
            return false;
        }
        for (const Crop& c : crops) {
            if (c.w < town_w && std::abs(r.c.x() - c.w) < 3 && r.c.y() < c.h + 3) return false;
            if (c.h < town_h && std::abs(r.c.y() - c.h) < 3 && r.c.x() < c.w + 3) return false;
        }
        for (const Street& s : streets_) {
            for (std::size_t i = 0; i + 1 < s.line.size(); ++i) {
                const Vec2d v = s.line[i + 1] - s.line[i];
                const double length = v.norm();
                const Rect piece{0.5 * (s.line[i] + s.line[i + 1]), v / length, length / 2,
                                 s.half_width};
                if (closer_than(r, piece, street_gap)) return false;
            }
        }
        return std::none_of(lots_.begin(), lots_.end(), [&](const Lot& lot) {
            return std::any_of(lot.rects.begin(), lot.rects.end(),
                               [&](const Rect& o) { return closer_than(r, o, gap); });
        });
    }

    // The bounding box's centre decides about the crop, as it does for who measures the town.
    static int ring_of_outline(const std::vector<Vec2d>& outline) {
        Box box;
        for (const Vec2d& p : outline) box.add(p);
        const Vec2d c = 0.5 * (box.min + box.max);
        return ring_of(c.x(), c.y());
    }

    bool add(const Rect& r, char shape, double gap, double street_gap, double score,
             bool fixed = false) {
        if (!fits(r, gap, street_gap)) return false;
        Lot lot{{r}, {house_outline(random_, r, shape)}, 0, score, fixed};
        lot.ring = ring_of_outline(lot.outlines[0]);
        // A notch moves the box's centre, by less than the 3 m that fits() keeps.
        if (lot.ring != ring_of(r.c.x(), r.c.y())) return false;
        lots_.push_back(std::move(lot));
        return true;
    }

    // One house at each border, so that the town measures 976 x 893 m.
    void border_houses() {
        const double inset = 0.25;
        const Rect house{{0, 0}, {1, 0}, 5.25, 4.5};
        const auto place = [&](int side) {
            for (int i = 0; i < 400; ++i) {
                Rect r = house;
                const double x = random_.range(60, town_w - 60);
                const double y = random_.range(450, 860);
                if (side == 0) r.c = {r.along + inset, y};
                if (side == 1) r.c = {town_w - r.along - inset, y};
                if (side == 2) r.c = {x, r.deep + inset};
                if (side == 3) r.c = {x, town_h - r.deep - inset};
                if (add(r, 'r', 3, 3, 2, true)) {
                    ++borders_reached_;
                    return;
                }
            }
        };
        for (int side = 0; side < 4; ++side) place(side);
    }

    // School, church, halls: before the houses, which would leave no room.
    void civic() {
        struct Kind {
            char shape;
            double w, d, fill;
        };
        constexpr std::array<Kind, 6> kinds{{{'U', 54, 36, 0.66},
                                             {'+', 36, 20, 0.6},
                                             {'r', 44, 24, 1},
                                             {'r', 28, 17, 1},
                                             {'L', 40, 30, 0.75},
                                             {'T', 34, 24, 0.75}}};
        for (int r = 0; r < rings; ++r) {
            const Crop& crop = crops[static_cast<std::size_t>(r)];
            const double from = r > 1 ? crops[static_cast<std::size_t>(r) - 1].h : 0;
            double left = crop.civic_m2;
            int next = r == 0 ? 0 : random_.below(4);
            for (int i = 0; i < 600 && left > 200; ++i) {
                const Kind& k = kinds[static_cast<std::size_t>(next) % kinds.size()];
                if (k.w * k.d * k.fill > left + 250) {
                    ++next;
                    continue;
                }
                const Vec2d c{random_.range(0, crop.w), random_.range(from, crop.h)};
                if (ring_of(c.x(), c.y()) != r) continue;
                const double s = random_.range(0.88, 1.1);
                const Rect rect{c, direction_near(c), s * k.w / 2, s * k.d / 2};
                if (add(rect, k.shape, 7, 4, 2, true)) {
                    left -= area_m2(to_mm(lots_.back().outlines[0]));
                    ++next;
                }
            }
        }
    }

    Vec2d direction_near(const Vec2d& p) const {
        double best = 1e18;
        Vec2d d{1, 0};
        for (const Street& s : streets_) {
            for (std::size_t i = 0; i + 1 < s.line.size(); ++i) {
                const double q = (0.5 * (s.line[i] + s.line[i + 1]) - p).squaredNorm();
                if (q < best) {
                    best = q;
                    d = (s.line[i + 1] - s.line[i]).normalized();
                }
            }
        }
        return d;
    }

    void houses_along(const Street& street, int side) {
        double length = 0;
        for (std::size_t i = 0; i + 1 < street.line.size(); ++i) {
            length += (street.line[i + 1] - street.line[i]).norm();
        }
        const double garden = random_.range(2.5, 6.5);
        double s = random_.range(2, 8);
        while (s < length - 6) {
            const Vec2d here = along_line(street.line, s);
            const int ring =
                std::min(ring_of(std::max(here.x(), 0.0), std::max(here.y(), 0.0)), rings - 1);
            const int n =
                random_.chance(ring == 0 ? 0.16 : 0.05) ? random_.between(2, ring == 0 ? 5 : 2) : 1;
            const double area = mean_m2(ring) * random_.range(0.62, 1.42);
            const char shape = n > 1 ? 'r' : shape_of(random_.unit());
            const double box_m2 = area / (shape == 'L' ? 0.79 : shape == 'T' ? 0.76 : 1.0);
            const double w =
                n > 1 ? random_.range(6, 8) : std::sqrt(box_m2 * random_.range(0.7, 1.25));
            const double d = n > 1 ? random_.range(9, 12) : box_m2 / w;
            const Vec2d chord = along_line(street.line, s + n * w) - here;
            const double gap = random_.range(3.1, ring == rings - 1 ? 9 : 6);
            if (chord.norm() < 1) break;
            const Vec2d along = chord.normalized() * side;
            const double back = street.half_width + garden + random_.range(-0.8, 0.8) + d / 2;
            const Rect whole{here + 0.5 * chord + back * left_of(along), along, n * w / 2, d / 2};
            const double score = 0.7 * street.charm + 0.3 * random_.unit();
            const bool placed =
                n > 1 ? add_row(whole, n, score) : add(whole, shape, 3.05, 2, score);
            if (placed && random_.chance(0.13)) shed(whole, score - 0.15);
            s += placed ? n * w + gap : 3;
        }
    }

    // What a house measures on average, once large buildings have their share of the ring.
    double mean_m2(int ring) const {
        const Crop& c = crops[static_cast<std::size_t>(ring)];
        return (ring_area(ring) - c.civic_m2) / (ring_count(ring) - c.civic_m2 / 700) *
               size_[static_cast<std::size_t>(ring)];
    }

    static char shape_of(double u) { return u < 0.6 ? 'r' : u < 0.9 ? 'L' : 'T'; }

    bool add_row(const Rect& whole, int n, double score) {
        if (!fits(whole, 3.05, 2)) return false;
        Lot lot;
        lot.score = score;
        lot.ring = ring_of(whole.c.x(), whole.c.y());
        const double w = 2 * whole.along / n;
        const auto corner = [&](int k, double t) { return whole.at(-whole.along + k * w, t); };
        for (int k = 0; k < n; ++k) {
            // Neighbours compute their common corners alike, and so touch exactly.
            lot.outlines.push_back({corner(k, -whole.deep), corner(k + 1, -whole.deep),
                                    corner(k + 1, whole.deep), corner(k, whole.deep)});
            lot.rects.push_back(
                {whole.at(-whole.along + (k + 0.5) * w, 0), whole.d, w / 2, whole.deep});
            if (!clear_of_borders(lot.rects.back().c) ||
                ring_of_outline(lot.outlines.back()) != lot.ring) {
                return false;
            }
        }
        lots_.push_back(std::move(lot));
        return true;
    }

    static bool clear_of_borders(const Vec2d& p) {
        return std::all_of(crops.begin(), crops.end(), [&](const Crop& c) {
            return (c.w >= town_w || std::abs(p.x() - c.w) > 3) &&
                   (c.h >= town_h || std::abs(p.y() - c.h) > 3);
        });
    }

    void shed(const Rect& house, double score) {
        const double w = random_.range(2.2, 3.2);
        const double d = random_.range(2.6, 3.6);
        const double t = house.deep + random_.range(4, 9) + d;
        const Rect r{house.at(random_.range(-0.8, 0.8) * house.along, t), house.d, w, d};
        add(r, 'r', 3.05, 2, score);
    }

    Random random_;
    std::array<double, rings> size_;
    std::array<Line, 4> roads_;
    std::vector<Street> streets_;
    std::vector<Lot> lots_;
    int borders_reached_ = 0;
};

}  // namespace

GenerateReport town(std::uint64_t seed) {
    std::array<double, rings> size;
    size.fill(1.05);
    std::vector<RingMm> buildings;
    for (int attempt = 0; attempt < 60; ++attempt) {
        buildings.clear();
        Town t(seed, attempt, size);
        t.build();
        if (t.choose(size, buildings)) break;
        buildings.clear();
    }
    if (buildings.empty())
        throw std::runtime_error("no town found for seed " + std::to_string(seed));
    std::sort(buildings.begin(), buildings.end(), [](const RingMm& a, const RingMm& b) {
        const PointMm p = box_of(a).min;
        const PointMm q = box_of(b).min;
        return p.y != q.y ? p.y < q.y : p.x < q.x;
    });
    GeoJson json("Synthetic town, seed " + std::to_string(seed));
    for (std::size_t i = 0; i < buildings.size(); ++i) {
        json.polygon("building", "\"id\":" + std::to_string(i), buildings[i]);
    }
    return {json.finish(), describe_town(buildings, seed)};
}

}  // namespace vfplan::generate
