// The figures by which plans are compared.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace vfplan {

// What a plan's summary.json says; NaN where it says nothing.
struct PlanFigures {
    double stations = 0;
    double stations_connected = 0;  // before loops
    double bound = 0;               // on the stations, with or without loops as the plan has them
    double gap = 0;                 // share of the stations
    double covered = 0;             // share of the length that any candidate covers
    double in_main = 0;             // share of the length that the largest network covers
    double networks = 0;
    double links = 0;
    double bridges = 0;
    double articulation_stations = 0;
    double off_cycle = 0;  // stations on no cycle
    double too_near = 0;   // stations
    double wapl = 0;
    double bottleneck_overlap = 0;
    double wall_s = 0;
};

struct FigureColumn {
    const char* name;   // in CSV
    const char* title;  // for people; empty: not shown
    double PlanFigures::*value;
    std::int32_t decimals = 0;  // for people
    bool percent = false;
};

// In the order of tables.
std::span<const FigureColumn> figure_columns();

// For people: "-" where it is not known.
std::string text_of(const FigureColumn& column, const PlanFigures& figures);

PlanFigures figures_of(const nlohmann::ordered_json& summary);

}  // namespace vfplan
