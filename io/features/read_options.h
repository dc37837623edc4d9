// What is read from a file, and as what.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/features/feature.h"
#include "kernels/names.h"

namespace vfplan {

enum class SiteKind : std::uint8_t { outdoor, indoor };
template <>
struct Names<SiteKind> {
    static constexpr std::array<std::string_view, 2> all = {"outdoor", "indoor"};
};

// Features whose class or layer a pattern matches have this role, whatever their words say.
struct RoleRule {
    std::string pattern;
    Role role = Role::ignored;
    friend bool operator==(const RoleRule&, const RoleRule&) = default;
};

struct ReadOptions {
    SiteKind kind = SiteKind::outdoor;
    // Empty: the only one, or all of a DXF, or the polygons of OSM data. For DXF: parts of layers'
    // names, with commas; case does not matter.
    std::string layer;
    std::string where;            // attribute filter, as SQL has it; empty: all
    std::vector<RoleRule> roles;  // the user's own
    bool osm_parts = false;       // building:part counts as a building
    bool osm_barriers = false;    // walls and fences count as walls
    std::string crs;  // "": as it is; "utm": the zone of the site; else a CRS that PROJ knows
    bool allow_network = false;  // other machines and files may be asked, as a file or crs says
    double unit_m = 0;           // metres per unit of the file; 0: what the file says, else metres
};

}  // namespace vfplan
