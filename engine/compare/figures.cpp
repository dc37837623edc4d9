#include "engine/compare/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double number(const Json& j, const char* key) {
    const auto found = j.find(key);
    return found != j.end() && found->is_number() ? found->get<double>() : unknown;
}

using F = PlanFigures;
constexpr std::array<FigureColumn, 15> columns = {{
    {"stations", "stations", &F::stations},
    {"stations_connected", "before loops", &F::stations_connected},
    {"bound", "at least", &F::bound},
    {"gap", "gap", &F::gap, 1, true},
    {"covered", "covered", &F::covered, 2, true},
    {"in_main", "in main", &F::in_main, 2, true},
    {"networks", "networks", &F::networks},
    {"links", "links", &F::links},
    {"bridges", "bridges", &F::bridges},
    {"articulation_stations", "", &F::articulation_stations},
    {"off_cycle", "off cycle", &F::off_cycle},
    {"too_near", "too near", &F::too_near},
    {"wapl", "WAPL", &F::wapl, 2},
    {"bottleneck_overlap", "", &F::bottleneck_overlap, 3},
    {"wall_s", "", &F::wall_s, 1},
}};

}  // namespace

std::span<const FigureColumn> figure_columns() { return columns; }

std::string text_of(const FigureColumn& column, const PlanFigures& figures) {
    const double v = figures.*column.value;
    if (std::isnan(v)) return "-";
    return column.percent ? fmt::format("{:.{}f} %", 100 * v, column.decimals)
                          : fmt::format("{:.{}f}", v, column.decimals);
}

PlanFigures figures_of(const Json& s) {
    const Json plan = s.value("plan", Json::object());
    PlanFigures f;
    f.stations = number(s, "stations");
    f.stations_connected = number(s, "stations_connected");
    f.bound = number(s, "lower_bound");
    f.gap = number(s, "gap");
    f.covered = number(s, "length_covered_m") / number(s, "length_coverable_m");
    double main_m = 0;
    for (const Json& network : s.value("network_list", Json::array())) {
        main_m = std::max(main_m, number(network, "length_m"));
    }
    f.in_main = main_m / number(s, "length_m");
    f.networks = number(s, "networks");
    f.links = number(s, "links");
    f.bridges = number(s, "bridges");
    f.articulation_stations = number(s, "articulation_stations");
    f.off_cycle = number(plan, "off_cycle");
    f.too_near = number(plan, "too_near");
    f.wapl = number(s, "wapl");
    f.bottleneck_overlap = number(s, "bottleneck_overlap");
    f.wall_s = number(s, "wall_s");
    return f;
}

}  // namespace vfplan
