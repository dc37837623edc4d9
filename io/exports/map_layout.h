// Where the parts of map.png go, in pixels.
#pragma once

#include <cstddef>

#include "io/exports/map_png.h"

namespace vfplan {

inline constexpr double legend_entry_height = 30;  // in units of Layout::u
inline constexpr int legend_rows_below = 5;        // entries per column of a legend below the map

struct MapLayout {
    double u = 1;  // one unit of line width: 1 pixel in a map of 1600
    double px_per_m = 1;
    Box world;      // what the map area shows
    int map_x = 0;  // upper left corner of the map area
    int map_y = 0;
    int map_w = 0;
    int map_h = 0;
    bool legend_right = true;
    double legend_x = 0;
    double legend_y = 0;
    double legend_w = 0;
    double text_y = 0;  // top of the title
    int width = 0;
    int height = 0;

    double x(const Vec2d& p) const { return map_x + (p.x() - world.min.x()) * px_per_m; }
    double y(const Vec2d& p) const { return map_y + map_h - (p.y() - world.min.y()) * px_per_m; }
};

// The legend stands right of the map, or below it where the site is wide.
MapLayout map_layout(const MapInput& input, int pixels, std::size_t legend_entries);

}  // namespace vfplan
