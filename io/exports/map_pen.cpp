#include "io/exports/map_pen.h"

#include <algorithm>

#include "io/exports/png.h"

namespace vfplan::pen {
namespace {

constexpr std::size_t strokes_at_once = 256;  // cairo's stroker slows down on endless paths

// cairo goes into an error state on malformed UTF-8, and site names come from other people's files.
std::string printable(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t n = lead < 0x80 ? 1 : lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
        bool good = lead >= 0x20 && lead != 0x7F &&
                    (lead < 0x80 || (lead >= 0xC2 && lead < 0xF5)) && i + n <= text.size();
        for (std::size_t k = 1; good && k < n; ++k) {
            good = (static_cast<unsigned char>(text[i + k]) & 0xC0U) == 0x80U;
        }
        out += good ? text.substr(i, n) : std::string("?");
        i += good ? n : 1;
    }
    return out;
}

}  // namespace

void set(cairo_t* c, const Rgb& k) {
    cairo_set_source_rgb(c, k.r / 255.0, k.g / 255.0, k.b / 255.0);
}

void font(cairo_t* c, double size, bool bold) {
    cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, size);
}

double text_width(cairo_t* c, const std::string& text) {
    cairo_text_extents_t e;
    cairo_text_extents(c, text.c_str(), &e);
    return e.x_advance;
}

void text_line(cairo_t* c, std::string text, double x, double y, double size, bool bold,
               double room) {
    text = printable(text);
    font(c, size, bold);
    const double wide = text_width(c, text);
    if (wide > room) {
        size = std::max(0.65 * size, size * room / wide);
        font(c, size, bold);
    }
    bool cut = false;
    while (!text.empty() && text_width(c, cut ? text + "…" : text) > room + 1) {
        while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0U) == 0x80U) {
            text.pop_back();
        }
        text.pop_back();
        cut = true;
    }
    cairo_move_to(c, x, y);
    cairo_show_text(c, (cut ? text + "…" : text).c_str());
    cairo_new_path(c);  // text leaves a current point behind
}

void stroke(cairo_t* c, const std::vector<Segment>& segments, const Rgb& colour, double width) {
    set(c, colour);
    cairo_set_line_width(c, width);
    std::size_t waiting = 0;
    for (const Segment& s : segments) {
        cairo_move_to(c, s.x0, s.y0);
        cairo_line_to(c, s.x1, s.y1);
        if (++waiting == strokes_at_once) {
            cairo_stroke(c);
            waiting = 0;
        }
    }
    cairo_stroke(c);
}

void cased(cairo_t* c, const std::vector<Segment>& segments, const Rgb& colour, double width,
           const Rgb& casing, double casing_width) {
    stroke(c, segments, casing, casing_width);
    stroke(c, segments, colour, width);
}

void dot(cairo_t* c, double x, double y, double radius, const Rgb& colour, double u) {
    cairo_arc(c, x, y, radius, 0, 2 * 3.141592653589793);
    set(c, colour);
    cairo_fill_preserve(c);
    set(c, ink);
    cairo_set_line_width(c, std::min(1.6 * u, radius / 2));
    cairo_stroke(c);
}

std::string picture_of(cairo_surface_t* surface, const std::string& what) {
    cairo_surface_flush(surface);
    const int stride = cairo_image_surface_get_stride(surface) / 4;
    return png_of(reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(surface)),
                  cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface),
                  stride, what);
}

}  // namespace vfplan::pen
