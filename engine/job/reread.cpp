#include "engine/job/reread.h"

#include <fmt/format.h>

#include <cmath>

#include "io/site/planar.h"
#include "io/site/site_reader.h"

namespace vfplan {
namespace {

struct Drawing {
    std::vector<Polygon> solids;
    std::vector<Line> lines;

    void solid(const FeaturesByRole& in, Role role) {
        solids.insert(solids.end(), in.polys(role).begin(), in.polys(role).end());
        line(in, role);
    }
    void line(const FeaturesByRole& in, Role role) {
        lines.insert(lines.end(), in.line(role).begin(), in.line(role).end());
    }
    // Polygons whose rings are walls around free ground.
    void around(const FeaturesByRole& in, Role role) {
        const auto ring = [&](const Ring& points) {
            Line closed = points;
            closed.push_back(closed.front());
            lines.push_back(std::move(closed));
        };
        for (const Polygon& p : in.polys(role)) {
            ring(p.outer);
            for (const Ring& hole : p.holes) ring(hole);
        }
        line(in, role);
    }
};

// What of a drawing is a wall, by the job's choices.
Drawing walls_of(const FeaturesByRole& in, const SiteOptions& options) {
    Drawing out;
    const bool outdoors = options.kind == SiteKind::outdoor;
    out.solid(in, Role::building);
    out.solid(in, Role::wall);
    out.solid(in, Role::obstacle);
    if (outdoors) {
        for (const Role r : {Role::window, Role::door, Role::outline}) {
            out.solids.insert(out.solids.end(), in.polys(r).begin(), in.polys(r).end());
        }
        return out;
    }
    if (options.windows != WindowMode::opening) out.solid(in, Role::window);
    if (options.doors == DoorMode::closed) out.solid(in, Role::door);
    out.around(in, Role::outline);
    return out;
}

}  // namespace

Reread reread(const Config& config, const CoverageTables& t) {
    const SiteOptions options = ground_options(config).site;
    Drawing drawing = walls_of(read_drawing(config.site.input, options), options);
    std::size_t vertices = 0;
    for (const Polygon& p : drawing.solids) vertices += p.outer.size();
    for (const Line& line : drawing.lines) vertices += line.size();
    const planar::Drawn drawn(drawing.solids, drawing.lines, config.site.snap_m);
    Reread out;
    const auto add = [&](bool good, std::string text) {
        out.good = out.good && good;
        out.text.push_back((good ? "yes  " : "NO   ") + text);
    };

    double length_m = 0;
    for (const Wall& w : t.walls) length_m += w.length_m();
    const double want_m = drawn.wall_length_m();
    // Both round to the snap, and may bend or close a slit otherwise: a tenth of what that could
    // make.
    const double slack_m = 0.02 + 0.2 * config.site.snap_m * static_cast<double>(vertices);
    add(std::abs(length_m - want_m) <= slack_m,
        fmt::format("site read again with GEOS: {:.2f} m of walls, {:.2f} m in the tables "
                    "({:.2f} m apart allowed)",
                    want_m, length_m, slack_m));

    constexpr std::size_t sample = 2000;
    const std::size_t step = std::max<std::size_t>(1, t.walls.size() / sample);
    std::size_t looked_at = 0;
    std::size_t into_solids = 0;
    for (std::size_t i = step / 2; i < t.walls.size(); i += step) {
        const Wall& w = t.walls[i];
        const Vec2d e = (w.b - w.a) / w.length_m();
        for (const Side side : {left, right}) {
            if (!w.free_side[side]) continue;
            const Vec2d normal = (side == left ? 1 : -1) * Vec2d(-e.y(), e.x());
            const Vec2d middle = t.origin + (w.a + w.b) / 2;
            ++looked_at;
            const auto solid = [&](double snaps) {
                return drawn.solid(middle + snaps * config.site.snap_m * normal);
            };
            if (solid(0.3) && solid(1.5) && solid(5)) ++into_solids;  // not across a slit
        }
    }
    // Two solids that overlap by less than a snap may leave a slit of one.
    const std::size_t allowed = looked_at / 1000;
    add(into_solids <= allowed,
        fmt::format("{} faces looked at: {} look into something solid ({} allowed)", looked_at,
                    into_solids, allowed));
    return out;
}

}  // namespace vfplan
