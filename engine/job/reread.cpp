#include "engine/job/reread.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/site/planar.h"
#include "io/site/site_reader.h"

namespace vfplan {
namespace {

// What is drawn, by the job's choices about doors and windows.
planar::Parts parts_of(const FeaturesByRole& in, const SiteOptions& options) {
    planar::Parts out;
    const auto add = [&](std::vector<Polygon>& to, Role role) {
        to.insert(to.end(), in.polys(role).begin(), in.polys(role).end());
    };
    const auto lines = [&](Role role) {
        out.lines.insert(out.lines.end(), in.line(role).begin(), in.line(role).end());
    };
    for (const Role r : {Role::building, Role::wall}) {
        add(out.solids, r);
        lines(r);
    }
    add(out.obstacles, Role::obstacle);
    lines(Role::obstacle);
    if (options.kind == SiteKind::outdoor) {
        for (const Role r : {Role::window, Role::door, Role::outline}) add(out.solids, r);
        return out;
    }
    if (options.windows == WindowMode::opening) {
        add(out.openings, Role::window);
    } else {
        add(out.solids, Role::window);
        lines(Role::window);
    }
    if (options.doors == DoorMode::open) {
        add(out.openings, Role::door);
    } else {
        add(out.solids, Role::door);
        lines(Role::door);
    }
    add(out.outlines, Role::outline);
    lines(Role::outline);
    return out;
}

class Comparison {
public:
    Comparison(const Config& config, const CoverageTables& t, const FieldFile* field)
        : t_(t), field_(field), options_(ground_options(config).site) {
        const GroundOptions ground = ground_options(config);
        all_is_ground_ = options_.kind == SiteKind::outdoor && ground.forbidden.empty() &&
                         ground.clearance_m == 0;
        parts_ = parts_of(read_drawing(config.site.input, options_), options_);
        std::size_t vertices = 0;
        for (const auto* polygons :
             {&parts_.solids, &parts_.openings, &parts_.obstacles, &parts_.outlines}) {
            for (const Polygon& p : *polygons) vertices += p.outer.size();
        }
        for (const Line& line : parts_.lines) vertices += line.size();
        // Both round to the snap, and may bend or close a slit otherwise: a tenth of what that
        // could make.
        slack_m_ = 0.02 + 0.2 * options_.snap_m * static_cast<double>(vertices);
        drawn_ = std::make_unique<planar::Drawn>(parts_, options_.snap_m);
    }

    Reread compare() {
        lengths();
        area();
        if (field_ != nullptr) cells();
        faces();
        return std::move(out_);
    }

private:
    void add(bool good, const std::string& text) {
        out_.good = out_.good && good;
        out_.text.push_back((good ? "yes  " : "NO   ") + text);
    }

    // Lines that run nearer to each other than a few snaps are one or two, as rounding has it:
    // where many meet in a point there is much of that. What a coarser snap changes tells how much.
    double rounding_m() const {
        const planar::Drawn coarser(parts_, 2 * options_.snap_m);
        return 2 * (std::abs(coarser.border_m() - drawn_->border_m()) +
                    std::abs(coarser.lines_m() - drawn_->lines_m()));
    }

    void lengths() {
        double all_m = 0;
        std::array<double, 3> by_sides{};
        for (const Wall& w : t_.walls) {
            all_m += w.length_m();
            by_sides[static_cast<std::size_t>(w.free_side[left] + w.free_side[right])] +=
                w.length_m();
        }
        const double border_m = drawn_->border_m();
        const double lines_m = drawn_->lines_m();
        const auto near = [&](double a, double b) { return std::abs(a - b) <= slack_m_; };
        if (!near(all_m, border_m + lines_m)) slack_m_ += rounding_m();
        add(near(all_m, border_m + lines_m),
            fmt::format("site read again with GEOS: {:.2f} m of walls, {:.2f} m in the tables "
                        "({:.2f} m apart allowed)",
                        border_m + lines_m, all_m, slack_m_));
        if (options_.kind != SiteKind::outdoor) return;
        add(near(by_sides[1], border_m) && near(by_sides[2], lines_m) && near(by_sides[0], 0),
            fmt::format(
                "of these {:.2f} m with one free side, {:.2f} m with two; {:.2f} and {:.2f} "
                "m in the tables, {:.2f} m with none",
                border_m, lines_m, by_sides[1], by_sides[2], by_sides[0]));
    }

    void area() {
        const auto site = nlohmann::json::parse(t_.summary).value("site", nlohmann::json());
        const bool outdoors = options_.kind == SiteKind::outdoor;
        if (!site.contains("area_m2") || (!outdoors && !drawn_->has_outlines())) return;
        double said_m2 = site["area_m2"].get<double>();
        if (!outdoors) said_m2 += site.value("ground_dropped_m2", 0.0);
        const double drawn_m2 = outdoors ? drawn_->solid_m2() : drawn_->outlined_m2();
        const double slack_m2 = 0.01 + options_.snap_m * (drawn_->border_m() + drawn_->lines_m());
        add(std::abs(said_m2 - drawn_m2) <= slack_m2,
            fmt::format("{:.2f} m2 are {}, {:.2f} m2 in the tables ({:.2f} m2 apart allowed)",
                        drawn_m2, outdoors ? "built over" : "within outlines and not solid",
                        said_m2, slack_m2));
    }

    // Whether something holds at a place; nothing where that depends on a few snaps.
    template <class Holds>
    std::optional<bool> firmly(const Vec2d& p, Holds&& holds) const {
        const double d = 5 * options_.snap_m;
        const bool here = holds(p);
        for (const Vec2d& by : {Vec2d(d, d), Vec2d(-d, d), Vec2d(d, -d), Vec2d(-d, -d)}) {
            if (holds(p + by) != here) return {};
        }
        return here;
    }

    void cells() {
        constexpr std::int64_t sample = 4000;
        const std::int64_t step = std::max<std::int64_t>(1, field_->grid().size() / sample);
        std::int64_t number = 0;
        std::int64_t looked_at = 0;
        std::int64_t wrong = 0;
        std::string first;
        Box extent;  // beyond its frame of a metre there is no ground
        for (const Wall& w : t_.walls) {
            extent.add(t_.origin + w.a);
            extent.add(t_.origin + w.b);
        }
        field_->each_band([&](const Window& w, const Raster<float>& vf) {
            for (std::size_t i = 0; i < vf.size(); ++i) {
                if (number++ % step != step / 2) continue;
                const std::int64_t cell =
                    field_->grid().id(0, w.y_begin) + static_cast<std::int64_t>(i);
                const Vec2d at = t_.origin + field_->grid().centre(cell);
                const bool free = !std::isnan(vf[i]);
                const std::optional<bool> in =
                    firmly(at, [&](const Vec2d& p) { return drawn_->solid(p); });
                const std::optional<bool> outlined =
                    !free || !drawn_->has_outlines()
                        ? true
                        : firmly(at, [&](const Vec2d& p) { return drawn_->outlined(p); });
                if (!in || !outlined) continue;
                ++looked_at;
                bool good = !free || !*in;
                if (all_is_ground_ && extent.contains(at)) good = free != *in;
                good = good && *outlined;
                if (good) continue;
                ++wrong;
                if (first.empty()) {
                    first = fmt::format(", the first at ({:.2f}, {:.2f})", at.x(), at.y());
                }
            }
        });
        add(wrong == 0, fmt::format("{} cells looked at: {} are {}{}", looked_at, wrong,
                                    all_is_ground_ ? "free in something solid, or taken beside it"
                                                   : "free in something solid or outside",
                                    first));
    }

    void faces() {
        constexpr std::size_t sample = 2000;
        const std::size_t step = std::max<std::size_t>(1, t_.walls.size() / sample);
        std::size_t looked_at = 0;
        std::size_t into_solids = 0;
        for (std::size_t i = step / 2; i < t_.walls.size(); i += step) {
            const Wall& w = t_.walls[i];
            const Vec2d e = (w.b - w.a) / w.length_m();
            for (const Side side : {left, right}) {
                if (!w.free_side[side]) continue;
                const Vec2d normal = (side == left ? 1 : -1) * Vec2d(-e.y(), e.x());
                const Vec2d middle = t_.origin + (w.a + w.b) / 2;
                ++looked_at;
                const auto is_solid = [&](double snaps) {
                    return drawn_->solid(middle + snaps * options_.snap_m * normal);
                };
                if (is_solid(0.3) && is_solid(1.5) && is_solid(5)) {
                    ++into_solids;  // not across a slit
                }
            }
        }
        // Two solids that overlap by less than a snap may leave a slit of one.
        const std::size_t allowed = looked_at / 1000;
        add(into_solids <= allowed,
            fmt::format("{} faces looked at: {} look into something solid ({} allowed)", looked_at,
                        into_solids, allowed));
    }

    const CoverageTables& t_;
    const FieldFile* field_;
    SiteOptions options_;
    planar::Parts parts_;
    std::unique_ptr<planar::Drawn> drawn_;
    double slack_m_ = 0;
    bool all_is_ground_ = false;  // that is not solid
    Reread out_;
};

}  // namespace

Reread reread(const Config& config, const CoverageTables& t, const FieldFile* field) {
    return Comparison(config, t, field).compare();
}

}  // namespace vfplan
