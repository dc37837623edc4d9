#include "io/exports/map_layout.h"

#include <algorithm>
#include <cmath>

namespace vfplan {
namespace {

constexpr double longest_aspect = 12;  // a corridor is padded, or its map would be a thread

Box world_of(const MapInput& in) {
    Box walls;
    if (in.walls != nullptr) {
        for (const Wall& w : *in.walls) {
            walls.add(w.a);
            walls.add(w.b);
        }
    }
    Box all = walls;
    for (const MapStation& s : in.stations) all.add(s.at);
    for (const MapUncovered& s : in.uncovered) {
        all.add(s.a);
        all.add(s.b);
    }
    if (in.grid != nullptr && in.grid->size() > 0) {
        const Grid& g = *in.grid;
        all.add(g.origin);
        all.add(g.origin + Vec2d(g.nx * g.cell_m, g.ny * g.cell_m));
    }
    if (all.empty()) all = {{0, 0}, {1, 1}};
    const double longest = std::max({all.size().x(), all.size().y(), 1e-3});
    // Room for the line width of walls on the border.
    const Vec2d pad = Vec2d::Constant(0.002 * longest);
    if (!walls.empty()) {
        all.add(walls.min - pad);
        all.add(walls.max + pad);
    }
    for (int axis = 0; axis < 2; ++axis) {
        const double lacking = longest / longest_aspect - all.size()[axis];
        if (lacking > 0) {
            all.min[axis] -= lacking / 2;
            all.max[axis] += lacking / 2;
        }
    }
    return all;
}

}  // namespace

MapLayout map_layout(const MapInput& input, int pixels, std::size_t legend_entries) {
    MapLayout l;
    l.world = world_of(input);
    const Vec2d size = l.world.size();
    pixels = std::max(pixels, 64);
    l.px_per_m = pixels / size.maxCoeff();
    l.map_w = std::max(1, static_cast<int>(std::lround(size.x() * l.px_per_m)));
    l.map_h = std::max(1, static_cast<int>(std::lround(size.y() * l.px_per_m)));
    l.u = std::max(pixels / 1600.0, 0.45);
    const double margin = 36 * l.u;
    l.map_x = static_cast<int>(std::lround(margin));
    l.text_y = margin * 0.8;
    const double head =
        (input.title.empty() ? 0 : 42 * l.u) + (input.subtitle.empty() ? 0 : 30 * l.u);
    l.map_y = static_cast<int>(std::lround(head > 0 ? l.text_y + head + 12 * l.u : margin));
    l.legend_right = size.x() < 1.35 * size.y();
    const double right = l.map_x + l.map_w;
    const double bottom = l.map_y + l.map_h;
    if (l.legend_right) {
        l.legend_x = right + 34 * l.u;
        l.legend_y = l.map_y;
        l.legend_w = 300 * l.u;
        const double legend_h =
            (560 + legend_entry_height * static_cast<double>(legend_entries)) * l.u;
        l.width = static_cast<int>(std::lround(l.legend_x + l.legend_w + margin * 0.6));
        l.height = static_cast<int>(std::lround(std::max(bottom, l.legend_y + legend_h) + margin));
    } else {
        l.legend_x = l.map_x;
        l.legend_y = bottom + 30 * l.u;
        l.legend_w = l.map_w;
        const int rows = std::min(legend_rows_below, static_cast<int>(legend_entries));
        const double legend_h = std::max(100.0, legend_entry_height * rows) * l.u;
        l.width = static_cast<int>(std::lround(right + margin));
        l.height = static_cast<int>(std::lround(l.legend_y + legend_h + margin * 0.7));
    }
    return l;
}

}  // namespace vfplan
