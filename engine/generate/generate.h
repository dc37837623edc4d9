// Synthetic sites with stated statistics, so that the program can show itself without data.
#pragma once

#include <cstdint>
#include <string>

namespace vfplan {

struct GenerateOptions {
    std::string kind;  // town | city | flat
    std::uint64_t seed = 1;
    double size_km = 2;  // city only: side length of the square
    int rooms = 6;       // flat only
};

// The statistics that a generated site states about itself; measured from what was generated.
struct GenerateReport {
    std::string geojson;  // one FeatureCollection, one feature a line, metres, see docs/file_format
    std::string summary;  // for people: counts, areas, and for a town its five crops
};

// town: the paper's town (appendix "Time and Space Complexity"): 637 buildings, 976 x 893 m,
//       80,549 m2 built; cropped to 520x292, 965x366, 976x441, 976x588, 976x893 m from the
//       south-west corner it holds 132, 274, 379, 529, 637 buildings of 22,059, 39,359, 49,428,
//       67,448, 80,549 m2.
// city: blocks, streets and towers over size_km x size_km.
// flat: an apartment of `rooms` rooms, indoor: walls, doors, windows and named rooms.
// Equal options give equal bytes on every machine. Throws UsageError for an unknown kind or a
// size out of range.
GenerateReport generate_site(const GenerateOptions& options);

}  // namespace vfplan
