// How a site is read.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/features/read_options.h"
#include "kernels/names.h"

namespace vfplan {

enum class DoorMode : std::uint8_t { open, closed };
enum class WindowMode : std::uint8_t { wall, ignore, opening };
enum class InvalidPolygons : std::uint8_t { error, repair, drop };

template <>
struct Names<DoorMode> {
    static constexpr std::array<std::string_view, 2> all = {"open", "closed"};
};
template <>
struct Names<WindowMode> {
    static constexpr std::array<std::string_view, 3> all = {"wall", "ignore", "opening"};
};
template <>
struct Names<InvalidPolygons> {
    static constexpr std::array<std::string_view, 3> all = {"error", "repair", "drop"};
};

struct SiteOptions : ReadOptions {
    double snap_m = 0.001;
    double margin_m = 0;  // free ground around the outermost walls (outdoor)
    std::vector<Vec2d>
        points;  // places to bring into the site's metres; in degrees where the file has them
    std::vector<double>
        crop_m;  // empty or x0, y0, x1, y1 in metres, or degrees if the file has them
    DoorMode doors = DoorMode::open;
    WindowMode windows = WindowMode::wall;
    InvalidPolygons invalid = InvalidPolygons::error;
    // Indoors (io/site/ground.h):
    double max_opening_m = 2;
    double min_width_m = 0.3;
    double min_room_m2 = 1;
    double max_gap_m2 = 2;
    double opening_steps_up_to_m = 0;  // how the ground depends on max_opening_m is wanted
    // Calls body(from, to) for disjoint parts of [0, n), perhaps several at once.
    using Body = std::function<void(std::int64_t, std::int64_t)>;
    std::function<void(std::int64_t n, const Body& body)> for_each =
        [](std::int64_t n, const Body& body) { body(0, n); };
};

}  // namespace vfplan
