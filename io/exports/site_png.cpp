#include "io/exports/site_png.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

#include "io/exports/map_pen.h"
#include "kernels/error.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void check(cairo_status_t status) {
    if (status == CAIRO_STATUS_SUCCESS) return;
    throw IoError(std::string("the picture could not be drawn: ") + cairo_status_to_string(status));
}

struct Colour {
    double red, green, blue;
};
constexpr std::array<Colour, 4> class_colours = {
    {{0.08, 0.08, 0.1}, {0.1, 0.45, 0.85}, {0.95, 0.55, 0.1}, {0.55, 0.36, 0.23}}};
constexpr Colour face_colour{0.1, 0.62, 0.25};

constexpr std::uint32_t taken_rgb = 0xC9C9CE;
constexpr std::uint32_t free_rgb = 0xFFFFFF;
constexpr std::uint32_t left_out_rgb = 0xF2A9A0;

// Pixels as cells of a grid, row 0 in the south.
Grid pixel_grid(const Box& box, int pixels) {
    const Vec2d size = box.size();
    Grid grid;
    grid.cell_m = std::max(size.maxCoeff(), 1e-3) / pixels;
    grid.origin = box.min;
    grid.nx = std::max(1, static_cast<std::int32_t>(std::ceil(size.x() / grid.cell_m)));
    grid.ny = std::max(1, static_cast<std::int32_t>(std::ceil(size.y() / grid.cell_m)));
    return grid;
}

void fill_ground(const Site& site, const Grid& grid, cairo_surface_t* surface) {
    const Raster<std::uint8_t> free = free_cells(grid, site.free_border);
    const Raster<std::uint8_t> left_out = free_cells(grid, site.left_out_border);
    cairo_surface_flush(surface);
    unsigned char* data = cairo_image_surface_get_data(surface);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
    for (std::int32_t y = 0; y < grid.ny; ++y) {
        auto* row = reinterpret_cast<std::uint32_t*>(data + idx(grid.ny - 1 - y) * stride);
        for (std::int32_t x = 0; x < grid.nx; ++x) {
            const std::size_t cell = idx(grid.id(x, y));
            row[x] = free[cell] != 0 ? free_rgb : left_out[cell] != 0 ? left_out_rgb : taken_rgb;
        }
    }
    cairo_surface_mark_dirty(surface);
}

}  // namespace

std::string site_png(const Site& site, int pixels) {
    Box box = site.extent;
    const double frame = 0.02 * std::max(box.size().maxCoeff(), 1e-3);
    box = {box.min - Vec2d(frame, frame), box.max + Vec2d(frame, frame)};
    const Grid grid = pixel_grid(box, pixels);
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, grid.nx, grid.ny),
                          cairo_surface_destroy);
    check(cairo_surface_status(surface.get()));
    fill_ground(site, grid, surface.get());
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_t* c = context.get();
    const auto line = [&](const Vec2d& a, const Vec2d& b, const Colour& colour, double width,
                          double aside) {
        const Vec2d p = (a - grid.origin) / grid.cell_m;
        const Vec2d q = (b - grid.origin) / grid.cell_m;
        const Vec2d along = (q - p).normalized();
        const Vec2d off = aside * Vec2d(-along.y(), along.x());
        cairo_set_source_rgb(c, colour.red, colour.green, colour.blue);
        cairo_set_line_width(c, width);
        cairo_move_to(c, p.x() + off.x(), grid.ny - p.y() - off.y());
        cairo_line_to(c, q.x() + off.x(), grid.ny - q.y() - off.y());
        cairo_stroke(c);
    };
    for (const Wall& w : site.walls) {
        if (!w.scanned) continue;
        if (w.free_side[left]) line(w.a, w.b, face_colour, 1.6, 2);
        if (w.free_side[right]) line(w.a, w.b, face_colour, 1.6, -2);
    }
    for (const Wall& w : site.walls)
        line(w.a, w.b, class_colours[idx(static_cast<int>(w.cls))], 1.4, 0);
    return pen::picture_of(surface.get(), "the picture of the site");
}

}  // namespace vfplan
