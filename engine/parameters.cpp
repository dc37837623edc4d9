#include <fmt/format.h>

#include "engine/config.h"

namespace vfplan {

std::vector<std::pair<Parameter, ParameterValue>> parameters(Config& c) {
    constexpr Stage tables = Stage::tables;
    constexpr Stage plan = Stage::plan;
    constexpr Stage output = Stage::output;
    return {
        {{"", "preset", "the paper's defaults for all below: outdoor or indoor", tables,
          {"outdoor", "indoor"}},
         &c.preset},

        {{"site", "input", "site file: GeoJSON, GeoPackage, Shapefile, OSM, DXF, ...; relative to "
                           "the job file", tables},
         &c.site.input},
        {{"site", "layer", "layer of a file with several; DXF: parts of layer names, with commas; empty: all or "
                           "the only one", tables},
         &c.site.layer},
        {{"site", "kind", "outdoor: polygons are solid; indoor: free space is inside", tables,
          {"outdoor", "indoor"}},
         &c.site.kind},
        {{"site", "crop_m", "x0, y0, x1, y1 in the file's metres: keep the features with their "
                            "centre inside; empty: all", tables},
         &c.site.crop_m},
        {{"site", "doors", "indoor: open doors are gaps, closed ones are walls", tables,
          {"open", "closed"}},
         &c.site.doors},
        {{"site", "windows", "indoor: wall: to be scanned; ignore: blocks sight, need not be "
                             "scanned; opening: a gap", tables,
          {"wall", "ignore", "opening"}},
         &c.site.windows},
        {{"site", "crs", "project the site first: utm, or a name such as EPSG:32617; empty: "
                         "coordinates are metres already", tables},
         &c.site.crs},
        {{"site", "unit_m", "metres per unit of the file (0.0254 for inches)", tables, {}, 0, 1e6,
          true},
         &c.site.unit_m},
        {{"site", "snap_m", "points closer than this are one point, in metres", tables, {}, 1e-6, 1},
         &c.site.snap_m},
        {{"site", "margin_m", "outdoor: free ground around the outermost walls, in metres", tables,
          {}, 0, 1e5},
         &c.site.margin_m},
        {{"site", "invalid", "polygons that cross themselves: error, repair or drop", tables,
          {"error", "repair", "drop"}},
         &c.site.invalid},

        {{"scanner", "range_min_m", "nearer walls are not recorded but still occlude, in metres",
          tables, {}, 0, 1e6},
         &c.scanner.range_min_m},
        {{"scanner", "range_max_m", "farther walls are not recorded, in metres", tables, {}, 0, 1e6,
          true},
         &c.scanner.range_max_m},
        {{"scanner", "max_incidence_deg", "largest angle between beam and wall normal, in degrees; "
                                          "90: no limit", tables, {}, 0, 90, true},
         &c.scanner.max_incidence_deg},

        {{"visibility", "kernel", "embree: packets of rays, wall ends found analytically; exact: "
                                  "triangular expansion", tables, {"embree", "exact"}},
         &c.visibility.kernel},
        {{"visibility", "rays", "embree: rays per view before wall ends are followed, a power of "
                                "two; 0: from range and partition", tables, {}, 0, 65536},
         &c.visibility.rays},

        {{"field", "cell_m", "side of a grid cell, in metres", tables, {}, 0, 1e4, true},
         &c.field.cell_m},
        {{"field", "threshold_rad", "cells that see a smaller angle of wall carry no skeleton, in "
                                    "radians", tables, {}, 0, 6.283185307179587},
         &c.field.threshold_rad},

        {{"coverage", "partition_m", "walls are cut into pieces no longer than this, in metres",
          tables, {}, 0, 1e4, true},
         &c.coverage.partition_m},
        {{"coverage", "visible_fraction", "share of a piece's length that must be seen", tables, {},
          0, 1, true},
         &c.coverage.visible_fraction},

        {{"overlap", "ratio", "how overlap is measured (equations 8 to 12)", tables,
          {"min_len", "mean_len", "union_len", "union_ang", "mean_ang"}},
         &c.overlap.ratio},
        {{"overlap", "threshold", "stations that overlap by at least this can be registered",
          tables, {}, 0, 1, true},
         &c.overlap.threshold},

        {{"plan", "method", "greedy: the paper's Algorithm 1; refined: greedy, then pruned", plan,
          {"greedy", "refined", "certified"}},
         &c.plan.method},
        {{"plan", "loops", "put every station on a cycle of links where that is possible", plan},
         &c.plan.loops},
        {{"plan", "time_limit_s", "for searches that could go on, in seconds", output, {}, 0, 1e9,
          true},
         &c.plan.time_limit_s},
        {{"plan", "required", "[[x, y], ...] in the file's metres: stations that must be in the "
                              "plan", tables},
         &c.plan.required},
        {{"plan", "forbidden", "file of polygons where no station may stand; relative to the job "
                               "file", tables},
         &c.plan.forbidden},
        {{"plan", "existing", "[[x, y], ...] in the file's metres: scans that already exist; they "
                              "join the network", tables},
         &c.plan.existing},

        {{"output", "formats", "files beside the tables: geojson, csv, png", output,
          {"geojson", "csv", "png"}},
         &c.output.formats},
        {{"output", "map_px", "longest side of the map in map.png, in pixels", output, {}, 200, 20000},
         &c.output.map_px},
    };
}

}  // namespace vfplan
