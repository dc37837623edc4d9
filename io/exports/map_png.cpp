#include "io/exports/map_png.h"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <set>

#include "io/exports/map_field.h"
#include "io/exports/map_layout.h"
#include "io/exports/map_pen.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using namespace pen;

constexpr Rgb soft_ink{92, 92, 98};
constexpr Rgb frame_colour{64, 64, 64};
constexpr Rgb white{255, 255, 255};
constexpr Rgb wall_colour{26, 26, 30};
constexpr Rgb window_colour{120, 214, 255};
constexpr Rgb door_colour{255, 170, 84};
constexpr Rgb obstacle_colour{140, 92, 58};
constexpr Rgb uncovered_colour{232, 16, 16};
constexpr Rgb main_colour{255, 64, 190};
constexpr std::array<Rgb, 6> network_colours{{{255, 144, 20},
                                              {120, 226, 255},
                                              {255, 255, 255},
                                              {165, 100, 60},
                                              {186, 156, 255},
                                              {20, 20, 20}}};

struct SurfaceDeleter {
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct ContextDeleter {
    void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;

void check(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) {
        throw IoError(std::string("map.png could not be drawn: ") + cairo_status_to_string(status) +
                      "; leave png out of output.formats to go on without the map");
    }
}

Rgb station_colour(std::int32_t network) {
    if (network <= 0) return main_colour;
    return network_colours[static_cast<std::size_t>(network - 1) % network_colours.size()];
}

struct LegendEntry {
    std::string text;
    std::function<void(cairo_t*, double x, double y, double u)> draw;  // x: left, y: middle
};

// 1, 2 or 5 times a power of ten, at most `limit`.
double round_below(double limit) {
    const double power = std::pow(10.0, std::floor(std::log10(limit)));
    for (const double f : {5.0, 2.0}) {
        if (f * power <= limit) return f * power;
    }
    return power;
}

std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
}

std::string metres(double m) { return m >= 1000 ? number(m / 1000) + " km" : number(m) + " m"; }

// ---- the map area -----------------------------------------------------------------------------

struct Style {
    double wall = 2;  // widths and radius in pixels
    double link = 1.6;
    double dot = 8;
};

Style make_style(const MapInput& in, const MapLayout& l) {
    const double area = static_cast<double>(l.map_w) * l.map_h;
    double wall_px = 0;
    if (in.walls != nullptr) {
        for (const Wall& w : *in.walls) wall_px += (w.b - w.a).norm() * l.px_per_m;
    }
    Style s;
    // Ink on a few per cent of the map, whether it is a flat or a county.
    s.wall = std::clamp(0.045 * area / std::max(wall_px, 1.0), 0.15 * l.u, 3.4 * l.u);
    const double spacing =
        std::sqrt(area / std::max<double>(1, static_cast<double>(in.stations.size())));
    s.dot = std::clamp(0.12 * spacing, 2.2 * l.u, 9.5 * l.u);
    s.link = std::clamp(0.2 * s.dot, 0.5 * l.u, 1.8 * l.u);
    return s;
}

void draw_field(cairo_t* c, const MapInput& in, const MapLayout& l, double max_rad) {
    if (in.grid == nullptr || in.field_rad == nullptr || in.grid->size() == 0) return;
    if (static_cast<std::int64_t>(in.field_rad->size()) < in.grid->size()) {
        throw IoError(
            "map.png could not be drawn: the field has fewer values than the grid has "
            "cells; run again with --fresh");
    }
    const PixelWindow window{{l.world.min.x(), l.world.max.y()}, l.px_per_m, l.map_w, l.map_h};
    std::vector<std::uint32_t> pixels = field_pixels(*in.grid, *in.field_rad, max_rad, window);
    const Surface image(cairo_image_surface_create(CAIRO_FORMAT_RGB24, l.map_w, l.map_h));
    check(cairo_surface_status(image.get()));
    unsigned char* data = cairo_image_surface_get_data(image.get());
    const int stride = cairo_image_surface_get_stride(image.get());
    for (int row = 0; row < l.map_h; ++row) {
        std::memcpy(data + static_cast<std::ptrdiff_t>(row) * stride,
                    pixels.data() + static_cast<std::ptrdiff_t>(row) * l.map_w,
                    static_cast<std::size_t>(l.map_w) * 4);
    }
    cairo_surface_mark_dirty(image.get());
    cairo_set_source_surface(c, image.get(), l.map_x, l.map_y);
    cairo_paint(c);
}

void draw_walls(cairo_t* c, const MapInput& in, const MapLayout& l, const Style& style) {
    if (in.walls == nullptr) return;
    std::array<std::vector<Segment>, 4> by_class;
    for (const Wall& w : *in.walls) {
        by_class[static_cast<std::size_t>(w.cls) % 4].push_back(
            {l.x(w.a), l.y(w.a), l.x(w.b), l.y(w.b)});
    }
    const double thick = std::max(style.wall, 0.6 * l.u);
    stroke(c, by_class[static_cast<int>(WallClass::obstacle)], obstacle_colour, thick);
    stroke(c, by_class[static_cast<int>(WallClass::wall)], wall_colour, style.wall);
    cased(c, by_class[static_cast<int>(WallClass::door)], door_colour, thick, wall_colour,
          1.9 * thick);
    cased(c, by_class[static_cast<int>(WallClass::window)], window_colour, thick, wall_colour,
          1.9 * thick);
}

void draw_uncovered(cairo_t* c, const MapInput& in, const MapLayout& l, const Style& style) {
    std::vector<Segment> segments;
    for (const MapUncovered& s : in.uncovered) {
        segments.push_back({l.x(s.a), l.y(s.a), l.x(s.b), l.y(s.b)});
    }
    // Thousands of stretches in a city must not hide the field.
    const double area = static_cast<double>(l.map_w) * l.map_h;
    const double spacing =
        std::sqrt(area / static_cast<double>(std::max<std::size_t>(segments.size(), 1)));
    const double width =
        std::clamp(0.1 * spacing, 0.8 * l.u, std::max(2.4 * l.u, 1.3 * style.wall));
    cased(c, segments, uncovered_colour, width, white, 1.8 * width);
}

void draw_plan(cairo_t* c, const MapInput& in, const MapLayout& l, const Style& style) {
    const auto count = static_cast<std::int32_t>(in.stations.size());
    std::vector<Segment> links;
    for (const MapLink& k : in.links) {
        if (k.from < 0 || k.to < 0 || k.from >= count || k.to >= count) continue;
        const Vec2d& a = in.stations[static_cast<std::size_t>(k.from)].at;
        const Vec2d& b = in.stations[static_cast<std::size_t>(k.to)].at;
        links.push_back({l.x(a), l.y(a), l.x(b), l.y(b)});
    }
    if (!links.empty()) {
        // Along a corridor everyone may see everyone: such a plan gets finer, paler links, and the
        // field stays visible below them.
        double links_px = 0;
        for (const Segment& s : links) links_px += Vec2d(s.x1 - s.x0, s.y1 - s.y0).norm();
        const double area = static_cast<double>(l.map_w) * l.map_h;
        const double width = std::min(style.link, std::max(0.07 * area / links_px, 0.7 * l.u));
        const double share = width / style.link;
        cairo_push_group(c);
        cased(c, links, white, width, ink, width + 1.6 * l.u * share);
        cairo_pop_group_to_source(c);
        cairo_paint_with_alpha(c, 0.5 + 0.3 * share);
    }
    // The main network last, so that it lies on top.
    for (const bool main : {false, true}) {
        for (const MapStation& s : in.stations) {
            if ((s.network <= 0) == main) {
                dot(c, l.x(s.at), l.y(s.at), style.dot, station_colour(s.network), l.u);
            }
        }
    }
}

// ---- the legend -------------------------------------------------------------------------------

std::vector<LegendEntry> legend_entries(const MapInput& in) {
    std::vector<LegendEntry> out;
    const auto add_dot = [&](const std::string& text, const Rgb& colour) {
        out.push_back({text, [colour](cairo_t* c, double x, double y, double u) {
                           dot(c, x + 17 * u, y, 8 * u, colour, u);
                       }});
    };
    const auto add_line = [&](const std::string& text, const Rgb& colour, double width,
                              const Rgb& casing, double casing_width) {
        out.push_back({text, [=](cairo_t* c, double x, double y, double u) {
                           const std::vector<Segment> s{{x, y, x + 34 * u, y}};
                           cased(c, s, colour, width * u, casing, casing_width * u);
                       }});
    };
    std::set<std::int32_t> networks;
    for (const MapStation& s : in.stations) networks.insert(std::max(s.network, 0));
    int further = 0;
    for (const std::int32_t n : networks) {
        if (n == 0) {
            add_dot(networks.size() > 1 ? "station, main network" : "station", main_colour);
        } else if (further++ < 4) {
            add_dot("station, network " + std::to_string(n + 1), station_colour(n));
        }
    }
    if (further > 4) add_dot("and " + std::to_string(further - 4) + " more networks", soft_ink);
    if (!in.links.empty()) add_line("link", white, 1.8, ink, 3.6);
    if (!in.uncovered.empty()) add_line("wall not covered", uncovered_colour, 3.6, white, 5);
    std::array<bool, 4> present{};
    if (in.walls != nullptr) {
        for (const Wall& w : *in.walls) present[static_cast<std::size_t>(w.cls) % 4] = true;
    }
    if (present[0]) add_line("wall", wall_colour, 3, wall_colour, 3);
    if (present[1]) add_line("window", window_colour, 3, wall_colour, 5.6);
    if (present[2]) add_line("door", door_colour, 3, wall_colour, 5.6);
    if (present[3]) add_line("obstacle", obstacle_colour, 3, obstacle_colour, 3);
    const bool gaps = in.grid != nullptr && in.field_rad != nullptr &&
                      std::any_of(in.field_rad->begin(), in.field_rad->end(),
                                  [](float v) { return !std::isfinite(v); });
    if (gaps) {
        out.push_back({"no station possible", [](cairo_t* c, double x, double y, double u) {
                           cairo_rectangle(c, x + 3 * u, y - 9 * u, 28 * u, 18 * u);
                           set(c, no_value_colour);
                           cairo_fill_preserve(c);
                           set(c, soft_ink);
                           cairo_set_line_width(c, u);
                           cairo_stroke(c);
                       }});
    }
    return out;
}

// Upright at the right, lying below. Returns the space taken along the legend's direction.
double draw_colour_bar(cairo_t* c, const MapLayout& l, double x, double y, double max_rad) {
    const double u = l.u;
    set(c, ink);
    text_line(c, "observed angle (rad)", x, y + 16 * u, 18 * u, false, 300 * u);
    const bool upright = l.legend_right;
    const double length = (upright ? 360 : 400) * u;
    const double thick = 26 * u;
    const double top = y + 32 * u;
    const int steps = 256;
    cairo_set_antialias(c, CAIRO_ANTIALIAS_NONE);  // neighbouring steps must not show seams
    for (int i = 0; i < steps; ++i) {
        set(c, viridis((i + 0.5) / steps));
        const double from = length * i / steps;
        const double step = length / steps;
        if (upright) {
            cairo_rectangle(c, x, top + length - from - step, thick, step);
        } else {
            cairo_rectangle(c, x + from, top, step, thick);
        }
        cairo_fill(c);
    }
    cairo_set_antialias(c, CAIRO_ANTIALIAS_DEFAULT);
    set(c, ink);
    cairo_set_line_width(c, u);
    cairo_rectangle(c, x, top, upright ? thick : length, upright ? length : thick);
    cairo_stroke(c);
    font(c, 16 * u);
    const auto tick = [&](double value, const std::string& text) {
        const double at = length * value / max_rad;
        const double tx = upright ? x + thick : x + at;
        const double ty = upright ? top + length - at : top + thick;
        cairo_move_to(c, tx, ty);
        cairo_line_to(c, upright ? tx + 6 * u : tx, upright ? ty : ty + 6 * u);
        cairo_stroke(c);
        cairo_move_to(c, upright ? tx + 12 * u : tx - text_width(c, text) / 2,
                      upright ? ty + 6 * u : ty + 22 * u);
        cairo_show_text(c, text.c_str());
        cairo_new_path(c);
    };
    const double step = round_below(max_rad / 2.5);
    for (int i = 0; i * step < max_rad - 0.45 * step; ++i) tick(i * step, number(i * step));
    std::array<char, 32> top_text{};
    std::snprintf(top_text.data(), top_text.size(), max_rad < 0.1 ? "%.2g" : "%.2f", max_rad);
    tick(max_rad, top_text.data());
    return upright ? length + 64 * u : length + 70 * u;
}

double draw_scale_bar(cairo_t* c, const MapLayout& l, double x, double y) {
    const double u = l.u;
    const double room = std::min(l.legend_right ? 220 * u : 300 * u, 0.4 * l.map_w);
    const double length_m = round_below(room / l.px_per_m);
    const double length = length_m * l.px_per_m;
    set(c, ink);
    text_line(c, metres(length_m), x, y + 16 * u, 18 * u, false, 300 * u);
    // Two fields, dark and light, so that half the length can be read too.
    const double top = y + 32 * u;
    cairo_rectangle(c, x, top, length / 2, 10 * u);
    cairo_fill(c);
    cairo_rectangle(c, x, top, length, 10 * u);
    cairo_set_line_width(c, 1.4 * u);
    cairo_stroke(c);
    return l.legend_right ? 84 * u : std::max(length, 70 * u) + 70 * u;
}

void draw_legend(cairo_t* c, const MapLayout& l, const std::vector<LegendEntry>& entries,
                 double max_rad) {
    const double u = l.u;
    double x = l.legend_x;
    double y = l.legend_y;
    double& along = l.legend_right ? y : x;
    if (max_rad > 0) along += draw_colour_bar(c, l, x, y, max_rad);
    along += draw_scale_bar(c, l, x, y);
    const double column_w = 290 * u;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const int column = l.legend_right ? 0 : static_cast<int>(i) / legend_rows_below;
        const auto row = static_cast<int>(i) - column * legend_rows_below;
        const double ex = x + column * column_w;
        const double ey = y + (12 + legend_entry_height * row) * u;
        entries[i].draw(c, ex, ey, u);
        set(c, ink);
        text_line(c, entries[i].text, ex + 48 * u, ey + 6 * u, 18 * u, false, column_w - 48 * u);
    }
}

}  // namespace

std::string map_png(const MapInput& input, int pixels) {
    const std::vector<LegendEntry> entries = legend_entries(input);
    const MapLayout l = map_layout(input, pixels, entries.size());
    const Style style = make_style(input, l);
    const double max_rad = input.field_rad != nullptr ? field_max(*input.field_rad) : 0;

    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, l.width, l.height));
    check(cairo_surface_status(surface.get()));
    const Context context(cairo_create(surface.get()));
    cairo_t* c = context.get();
    cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    set(c, white);
    cairo_paint(c);

    cairo_save(c);
    cairo_rectangle(c, l.map_x, l.map_y, l.map_w, l.map_h);
    cairo_clip(c);
    draw_field(c, input, l, max_rad);
    draw_walls(c, input, l, style);
    draw_uncovered(c, input, l, style);
    cairo_restore(c);

    cairo_set_line_cap(c, CAIRO_LINE_CAP_BUTT);
    cairo_rectangle(c, l.map_x - 0.5, l.map_y - 0.5, l.map_w + 1, l.map_h + 1);
    set(c, frame_colour);
    cairo_set_line_width(c, 1);
    cairo_stroke(c);
    // Not clipped: a station next to the border keeps its whole dot.
    cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
    draw_plan(c, input, l, style);
    cairo_set_line_cap(c, CAIRO_LINE_CAP_BUTT);

    const double room = l.width - 2.0 * l.map_x;
    double y = l.text_y;
    if (!input.title.empty()) {
        set(c, ink);
        text_line(c, input.title, l.map_x, y + 28 * l.u, 30 * l.u, true, room);
        y += 42 * l.u;
    }
    if (!input.subtitle.empty()) {
        set(c, soft_ink);
        text_line(c, input.subtitle, l.map_x, y + 20 * l.u, 19 * l.u, false, room);
    }
    draw_legend(c, l, entries, max_rad);

    check(cairo_status(c));
    return picture_of(surface.get(), "map.png");
}

}  // namespace vfplan
