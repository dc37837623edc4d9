#include "io/site/site_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "io/formats/read_features.h"
#include "io/site/planar.h"
#include "io/site/site_indoor.h"
#include "io/site/site_outdoor.h"
#include "io/site/stray_features.h"
#include "io/site/subdivision.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Geometries by role; they leave the features.
FeaturesByRole by_role(FeatureSet& set) {
    FeaturesByRole out;
    for (Feature& f : set.features) {
        const auto role = static_cast<std::size_t>(f.role);
        for (Polygon& p : f.polygons) out.polygons[role].push_back(std::move(p));
        for (Line& line : f.lines) out.lines[role].push_back(std::move(line));
    }
    return out;
}

// A place in degrees where those are meant: where the file has some, and the numbers can be degrees
// but lie nowhere near the site as metres.
Vec2d site_point(const Vec2d& given, const FeatureSet& set) {
    if (!set.from_degrees || std::abs(given.x()) > 180 || std::abs(given.y()) > 90) return given;
    constexpr double near_m = 1000;
    const Box box = bounds(set);
    const Vec2d margin(near_m, near_m);
    if (Box{box.min - margin, box.max + margin}.contains(given)) return given;
    return set.from_degrees(given);
}

// Keeps the features whose bounding box has its centre in the crop: none is cut in two.
void crop(FeatureSet& set, const std::vector<double>& crop_m, CleaningCounts& counts) {
    if (crop_m.empty()) return;
    Box keep;
    for (const double x : {crop_m[0], crop_m[2]}) {
        for (const double y : {crop_m[1], crop_m[3]}) keep.add(site_point({x, y}, set));
    }
    counts.outside_crop = static_cast<std::int64_t>(std::erase_if(set.features, [&](Feature& f) {
        const Box box = bounds(f);
        return !keep.contains((box.min + box.max) / 2);
    }));
}

// Why the polygons of a feature are invalid, empty for those that are not; asking takes long, and
// features do not mind each other.
std::vector<std::vector<std::string>> reasons_of(const FeatureSet& set,
                                                 const SiteOptions& options) {
    std::vector<std::vector<std::string>> reasons(set.features.size());
    options.for_each(static_cast<std::int64_t>(reasons.size()),
                     [&](std::int64_t from, std::int64_t to) {
                         for (std::size_t i = idx(from); i < idx(to); ++i) {
                             for (const Polygon& p : set.features[i].polygons) {
                                 reasons[i].push_back(planar::invalid_reason(p));
                             }
                         }
                     });
    return reasons;
}

void settle_invalid(FeatureSet& set, const SiteOptions& options, const std::string& name,
                    CleaningCounts& counts) {
    // Where they are to be repaired nobody has to ask: see kernels/faces.h. A room is no wall: what
    // its ring surrounds is its floor, however it runs.
    const bool ask = options.invalid != InvalidPolygons::repair;
    const auto reasons = ask ? reasons_of(set, options) : std::vector<std::vector<std::string>>();
    for (std::size_t i = 0; i < set.features.size(); ++i) {
        Feature& f = set.features[i];
        if (f.role == Role::ignored || f.role == Role::opening) continue;
        std::vector<Polygon> good;
        for (std::size_t k = 0; k < f.polygons.size(); ++k) {
            Polygon& p = f.polygons[k];
            // A point or a line drawn as a polygon has no area to lose.
            const bool empty = p.outer.size() < 3;
            const bool wrong = ask && f.role != Role::room && !reasons[i][k].empty();
            if (empty || wrong) {
                if (!empty && options.invalid == InvalidPolygons::error) {
                    throw InputError(fmt::format(
                        "{}: feature {}{}{}: {}; correct the polygon, or set site.invalid = "
                        "\"repair\" or \"drop\"",
                        name, f.number, f.id.empty() ? "" : ", id ", f.id, reasons[i][k]));
                }
                ++counts.dropped_invalid;
                continue;
            }
            good.push_back(std::move(p));
        }
        f.polygons = std::move(good);
    }
}

// One line for people about polygons that cross themselves; places are in the site's frame.
std::string repair_warning(const std::vector<Vec2d>& places, const Site& site) {
    constexpr std::size_t most = 5;
    std::string text = fmt::format(
        "{} polygons cross themselves; inside is what a ring surrounds an odd number of times; see",
        places.size());
    for (std::size_t i = 0; i < std::min(most, places.size()); ++i) {
        const Vec2d at = places[i] + site.origin;
        text += fmt::format("{} ({:.3f}, {:.3f})", i > 0 ? "," : "", at.x(), at.y());
    }
    return text + (places.size() > most ? ", ..." : "");
}

std::string problem_without_walls(bool no_features, const SiteOptions& options) {
    if (no_features && !options.crop_m.empty()) {
        return "no feature has its centre in site.crop_m; check the crop, it is in the site's "
               "metres, or in degrees if the file has them";
    }
    if (no_features) {
        return options.kind == SiteKind::outdoor
                   ? "no building polygons in it; check the file and site.layer"
                   : "no walls, rooms or outlines in it; check the file and site.layer";
    }
    return options.kind == SiteKind::outdoor
               ? "no walls are left after cleaning; if this is a floor plan set site.kind = "
                 "\"indoor\""
               : "no walls are left after cleaning (rooms alone are none: give walls or an "
                 "outline); if "
                 "this is a town set site.kind = \"outdoor\"";
}

// What to do about walls that enclose nothing.
std::string wider_text(const FeaturesByRole& in, const SiteOptions& options) {
    const double up_to_m = 5 * options.max_opening_m;
    std::string text = fmt::format("give rooms or an outline, or raise site.max_opening_m, now {}",
                                   options.max_opening_m);
    std::string more;
    for (const OpeningStep& s : indoor_opening_steps(in, options, up_to_m)) {
        if (s.opening_m <= options.max_opening_m || s.inside_m2 < options.min_room_m2) continue;
        more += fmt::format("{}{:.2f} m: {:.0f} m2", more.empty() ? "" : ", ", s.opening_m + 0.01,
                            s.inside_m2);
    }
    return more.empty() ? text : text + " (inside would be with " + more + ")";
}

}  // namespace

std::vector<Border> border_of_union(const std::vector<Polygon>& polygons, double snap_m) {
    Linework linework(snap_m);
    for (const Polygon& p : polygons) linework.add(p, {solid_area, {}});
    if (linework.segments().empty()) return {};
    const Subdivision s = subdivide(linework);
    std::vector<Border> out;
    for (std::size_t e = 0; e < s.noded.edges.size(); ++e) {
        const auto inside = [&](Side side) { return s.kinds[idx(s.triangle_at[e][side])] != 0; };
        if (inside(left) == inside(right)) continue;
        out.push_back({as_vec(s.noded.edges[e].a) * snap_m, as_vec(s.noded.edges[e].b) * snap_m});
    }
    return out;
}

FeaturesByRole read_drawing(const std::filesystem::path& file, const SiteOptions& options) {
    FeatureSet set = read_features(file, options);
    CleaningCounts ignored;
    crop(set, options.crop_m, ignored);
    return by_role(set);
}

SiteResult read_site(const std::filesystem::path& file, const SiteOptions& options) {
    return build_site(read_features(file, options), options, file.string());
}

SiteResult build_site(FeatureSet set, const SiteOptions& options, const std::string& name) {
    SiteResult out;
    Site& site = out.site;
    out.warnings = set.warnings;
    out.how = set.how;
    site.crs_wkt = set.crs_wkt;
    site.counts.features = static_cast<std::int64_t>(set.features.size()) + set.ignored;
    site.counts.ignored = set.ignored;
    crop(set, options.crop_m, site.counts);
    const Box box = bounds(set);
    out.points.reserve(options.points.size());
    for (const Vec2d& p : options.points) out.points.push_back(site_point(p, set));
    const bool no_features = set.features.empty();
    if (no_features) {
        throw InputError(fmt::format("{}: {}", name, problem_without_walls(no_features, options)));
    }
    if (std::string stray = stray_warning(set, options); !stray.empty()) {
        out.warnings.push_back(std::move(stray));
    }
    settle_invalid(set, options, name, site.counts);
    site.origin = {std::floor(box.min.x()), std::floor(box.min.y())};
    for (Feature& f : set.features) {
        each_point(f, [&](Vec2d& v) { v -= site.origin; });
        if (f.role == Role::ignored || f.role == Role::opening) ++site.counts.ignored;
    }
    const FeaturesByRole sorted = by_role(set);
    set.features = {};  // a county's are hundreds of megabytes
    if (options.kind == SiteKind::outdoor) {
        build_outdoor(sorted, options, site);
    } else {
        build_indoor(sorted, options, site);
        if (options.opening_steps_up_to_m > 0) {
            out.opening_steps =
                indoor_opening_steps(sorted, options, options.opening_steps_up_to_m);
        }
    }
    site.counts.walls = static_cast<std::int64_t>(site.walls.size());
    site.counts.repaired = static_cast<std::int64_t>(site.repaired_at.size());
    if (!site.repaired_at.empty()) out.warnings.push_back(repair_warning(site.repaired_at, site));
    if (site.walls.empty()) {
        throw InputError(fmt::format("{}: {}", name, problem_without_walls(no_features, options)));
    }
    if (site.free_border.empty()) {
        throw InputError(
            fmt::format("{}: nowhere in it can a station stand: no space of site.min_room_m2 = {} "
                        "is inside; {}, "
                        "or check site.unit_m",
                        name, options.min_room_m2,
                        options.kind == SiteKind::outdoor ? "check the buildings"
                                                          : wider_text(sorted, options)));
    }
    return out;
}

}  // namespace vfplan
