#include "engine/tables/site.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/tables/narrow.h"
#include "engine/tables/shards.h"
#include "engine/tables/standable.h"
#include "io/tables/site_store.h"
#include "kernels/coverage.h"
#include "kernels/error.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"
#include "kernels/standing.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

// `given`: the points as the user wrote them, `points`: in the site's frame.
void check_points(const std::vector<Vec2d>& given, const std::vector<Vec2d>& points,
                  const Site& site, const std::vector<Border>& forbidden, const char* key) {
    const Standing standing(site, forbidden);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::string_view why = standing.objection(points[i]);
        if (why.empty()) continue;
        std::string what = "give a point in the coordinates of the site";
        if (const auto better = standing.nearest(points[i])) {
            const Vec2d at = *better + site.origin;
            what = fmt::format("the nearest place is ({:.3f}, {:.3f})", at.x(), at.y());
        }
        throw UsageError(fmt::format("{}: no station can stand at ({}, {}): {}; {}", key,
                                     given[i].x(), given[i].y(), why, what));
    }
}

// What is left out of the inside, the largest pieces one by one.
Json dropped_summary(const Site& site) {
    constexpr std::size_t most = 20;
    Json list = Json::array();
    for (std::size_t i = 0; i < std::min(most, site.dropped.size()); ++i) {
        const Dropped& d = site.dropped[i];
        list.push_back({{"x", d.at.x() + site.origin.x()},
                        {"y", d.at.y() + site.origin.y()},
                        {"why", name_of(d.why)},
                        {"area_m2", d.area_m2},
                        {"faces_m", d.faces_m}});
    }
    return list;
}

// Ground too narrow for the clearance, the largest places one by one.
Json narrow_summary(const std::vector<NarrowPlace>& places, const Site& site) {
    constexpr std::size_t most = 20;
    Json list = Json::array();
    for (std::size_t i = 0; i < std::min(most, places.size()); ++i) {
        const Vec2d at = places[i].at + site.origin;
        list.push_back({{"x", at.x()}, {"y", at.y()}, {"area_m2", places[i].area_m2}});
    }
    return list;
}

Json site_summary(const Site& site, const std::vector<NarrowPlace>& narrow) {
    double ground_m2 = 0;
    double faces_m = 0;
    for (const Dropped& d : site.dropped) {
        ground_m2 += d.area_m2;
        faces_m += d.faces_m;
    }
    return {{"buildings", site.buildings},
            {"walls", site.walls.size()},
            {"area_m2", site.area_m2},
            {"width_m", site.extent.size().x()},
            {"height_m", site.extent.size().y()},
            {"ground_dropped_m2", ground_m2},
            {"faces_dropped_m", faces_m},
            {"dropped", dropped_summary(site)},
            {"narrow_m2", area_m2(narrow)},
            {"narrow", narrow_summary(narrow, site)},
            {"cleaning",
             {{"features", site.counts.features},
              {"ignored", site.counts.ignored},
              {"outside_crop", site.counts.outside_crop},
              {"repaired", site.counts.repaired},
              {"dropped_invalid", site.counts.dropped_invalid},
              {"edges_in", site.counts.edges_in},
              {"zero_length", site.counts.zero_length},
              {"duplicates", site.counts.duplicates},
              {"split", site.counts.split},
              {"merged", site.counts.merged},
              {"inside_solids", site.counts.inside_solids},
              {"opened", site.counts.opened},
              {"slivers", site.counts.slivers}}}};
}

// Pieces are numbered with 32 bits.
void check_piece_count(const Site& site, double partition_m) {
    double pieces = 0;
    for (const Wall& w : site.walls) {
        if (!w.scanned) continue;
        pieces += (w.free_side[left] + w.free_side[right]) * std::ceil(w.length_m() / partition_m);
    }
    constexpr double most = 2e9;
    if (pieces <= most) return;
    throw UsageError(
        fmt::format("coverage.partition_m = {}: {:.3g} pieces of wall, of which {:.0g} can be "
                    "numbered; choose longer ones or site.crop_m",
                    partition_m, pieces, most));
}

// One line for people.
std::string site_text(const Site& site) {
    const CleaningCounts& c = site.counts;
    return fmt::format(
        "site         {} features, {} walls on {:.0f} x {:.0f} m (edges: {} read, {} too short, {} "
        "repeated, {} split, {} joined, {} inside solids)",
        c.features, site.walls.size(), site.extent.size().x(), site.extent.size().y(), c.edges_in,
        c.zero_length, c.duplicates, c.split, c.merged, c.inside_solids);
}

}  // namespace

Layout layout_of(const GroundOptions& o, const Site& site) {
    const Vec2d size = site.extent.size();
    const double cell = o.cell_m;
    if (cell > size.x() || cell > size.y()) {
        throw UsageError(
            fmt::format("field.cell_m = {}: a cell is larger than the site, which is "
                        "{:.1f} x {:.1f} m; choose a smaller one",
                        cell, size.x(), size.y()));
    }
    const double cells = std::ceil(size.x() / cell) * std::ceil(size.y() / cell);
    constexpr double most = 1e11;
    constexpr double most_in_row = 2e9;
    if (cells > most || size.maxCoeff() / cell > most_in_row) {
        throw UsageError(fmt::format(
            "field.cell_m = {}: {:.3g} cells on {:.0f} x {:.0f} m, of which {:.0g} (and "
            "{:.0g} in a row) can be numbered; choose larger cells or site.crop_m",
            cell, cells, size.x(), size.y(), most, most_in_row));
    }
    return make_layout(make_grid(site.extent, cell, o.site.snap_m), o.range_max_m, o.tile_cells);
}

Site read_ground(const GroundOptions& o, const Threads& threads, Progress& progress) {
    SiteOptions options = o.site;
    options.for_each = [&](std::int64_t n, const SiteOptions::Body& body) {
        threads.for_each(n, 16, body);
    };
    options.points = o.required;
    options.points.insert(options.points.end(), o.existing.begin(), o.existing.end());
    SiteResult read = read_site(o.input, options);
    Site& site = read.site;
    for (std::size_t i = 0; i < read.points.size(); ++i) {
        (i < o.required.size() ? site.required : site.existing)
            .push_back(read.points[i] - site.origin);
    }
    for (const std::string& w : read.warnings) progress.warn(w);
    progress.note(site_text(site));
    check_piece_count(site, o.partition_m);
    if (!o.required.empty()) {
        check_points(o.required, site.required, site, forbidden_border(o, site), "plan.required");
    }
    check_points(o.existing, site.existing, site, {}, "plan.existing");
    return std::move(site);
}

void check_free_cells(const GroundOptions& o, std::int64_t free_cells) {
    if (free_cells > 0) return;
    throw UsageError(fmt::format(
        "field.cell_m = {}: no cell's centre lies in free space; choose a smaller cell", o.cell_m));
}

void store_site(const GroundOptions& o, const std::string& key, const Site& site,
                const std::vector<NarrowPlace>& narrow, const Threads& threads,
                const std::filesystem::path& path, bool may_be_none,
                const std::function<void()>& may_store) {
    const Layout layout = layout_of(o, site);
    const auto bits = standable_bits(o, site, layout, threads);
    SiteFacts facts;
    for (const auto& patch : bits) {
        for (const std::uint8_t byte : patch) facts.free_cells += std::popcount(byte);
    }
    if (!may_be_none) check_free_cells(o, facts.free_cells);
    const Pieces pieces = cut_into_pieces(site.walls, o.partition_m);
    facts.origin = site.origin;
    facts.crs_wkt = site.crs_wkt;
    facts.required = site.required;
    facts.existing = site.existing;
    facts.buildings = site.buildings;
    facts.walls = static_cast<std::int64_t>(site.walls.size());
    facts.pieces = pieces.size();
    facts.extent = site.extent;
    const Json summary = {{"site", site_summary(site, narrow)},
                          {"grid",
                           {{"cells", layout.grid.size()},
                            {"free_cells", facts.free_cells},
                            {"cell_m", layout.grid.cell_m}}}};
    facts.summary = summary.dump();
    if (may_store) may_store();
    write_site_store(
        path, key, layout, facts, site.walls, pieces,
        near_walls(layout, site.walls, wall_reach_m(o.range_max_m, o.partition_m, o.site.snap_m)),
        bits);
}

void make_site(const GroundOptions& options, const std::filesystem::path& dir,
               const std::string& key, const Threads& threads, Progress& progress,
               const std::function<void(const Site&, const Layout&)>& may_begin,
               const std::function<void()>& may_store) {
    const std::filesystem::path file = site_store_path(dir);
    if (have_shard(file, key, progress)) return;
    {
        const Site site = read_ground(options, threads, progress);
        const Layout layout = layout_of(options, site);
        may_begin(site, layout);
        const std::vector<NarrowPlace> narrow = narrow_places(options, site, layout, threads);
        if (!narrow.empty()) progress.note(narrow_text(narrow, options, site));
        store_site(options, key, site, narrow, threads, file, false, may_store);
    }
    malloc_trim(0);  // of what reading took, nothing is needed any more
}

}  // namespace vfplan
