#include "io/features/crs.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "io/features/reach.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

struct SrsReleaser {
    void operator()(OGRSpatialReferenceH s) const { OSRRelease(s); }
};
using Srs = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, SrsReleaser>;

struct TransformDestroyer {
    void operator()(OGRCoordinateTransformationH t) const { OCTDestroyCoordinateTransformation(t); }
};

double longest_edge(const FeatureSet& set) {
    double longest = 0;
    const auto add = [&](const Line& line) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            longest = std::max(longest, (line[i] - line[i - 1]).norm());
        }
    };
    for (const Feature& f : set.features) {
        for (const Polygon& p : f.polygons) add(p.outer);
        for (const Line& line : f.lines) add(line);
    }
    return longest;
}

// Numbers that can be longitudes and latitudes, with no edge that would be longer than 3 cm if
// they were metres.
bool looks_like_degrees(const FeatureSet& set) {
    const Box box = bounds(set);
    const double edge = longest_edge(set);
    return !box.empty() && box.min.x() >= -180 && box.max.x() <= 180 && box.min.y() >= -90 &&
           box.max.y() <= 90 && edge > 0 && edge < 0.03;
}

// What GDAL makes of a name or a definition. `anywhere`: it may stand in a file or on the network.
bool understood(OGRSpatialReferenceH srs, const std::string& definition, bool anywhere) {
    close_the_network();
    CPLErrorReset();
    return OGRSpatialReference::FromHandle(srs)->SetFromUserInput(
               definition.c_str(),
               anywhere ? nullptr : OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) ==
           OGRERR_NONE;
}

Srs made(const std::string& definition, bool anywhere = false) {
    Srs srs(OSRNewSpatialReference(nullptr));
    if (!understood(srs.get(), definition, anywhere)) {
        if (std::strstr(CPLGetLastErrorMsg(), "ALLOW_") != nullptr) {
            throw UsageError(fmt::format(
                "site.crs = \"{}\": the name of a file or an address, and none is opened "
                "for a definition; give \"utm\" or an EPSG code such as "
                "\"EPSG:32617\", or set site.allow_network = true",
                definition));
        }
        throw UsageError(
            fmt::format("site.crs = \"{}\": no coordinate reference system of that "
                        "name; give \"utm\" or an EPSG code such as \"EPSG:32617\"",
                        definition));
    }
    OSRSetAxisMappingStrategy(srs.get(), OAMS_TRADITIONAL_GIS_ORDER);
    return srs;
}

double metres_of_unit(OGRSpatialReferenceH srs, std::string& unit) {
    char* name = nullptr;
    const double metres = OSRGetLinearUnits(srs, &name);
    unit = name == nullptr ? "" : name;
    return metres;
}

// What the user asks for: walls and ranges are in metres, so degrees and feet are no help.
Srs wanted_in_metres(const std::string& definition, bool anywhere) {
    Srs srs = made(definition, anywhere);
    std::string unit;
    if (OSRIsGeographic(srs.get()) != 0) {
        throw UsageError(fmt::format(
            "site.crs = \"{}\": it is in degrees, but walls and ranges are in metres; give \"utm\" "
            "or a projected one such as \"EPSG:32617\"",
            definition));
    }
    if (std::abs(metres_of_unit(srs.get(), unit) - 1) > 1e-6) {
        throw UsageError(
            fmt::format("site.crs = \"{}\": it is in {}, but walls and ranges are in metres; give "
                        "\"utm\" or one in metres",
                        definition, unit));
    }
    return srs;
}

std::string wkt_of(OGRSpatialReferenceH srs) {
    char* text = nullptr;
    OSRExportToWkt(srs, &text);
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

std::string utm_zone_of(const Vec2d& degrees) {
    const int zone = std::clamp(static_cast<int>(std::floor((degrees.x() + 180) / 6)) + 1, 1, 60);
    return fmt::format("EPSG:{}", (degrees.y() >= 0 ? 32600 : 32700) + zone);
}

// A way from one frame to another that can be kept; not thread-safe.
std::function<Vec2d(const Vec2d&)> way(OGRSpatialReferenceH from, OGRSpatialReferenceH to) {
    const std::shared_ptr<void> transform(OCTNewCoordinateTransformation(from, to),
                                          TransformDestroyer());
    if (!transform) return {};
    return [transform](const Vec2d& p) {
        double x = p.x();
        double y = p.y();
        if (OCTTransform(transform.get(), 1, &x, &y, nullptr) == 0) x = y = std::nan("");
        return Vec2d(x, y);
    };
}

void project(FeatureSet& set, OGRSpatialReferenceH from, const std::string& definition,
             bool anywhere, const std::filesystem::path& file) {
    const Srs to = wanted_in_metres(definition, anywhere);
    const auto projected = way(from, to.get());
    if (!projected) {
        throw InputError(fmt::format("{}: cannot be projected to {}: {}", file.string(), definition,
                                     CPLGetLastErrorMsg()));
    }
    for (Feature& f : set.features) {
        each_point(f, [&](Vec2d& v) {
            const Vec2d p = projected(v);
            if (!std::isfinite(p.x()) || !std::isfinite(p.y())) {
                throw InputError(fmt::format(
                    "{}: feature {}: ({}, {}) cannot be projected to {}; choose another site.crs",
                    file.string(), f.number, v.x(), v.y(), definition));
            }
            v = p;
        });
    }
    set.crs_wkt = wkt_of(to.get());
    if (OSRIsGeographic(from) != 0) set.from_degrees = projected;
}

// The zone of a set whose coordinates are in `source`.
std::string utm_of(const FeatureSet& set, OGRSpatialReferenceH source) {
    const Box box = bounds(set);
    Vec2d middle = (box.min + box.max) / 2;
    if (OSRIsGeographic(source) == 0) {
        const Srs wgs84 = made("EPSG:4326");
        if (const auto to_degrees = way(source, wgs84.get())) middle = to_degrees(middle);
    }
    return utm_zone_of(middle);
}

void check_metres(FeatureSet& set, OGRSpatialReferenceH source, const std::filesystem::path& file) {
    if (OSRIsProjected(source) == 0) return;
    std::string unit;
    const double metres = metres_of_unit(source, unit);
    if (std::abs(metres - 1) > 1e-6) {
        throw InputError(
            fmt::format("{}: coordinates are in {} of {} m, not in metres; set "
                        "site.crs = \"utm\" to have them projected",
                        file.string(), unit, metres));
    }
    const char* code = OSRGetAuthorityCode(source, nullptr);
    if (code != nullptr && std::string(code) == "3857") {
        set.warnings.emplace_back(
            "EPSG:3857 stretches lengths away from the equator; set site.crs = \"utm\" for "
            "true metres");
    }
}

}  // namespace

void settle_crs(FeatureSet& set, const DeclaredCrs& declared, const ReadOptions& options,
                const std::filesystem::path& file) {
    Srs source;
    if (!declared.wkt.empty()) source = made(declared.wkt);
    const bool degrees = looks_like_degrees(set);
    // GeoJSON without a crs member counts as WGS 84 by its standard; files in plain metres are
    // common all the same, and their edges tell.
    if (declared.by_default && !degrees) source.reset();
    if (!source && degrees) source = made("EPSG:4326");
    const std::string wanted = options.crs.empty() && declared.always_project ? "utm" : options.crs;
    if (!wanted.empty()) {
        if (source) {
            project(set, source.get(), wanted == "utm" ? utm_of(set, source.get()) : wanted,
                    options.allow_network, file);
            return;
        }
        if (wanted == "utm") {
            throw InputError(fmt::format(
                "{}: site.crs = \"utm\" projects, but the file does not say where its "
                "coordinates are, and they are no degrees; leave site.crs out, or name the "
                "one that they are in",
                file.string()));
        }
        source = wanted_in_metres(wanted, options.allow_network);  // the user knows
    }
    if (!source) return;
    if (OSRIsGeographic(source.get()) != 0) {
        throw InputError(
            fmt::format("{}: coordinates are in degrees, but walls and ranges are in "
                        "metres; set site.crs = \"utm\" to have them projected",
                        file.string()));
    }
    check_metres(set, source.get(), file);
    set.crs_wkt = wkt_of(source.get());
}

std::string wkt_of_code(const std::string& code) {
    const Srs srs(OSRNewSpatialReference(nullptr));
    if (code.empty() || !understood(srs.get(), code, false)) return "";
    if (OSRIsCompound(srs.get()) != 0) OSRStripVertical(srs.get());
    return wkt_of(srs.get());
}

std::function<Vec2d(const Vec2d&)> to_degrees(const std::string& wkt) {
    if (wkt.empty()) return {};
    const Srs from(OSRNewSpatialReference(nullptr));
    if (!understood(from.get(), wkt, false)) return {};
    OSRSetAxisMappingStrategy(from.get(), OAMS_TRADITIONAL_GIS_ORDER);
    const Srs wgs84 = made("EPSG:4326");
    return way(from.get(), wgs84.get());
}

}  // namespace vfplan
