// A flat (or a floor of many rooms): rows of rooms on both sides of a hall, doors, windows.
//
// The plan is an owner for every cell of an irregular grid; walls stand where the owner changes.
// So a wall between two rooms exists once, and rooms of any shape come for free.
#include "engine/generate/flat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "engine/generate/drawing.h"

namespace vfplan::generate {
namespace {

constexpr int outside = -1;
constexpr int hall = 0;
constexpr std::int64_t door_mm = 900;

struct RoomRect {
    int room;
    std::int64_t x0, y0, x1, y1;
};

// Part of a grid line where one room (low: left or below) meets another (high).
struct Stretch {
    bool vertical;
    std::int64_t at;        // x of a vertical line, y of a horizontal one
    std::int64_t from, to;  // along the line
    int low, high;
};

struct Opening {
    bool vertical;
    std::int64_t at, from, to;
    bool door;
};

PointMm point(bool vertical, std::int64_t at, std::int64_t along) {
    return vertical ? PointMm{at, along} : PointMm{along, at};
}

class Plan {
public:
    explicit Plan(const std::vector<RoomRect>& rects) {
        std::set<std::int64_t> xs;
        std::set<std::int64_t> ys;
        for (const RoomRect& r : rects) {
            xs.insert({r.x0, r.x1});
            ys.insert({r.y0, r.y1});
        }
        x_.assign(xs.begin(), xs.end());
        y_.assign(ys.begin(), ys.end());
        owner_.assign((x_.size() - 1) * (y_.size() - 1), outside);
        for (const RoomRect& r : rects) {
            for (std::size_t j = 0; j + 1 < y_.size(); ++j) {
                for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
                    if (x_[i] >= r.x0 && x_[i] < r.x1 && y_[j] >= r.y0 && y_[j] < r.y1) {
                        owner_[j * (x_.size() - 1) + i] = r.room;
                    }
                }
            }
        }
        stretches(true, x_, y_);
        stretches(false, y_, x_);
    }

    const std::vector<Stretch>& walls() const { return walls_; }

    // Outline of a room without holes, counter-clockwise.
    RingMm outline(int room) const {
        std::map<std::pair<std::int64_t, std::int64_t>, PointMm> next;
        PointMm start;
        for (const Stretch& s : walls_) {
            if (s.low != room && s.high != room) continue;
            // The room lies left of its outline.
            const bool up = (s.low == room) == s.vertical;
            const PointMm a = point(s.vertical, s.at, up ? s.from : s.to);
            const PointMm b = point(s.vertical, s.at, up ? s.to : s.from);
            next[{a.x, a.y}] = b;
            start = a;
        }
        RingMm ring;
        PointMm p = start;
        do {
            const PointMm q = next.at({p.x, p.y});
            const PointMm after = next.at({q.x, q.y});
            const bool straight = (p.x == q.x && q.x == after.x) || (p.y == q.y && q.y == after.y);
            if (!straight) ring.push_back(q);
            p = q;
        } while (!(p == start));
        return ring;
    }

private:
    int owner(bool vertical, std::int64_t line, std::size_t cell) const {
        const auto nx = static_cast<std::int64_t>(x_.size()) - 1;
        const auto ny = static_cast<std::int64_t>(y_.size()) - 1;
        const std::int64_t i = vertical ? line : static_cast<std::int64_t>(cell);
        const std::int64_t j = vertical ? static_cast<std::int64_t>(cell) : line;
        if (i < 0 || j < 0 || i >= nx || j >= ny) return outside;
        return owner_[static_cast<std::size_t>(j * nx + i)];
    }

    void stretches(bool vertical, const std::vector<std::int64_t>& across,
                   const std::vector<std::int64_t>& along) {
        for (std::size_t l = 0; l < across.size(); ++l) {
            for (std::size_t c = 0; c + 1 < along.size(); ++c) {
                const auto line = static_cast<std::int64_t>(l);
                const int low = owner(vertical, line - 1, c);
                const int high = owner(vertical, line, c);
                if (low == high) continue;
                if (!walls_.empty()) {
                    Stretch& last = walls_.back();
                    if (last.vertical == vertical && last.at == across[l] && last.to == along[c] &&
                        last.low == low && last.high == high) {
                        last.to = along[c + 1];
                        continue;
                    }
                }
                walls_.push_back({vertical, across[l], along[c], along[c + 1], low, high});
            }
        }
    }

    std::vector<std::int64_t> x_;
    std::vector<std::int64_t> y_;
    std::vector<int> owner_;
    std::vector<Stretch> walls_;
};

struct RoomKind {
    const char* label;
    double width;  // share of its row
};

// Names and relative widths; the hall is not among them.
std::vector<std::pair<std::string, double>> rooms_of(Random& r, int count) {
    std::vector<std::pair<std::string, double>> out;
    if (count <= 14) {
        constexpr std::array<RoomKind, 14> kinds{{{"living room", 5.4},
                                                  {"bathroom", 2.3},
                                                  {"bedroom", 4.0},
                                                  {"kitchen", 3.2},
                                                  {"child's room", 3.6},
                                                  {"study", 3.2},
                                                  {"toilet", 1.6},
                                                  {"dining room", 4.2},
                                                  {"storage", 1.9},
                                                  {"guest room", 3.6},
                                                  {"bedroom 2", 3.8},
                                                  {"bathroom 2", 2.4},
                                                  {"library", 4.0},
                                                  {"workshop", 4.4}}};
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            out.emplace_back(kinds[i].label, kinds[i].width * r.range(0.92, 1.08));
        }
        // The order along the hall differs from flat to flat.
        for (int i = count - 1; i > 0; --i) {
            std::swap(out[static_cast<std::size_t>(i)],
                      out[static_cast<std::size_t>(r.below(i + 1))]);
        }
        return out;
    }
    for (int i = 1; i <= count; ++i) {
        const double u = r.unit();
        const RoomKind k = u < 0.72   ? RoomKind{"office", r.range(2.8, 4.6)}
                           : u < 0.86 ? RoomKind{"meeting room", r.range(5, 7.5)}
                           : u < 0.94 ? RoomKind{"storage", r.range(2.0, 2.6)}
                                      : RoomKind{"toilet", r.range(2.2, 3.0)};
        out.emplace_back(std::string(k.label) + " " + std::to_string(i), k.width);
    }
    return out;
}

std::int64_t cm(double m) { return static_cast<std::int64_t>(std::floor(m * 100 + 0.5)) * 10; }

// Two rows of rooms per corridor; corridors meet in a spine at the western end.
std::vector<RoomRect> arrange(Random& r, const std::vector<std::pair<std::string, double>>& rooms) {
    const auto n = static_cast<int>(rooms.size());
    double total = 0;
    for (const auto& room : rooms) total += room.second;
    int corridors = 1;
    // As many as bring the floor nearest to three wide by two deep.
    const auto badness = [&](int k) { return std::abs(total / (2.0 * k) - 1.5 * 10.4 * k); };
    while (n > 14 && badness(corridors + 1) < badness(corridors)) ++corridors;
    const int row_count = n == 1 ? 1 : 2 * corridors;

    std::vector<std::vector<int>> rows(static_cast<std::size_t>(row_count));
    std::vector<double> filled(rows.size(), 0);
    for (int i = 0; i < n; ++i) {
        const auto least = std::min_element(filled.begin(), filled.end()) - filled.begin();
        rows[static_cast<std::size_t>(least)].push_back(i);
        filled[static_cast<std::size_t>(least)] += rooms[static_cast<std::size_t>(i)].second;
    }
    const double longest = *std::max_element(filled.begin(), filled.end());
    const std::int64_t corridor = cm(n <= 14 ? r.range(1.3, 1.7) : r.range(1.8, 2.4));
    const std::int64_t spine = corridors > 1 ? corridor : 0;
    std::vector<RoomRect> rects;
    std::int64_t y = 0;
    std::int64_t spine_from = 0;
    std::int64_t spine_to = 0;
    for (int row = 0; row < row_count; ++row) {
        const auto k = static_cast<std::size_t>(row);
        const std::int64_t deep = cm(n <= 14 ? r.range(3.5, 4.6) : r.range(3.8, 5.4));
        // Rows that are nearly full are stretched; the others leave a corner of the outline out.
        const double stretch = filled[k] > 0.84 * longest ? longest / filled[k] : 1;
        double x = 0;
        for (const int i : rows[k]) {
            const double next = x + rooms[static_cast<std::size_t>(i)].second * stretch;
            rects.push_back({i + 1, spine + cm(x), y, spine + cm(next), y + deep});
            x = next;
        }
        y += deep;
        if (row % 2 == 0) {
            rects.push_back({hall, 0, y, spine + cm(longest), y + corridor});
            if (row == 0) spine_from = y;
            y += corridor;
            spine_to = y;
        }
    }
    if (spine > 0) rects.push_back({hall, 0, spine_from, spine, spine_to});
    return rects;
}

class Flat {
public:
    Flat(std::uint64_t seed, int rooms)
        : seed_(seed),
          random_(seed, 5, static_cast<std::uint64_t>(rooms)),
          count_(rooms),
          names_(rooms_of(random_, rooms - 1)),
          plan_(arrange(random_, names_)) {}

    GenerateReport run() {
        doors();
        windows();
        GeoJson json("Synthetic flat, seed " + std::to_string(seed_) + ", " +
                     std::to_string(count_) + " rooms");
        double area = 0;
        Box box;
        for (int room = 0; room < count_; ++room) {
            const RingMm ring = plan_.outline(room);
            const std::string name =
                room == hall ? "hall" : names_[static_cast<std::size_t>(room) - 1].first;
            json.polygon("room", R"("label":")" + name + '"', ring);
            area += area_m2(ring);
            for (const PointMm& p : ring)
                box.add({static_cast<double>(p.x) / 1000, static_cast<double>(p.y) / 1000});
        }
        const int wall_count = walls(json);
        int doors = 0;
        for (const Opening& o : openings_) {
            json.line(o.door ? "door" : "window",
                      {point(o.vertical, o.at, o.from), point(o.vertical, o.at, o.to)});
            if (o.door) ++doors;
        }
        std::string text = "synthetic flat, seed " + std::to_string(seed_) + "\n";
        text += "  rooms " + std::to_string(count_) + ", floor area " + fixed(area, 1) +
                " m2, mean room " + fixed(area / count_, 1) + " m2\n";
        text += "  extent " + fixed(box.size().x(), 1) + " x " + fixed(box.size().y(), 1) + " m\n";
        text += "  wall lines " + std::to_string(wall_count) + ", doors " + std::to_string(doors) +
                " (one leads outside), windows " +
                std::to_string(openings_.size() - static_cast<std::size_t>(doors)) + "\n";
        return {json.finish(), text};
    }

private:
    static constexpr std::int64_t jamb = 120;  // wall that stays between an opening and a corner

    // Where openings would meet corners or each other, nothing is opened.
    bool open(const Stretch& s, std::int64_t from, std::int64_t width, bool door) {
        if (from < s.from + jamb || from + width > s.to - jamb) return false;
        for (const Opening& o : openings_) {
            if (o.vertical == s.vertical && o.at == s.at && o.from < from + width + jamb &&
                from < o.to + jamb)
                return false;
        }
        openings_.push_back({s.vertical, s.at, from, from + width, door});
        return true;
    }

    bool door_in(const Stretch& s) {
        const std::int64_t room = s.to - s.from - door_mm - 2 * jamb;
        if (room < 0) return false;
        const std::int64_t at =
            random_.chance(0.5) ? 0 : cm(static_cast<double>(room) / 1000 * random_.unit());
        return open(s, s.from + jamb + std::min(at, room), door_mm, true);
    }

    void doors() {
        for (const Stretch& s : plan_.walls()) {
            // Every room lies on the hall; those beside the spine do so twice.
            if (s.low == hall || s.high == hall) {
                if (s.low != outside && s.high != outside) door_in(s);
            } else if (s.low != outside && s.high != outside && s.vertical &&
                       random_.chance(0.12)) {
                door_in(s);
            }
        }
        // The front door: the western end of the first corridor.
        for (const Stretch& s : plan_.walls()) {
            if (s.vertical && s.low == outside && s.high == hall && door_in(s)) break;
        }
    }

    void windows() {
        for (const Stretch& s : plan_.walls()) {
            if (s.low != outside && s.high != outside) continue;
            const std::int64_t length = s.to - s.from;
            if (length < 1400) continue;
            const std::int64_t panes = std::max<std::int64_t>(1, length / 3600);
            for (std::int64_t k = 0; k < panes; ++k) {
                const std::int64_t bay = length / panes / 20 * 20;
                const std::int64_t width = std::min(cm(random_.range(0.9, 1.9)), bay * 6 / 10);
                // Whole centimetres, like everything else in the plan.
                open(s, s.from + k * bay + (bay - width) / 20 * 10, width / 10 * 10, false);
            }
        }
    }

    // Straight runs, cut at the openings only.
    int walls(GeoJson& json) const {
        int count = 0;
        std::vector<Stretch> runs;
        for (const Stretch& s : plan_.walls()) {
            if (!runs.empty() && runs.back().vertical == s.vertical && runs.back().at == s.at &&
                runs.back().to == s.from) {
                runs.back().to = s.to;
            } else {
                runs.push_back(s);
            }
        }
        for (const Stretch& s : runs) {
            std::vector<Opening> cuts;
            for (const Opening& o : openings_) {
                if (o.vertical == s.vertical && o.at == s.at && o.from >= s.from && o.to <= s.to)
                    cuts.push_back(o);
            }
            std::sort(cuts.begin(), cuts.end(),
                      [](const Opening& a, const Opening& b) { return a.from < b.from; });
            std::int64_t from = s.from;
            for (const Opening& o : cuts) {
                json.line("wall", {point(s.vertical, s.at, from), point(s.vertical, s.at, o.from)});
                from = o.to;
                ++count;
            }
            json.line("wall", {point(s.vertical, s.at, from), point(s.vertical, s.at, s.to)});
            ++count;
        }
        return count;
    }

    std::uint64_t seed_;
    Random random_;
    int count_;
    std::vector<std::pair<std::string, double>> names_;
    Plan plan_;
    std::vector<Opening> openings_;
};

}  // namespace

GenerateReport flat(std::uint64_t seed, int rooms) { return Flat(seed, rooms).run(); }

}  // namespace vfplan::generate
