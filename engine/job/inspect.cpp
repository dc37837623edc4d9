#include "engine/job/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/runtime/parallel.h"
#include "engine/tables/narrow.h"
#include "engine/tables/site.h"
#include "io/exports/site_png.h"
#include "io/formats/read_features.h"
#include "io/site/site_reader.h"
#include "io/tables/crs.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

std::string read_as_text(const HowRead& how) {
    std::string out;
    for (const ReadAs& a : how.as) {
        out += fmt::format("  {:>9} {:<9} {}{}, by {}\n", a.count, a.role,
                           a.text.empty() ? "" : fmt::format("\"{}\" ", a.text),
                           a.layer.empty() ? "" : fmt::format("in layer {}", a.layer), a.why);
    }
    return out;
}

std::string walls_text(const Site& site) {
    struct Sum {
        std::int64_t walls = 0;
        double length_m = 0;
        double faces_m = 0;
    };
    std::array<Sum, names_of<WallClass>().size()> by_class;
    for (const Wall& w : site.walls) {
        Sum& s = by_class[idx(static_cast<int>(w.cls))];
        ++s.walls;
        s.length_m += w.length_m();
        if (w.scanned) s.faces_m += (w.free_side[left] + w.free_side[right]) * w.length_m();
    }
    std::string out;
    for (std::size_t c = 0; c < by_class.size(); ++c) {
        if (by_class[c].walls == 0) continue;
        out += fmt::format("  {:<9} {} pieces of {:.2f} m in all, {:.2f} m of faces to scan\n",
                           names_of<WallClass>()[c], by_class[c].walls, by_class[c].length_m,
                           by_class[c].faces_m);
    }
    return out;
}

std::string dropped_text(const Site& site) {
    constexpr std::size_t most = 10;
    double ground_m2 = 0;
    double faces_m = 0;
    for (const Dropped& d : site.dropped) {
        ground_m2 += d.area_m2;
        faces_m += d.faces_m;
    }
    std::string out =
        fmt::format("left out   {:.2f} m2 of ground and {:.2f} m of faces, in {} places\n",
                    ground_m2, faces_m, site.dropped.size());
    for (std::size_t i = 0; i < std::min(most, site.dropped.size()); ++i) {
        const Dropped& d = site.dropped[i];
        const Vec2d at = d.at + site.origin;
        out += fmt::format("  {:<9} {:.2f} m2, {:.2f} m of faces, at ({:.2f}, {:.2f})\n",
                           name_of(d.why), d.area_m2, d.faces_m, at.x(), at.y());
    }
    return out + (site.dropped.size() > most ? "  ...\n" : "");
}

// Where the ground jumps as openings that count as part of the building may be wider.
std::string openings_text(const std::vector<OpeningStep>& steps, double max_opening_m) {
    if (steps.empty()) return "";
    std::string out =
        fmt::format("openings   what is inside by site.max_opening_m ({} m now):\n", max_opening_m);
    bool now = false;
    for (const OpeningStep& s : steps) {
        if (!now && s.opening_m > max_opening_m) {
            now = true;
            out += "  -- now --\n";
        }
        out += fmt::format("  {:>6.2f} m  {:.2f} m2\n", s.opening_m, s.inside_m2);
    }
    return out;
}

// On cells that are fine enough for the clearance, if these are few enough for a look.
std::string narrow_ground(const Config& config, const Site& site, const Threads& threads) {
    constexpr double cells_most = 2e7;
    GroundOptions ground = ground_options(config);
    ground.cell_m = std::max(ground.cell_m, ground.clearance_m / 8);
    const Vec2d cells = site.extent.size() / ground.cell_m;
    if (cells.minCoeff() < 1 || cells.prod() > cells_most) return "";
    const auto narrow = narrow_places(ground, site, layout_of(ground, site), threads);
    return narrow.empty() ? "" : narrow_text(narrow, ground, site) + "\n";
}

}  // namespace

BareSite bare_site(const std::filesystem::path& file, const std::vector<std::string>& sets) {
    const auto job = [&](const std::string& preset, const std::string& crs) {
        std::string text = preset.empty() ? "" : "preset = \"" + preset + "\"\n";
        text += "[site]\n" + (crs.empty() ? "" : "crs = \"" + crs + "\"\n");
        Config config = parse_config(text + "input = \".\"\n", file.string(), ".", sets);
        config.site.input = std::filesystem::absolute(file).lexically_normal();
        return config;
    };
    const auto read = [&](const Config& config) {
        const SiteOptions options = ground_options(config).site;
        return read_features(file, options);
    };
    const auto given = [&](const std::string& key) {
        return std::any_of(sets.begin(), sets.end(),
                           [&](const std::string& s) { return s.rfind(key + "=", 0) == 0; });
    };
    std::string crs;
    FeatureSet set;
    try {
        set = read(job("", crs));
    } catch (const InputError&) {
        if (given("site.crs")) throw;
        crs = "utm";  // in degrees, perhaps
        set = read(job("", crs));
    }
    if (given("preset")) return {job("", crs), std::move(set)};
    const bool plan =
        set.how.plan || std::any_of(set.features.begin(), set.features.end(), [](const Feature& f) {
            constexpr std::array roles = {Role::room, Role::door, Role::window, Role::outline,
                                          Role::opening};
            return std::find(roles.begin(), roles.end(), f.role) != roles.end();
        });
    // Without a preset a job is outdoor.
    if (!plan) return {job("outdoor", crs), std::move(set)};
    return {job("indoor", crs), {}};
}

Inspection inspect(const Config& config, int thread_count, std::optional<FeatureSet> features) {
    const Threads threads(thread_count);
    SiteOptions options = ground_options(config).site;
    options.for_each = [&](std::int64_t n, const SiteOptions::Body& body) {
        threads.for_each(n, 16, body);
    };
    constexpr double widest_m = 6;
    options.opening_steps_up_to_m = std::max(widest_m, 2 * options.max_opening_m);
    const SiteResult read =
        features ? build_site(std::move(*features), options, config.site.input.string())
                 : read_site(config.site.input, options);
    const Site& site = read.site;
    const CleaningCounts& c = site.counts;
    const Vec2d size = site.extent.size();
    const Vec2d at = site.origin + site.extent.min;
    std::string crs = crs_name(site.crs_wkt);
    if (crs.empty()) crs = "unknown: results lie nowhere on a map (site.crs says where)";
    std::string text = fmt::format(
        "file       {}: {}, read with preset \"{}\"\n"
        "features   {}, as\n{}"
        "unit       {}\n"
        "crs        {}\n"
        "extent     {:.2f} x {:.2f} m from ({:.2f}, {:.2f})\n"
        "edges      {} read, {} too short, {} repeated, {} split, {} joined, {} inside solids, {} "
        "in "
        "openings, {} slivers\n"
        "walls      {}\n{}"
        "ground     {} {}, {:.2f} m2 {}\n",
        config.site.input.string(), read.how.format, name_of(config.preset), c.features,
        read_as_text(read.how), read.how.unit, crs, size.x(), size.y(), at.x(), at.y(), c.edges_in,
        c.zero_length, c.duplicates, c.split, c.merged, c.inside_solids, c.opened, c.slivers,
        site.walls.size(), walls_text(site), site.buildings,
        options.kind == SiteKind::outdoor ? "solid polygons" : "rooms", site.area_m2,
        options.kind == SiteKind::outdoor ? "built over" : "free");
    if (options.kind == SiteKind::indoor) {
        text += dropped_text(site) + openings_text(read.opening_steps, options.max_opening_m);
    }
    text += narrow_ground(config, site, threads);
    for (const std::string& w : read.warnings) text += "warning    " + w + "\n";
    return {text, site_png(site)};
}

}  // namespace vfplan
