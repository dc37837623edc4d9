// Plans side by side: one table and a picture (docs/planning.md, "Plans side by side").
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "engine/compare/figures.h"

namespace vfplan {

struct Comparison {
    std::vector<std::string> names;  // of the plans
    std::vector<PlanFigures> plans;
    // Parameters in which their jobs differ, but output.*: key, and the value of each plan.
    std::vector<std::pair<std::string, std::vector<std::string>>> differences;
};

// Of run directories, in their order; a name is the folder's, or its path where two have one name.
// Throws UsageError where one holds no plan, IoError where one cannot be read.
Comparison compare(const std::vector<std::filesystem::path>& dirs);

// For people, a line a plan. `parameters`: with the values that differ.
std::string text_of(const Comparison& comparison, bool parameters);
// With a header line, RFC 4180; values that differ and every figure in full.
std::string csv_of(const Comparison& comparison);
// PNG. Throws as bars_png().
std::string picture_of(const Comparison& comparison);

}  // namespace vfplan
