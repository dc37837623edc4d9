// What map.png is drawn with: lines, dots and text on a cairo context. The door to cairo, with
// map_png.cpp.
#pragma once

#include <cairo.h>

#include <string>
#include <vector>

#include "io/exports/map_field.h"

namespace vfplan::pen {

inline constexpr Rgb ink{34, 34, 38};

void set(cairo_t* c, const Rgb& k);
void font(cairo_t* c, double size, bool bold = false);
double text_width(cairo_t* c, const std::string& text);
// One line that fits into `room`: smaller first, then cut. Malformed UTF-8 becomes question marks.
void text_line(cairo_t* c, std::string text, double x, double y, double size, bool bold,
               double room);

struct Segment {
    double x0, y0, x1, y1;
};
void stroke(cairo_t* c, const std::vector<Segment>& segments, const Rgb& colour, double width);
// With a casing of another colour around them.
void cased(cairo_t* c, const std::vector<Segment>& segments, const Rgb& colour, double width,
           const Rgb& casing, double casing_width);
// What is drawn, as PNG. REQUIRES: an image of format RGB24. Throws as vfplan::png_of().
std::string picture_of(cairo_surface_t* surface, const std::string& what);
void dot(cairo_t* c, double x, double y, double radius, const Rgb& colour, double u);

}  // namespace vfplan::pen
