#include "io/tables/crs.h"

#include <cstdint>
#include <vector>

namespace vfplan {

void write_crs(h5::Writer& file, const std::string& crs_wkt, const Vec2d& origin) {
    file.write("crs", std::vector<std::int32_t>{0});
    if (!crs_wkt.empty()) {
        file.attribute("crs", "crs_wkt", crs_wkt);
        file.attribute("crs", "spatial_ref", crs_wkt);
    }
    file.attribute("crs", "origin_x_m", origin.x());
    file.attribute("crs", "origin_y_m", origin.y());
}

std::string read_crs(const h5::Reader& file, Vec2d& origin) {
    origin = {file.number("crs", "origin_x_m"), file.number("crs", "origin_y_m")};
    return file.has_attribute("crs", "crs_wkt") ? file.text("crs", "crs_wkt") : "";
}

std::string crs_name(const std::string& crs_wkt) {
    // The code of the whole stands last.
    const std::string label = R"(AUTHORITY["EPSG",")";
    const auto at = crs_wkt.rfind(label);
    if (at == std::string::npos) return "";
    const auto from = at + label.size();
    return "EPSG:" + crs_wkt.substr(from, crs_wkt.find('"', from) - from);
}

}  // namespace vfplan
