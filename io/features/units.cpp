#include "io/features/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <vector>

#include "kernels/error.h"
#include "kernels/stray.h"

namespace vfplan {
namespace {

struct Named {
    int insunits;
    const char* name;
    double metres;
};
constexpr std::array<Named, 8> units = {{{1, "inches", 0.0254},
                                         {2, "feet", 0.3048},
                                         {4, "millimetres", 0.001},
                                         {5, "centimetres", 0.01},
                                         {6, "metres", 1},
                                         {10, "yards", 0.9144},
                                         {14, "decimetres", 0.1},
                                         {21, "US survey feet", 1200.0 / 3937}}};

std::string trimmed(const std::string& line) {
    const auto from = line.find_first_not_of(" \t\r");
    if (from == std::string::npos) return "";
    return line.substr(from, line.find_last_not_of(" \t\r") - from + 1);
}

}  // namespace

Unit unit_of_dxf(const std::string& head) {
    std::istringstream in(head);
    std::string line;
    while (std::getline(in, line)) {
        const std::string word = trimmed(line);
        if (word == "ENDSEC" || word == "ENTITIES") break;
        if (word != "$INSUNITS") continue;
        std::string code;
        std::string value;
        if (!std::getline(in, code) || !std::getline(in, value) || trimmed(code) != "70") break;
        const std::string number = trimmed(value);
        for (const Named& u : units) {
            if (number == std::to_string(u.insunits)) {
                return {u.metres, fmt::format("{} ($INSUNITS = {})", u.name, u.insunits)};
            }
        }
        break;  // unitless, or a unit of the stars
    }
    Unit out;
    out.guessed = true;
    return out;
}

void check_size(const FeatureSet& set, const Unit& unit, const ReadOptions& options,
                const std::filesystem::path& file) {
    if (options.kind != SiteKind::indoor || options.unit_m > 0) return;
    std::vector<Box> boxes;
    for (const Feature& f : set.features) {
        if (f.role != Role::ignored) boxes.push_back(bounds(f));
    }
    const Box box = find_strays(boxes, 0).rest;  // one far off says nothing about the unit
    if (box.empty()) return;
    const double size_m = box.size().maxCoeff();
    constexpr double smallest_m = 2;
    const double largest_m = unit.guessed ? 150 : 2000;
    if (!(size_m > 0) || (size_m >= smallest_m && size_m <= largest_m)) return;
    // The units that make a building of it, the commonest first.
    std::string candidates;
    std::string choices;
    const Vec2d in_units = box.size() / unit.metres;
    for (const int insunits : {4, 1, 5, 6, 2}) {
        const Named& u = *std::find_if(units.begin(), units.end(),
                                       [&](const Named& n) { return n.insunits == insunits; });
        const Vec2d size = in_units * u.metres;
        if (size.maxCoeff() < 4 || size.maxCoeff() > 400) continue;
        candidates += fmt::format("{}{} ({:.3g} x {:.3g} m)", candidates.empty() ? "" : ", ",
                                  u.name, size.x(), size.y());
        choices += fmt::format("{}{:g}", choices.empty() ? "" : ", ", u.metres);
    }
    if (candidates.empty() && !unit.guessed) return;  // no unit makes sense of it
    if (candidates.empty()) {
        throw InputError(
            fmt::format("{}: {:.3g} x {:.3g} m for a floor plan, and the file says no "
                        "unit: set site.unit_m to the metres of one",
                        file.string(), box.size().x(), box.size().y()));
    }
    throw InputError(fmt::format(
        "{}: {:.0f} x {:.0f} m for a floor plan{}: are these {}? set site.unit_m = {}, or the unit "
        "that it is drawn in, in metres",
        file.string(), box.size().x(), box.size().y(),
        unit.said.empty() ? "" : ", since the file says " + unit.said, candidates, choices));
}

}  // namespace vfplan
