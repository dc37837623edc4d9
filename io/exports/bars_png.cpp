#include "io/exports/bars_png.h"

#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/exports/map_pen.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

constexpr double frame_px = 28;
constexpr double row_px = 34;
constexpr double column_px = 220;
constexpr double column_gap_px = 26;
constexpr double number_px = 96;  // room behind the longest bar
constexpr double names_most_px = 640;
constexpr double text_px = 16;
constexpr double top_px = 96;  // titles

constexpr Rgb paper{255, 255, 255};
constexpr Rgb stripe{244, 245, 247};
constexpr Rgb bar{64, 121, 174};
constexpr Rgb mark{196, 78, 30};
constexpr Rgb quiet{110, 112, 120};

double widest(cairo_t* c, const std::vector<std::string>& texts) {
    pen::font(c, text_px);
    double most = 0;
    for (const std::string& t : texts) most = std::max(most, pen::text_width(c, t));
    return most;
}

void box(cairo_t* c, double x, double y, double w, double h, const Rgb& colour) {
    pen::set(c, colour);
    cairo_rectangle(c, x, y, w, h);
    cairo_fill(c);
}

void draw_column(cairo_t* c, const Bars& column, double left) {
    pen::set(c, quiet);
    pen::text_line(c, column.title, left, top_px - 14, text_px, true, column_px);
    double most = 0;
    for (const std::vector<double>* some : {&column.value, &column.mark}) {
        for (const double v : *some) most = std::isnan(v) ? most : std::max(most, v);
    }
    const double px = most > 0 ? (column_px - number_px) / most : 0;
    for (std::size_t r = 0; r < column.value.size(); ++r) {
        const double y = top_px + static_cast<double>(r) * row_px;
        const double length = std::isnan(column.value[r]) ? 0 : px * column.value[r];
        box(c, left, y + 8, length, row_px - 16, bar);
        const bool marked = !column.mark.empty() && !std::isnan(column.mark[r]);
        if (marked) box(c, left + px * column.mark[r] - 1.5, y + 4, 3, row_px - 8, mark);
        const double end = marked ? std::max(length, px * column.mark[r]) : length;
        pen::set(c, pen::ink);
        pen::text_line(c, column.text[r], left + end + 8, y + row_px / 2 + 6, text_px, false,
                       column_px - end - 8);
    }
}

}  // namespace

std::string bars_png(const std::string& title, const std::vector<std::string>& names,
                     const std::vector<Bars>& columns) {
    const auto surface_of = [](int w, int h) {
        Surface s(cairo_image_surface_create(CAIRO_FORMAT_RGB24, w, h), cairo_surface_destroy);
        const cairo_status_t status = cairo_surface_status(s.get());
        if (status == CAIRO_STATUS_SUCCESS) return s;
        throw IoError(std::string("the picture could not be drawn: ") +
                      cairo_status_to_string(status));
    };
    double names_px = 0;
    {
        const Surface scratch = surface_of(1, 1);
        const Context c(cairo_create(scratch.get()), cairo_destroy);
        names_px = std::min(names_most_px, widest(c.get(), names) + 2);
    }
    const double plot = frame_px + names_px;
    const double width =
        plot + static_cast<double>(columns.size()) * (column_gap_px + column_px) + frame_px;
    const double height = top_px + static_cast<double>(names.size()) * row_px + frame_px;
    const Surface surface = surface_of(static_cast<int>(width), static_cast<int>(height));
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_t* c = context.get();
    box(c, 0, 0, width, height, paper);
    pen::set(c, pen::ink);
    pen::text_line(c, title, frame_px, frame_px + 14, 22, true, width - 2 * frame_px);
    for (std::size_t r = 0; r < names.size(); ++r) {
        const double y = top_px + static_cast<double>(r) * row_px;
        if (r % 2 == 0) box(c, frame_px - 8, y, width - 2 * frame_px + 16, row_px, stripe);
        pen::set(c, pen::ink);
        pen::text_line(c, names[r], frame_px, y + row_px / 2 + 6, text_px, false, names_px);
    }
    for (std::size_t k = 0; k < columns.size(); ++k) {
        draw_column(c, columns[k],
                    plot + column_gap_px + static_cast<double>(k) * (column_gap_px + column_px));
    }
    return pen::picture_of(surface.get(), "the comparison");
}

}  // namespace vfplan
