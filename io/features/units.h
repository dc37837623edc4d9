// Metres per unit of a drawing: what the file says, and whether the size of what is drawn agrees.
#pragma once

#include <filesystem>
#include <string>

#include "io/features/feature.h"
#include "io/features/read_options.h"

namespace vfplan {

struct Unit {
    double metres = 1;
    std::string said;  // how the file says so, for messages; empty when it says nothing
};

// $INSUNITS in the header of a DXF file in text form, of which `head` is the beginning; metres when
// there is none.
Unit unit_of_dxf(const std::string& head);

// Throws InputError when a floor plan would be larger than 2 km or smaller than 2 m, with the unit
// that would make it a building. A user who set options.unit_m knows.
void check_size(const FeatureSet& set, const Unit& unit, const ReadOptions& options,
                const std::filesystem::path& file);

}  // namespace vfplan
