// map.png: the field as a picture, with walls, stations and links, a scale bar and a legend.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan {

struct MapStation {
    Vec2d at;                  // site frame, metres
    std::int32_t network = 0;  // 0 is the main network
};

struct MapLink {
    std::int32_t from = 0;  // indices into MapInput::stations
    std::int32_t to = 0;
};

// A stretch of wall that the plan leaves unscanned.
struct MapUncovered {
    Vec2d a;
    Vec2d b;
};

struct MapInput {
    std::string title;     // one line, the site's name
    std::string subtitle;  // one line, what the plan reached
    const Grid* grid = nullptr;
    const Raster<float>* field_rad = nullptr;  // NaN where no station can stand
    const std::vector<Wall>* walls = nullptr;
    std::vector<MapStation> stations;
    std::vector<MapLink> links;
    std::vector<MapUncovered> uncovered;
};

// Draws the map as a PNG image in memory; longest side of the map area about `pixels`.
// The same input gives the same bytes on one machine (fonts differ between machines).
// Thread-safe. Throws IoError when the image library refuses.
std::string map_png(const MapInput& input, int pixels = 1600);

}  // namespace vfplan
