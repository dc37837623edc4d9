#include "io/site/vector_reader.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>

#include "kernels/error.h"

namespace vfplan {
namespace {

// GDAL's words about its own failures, for our messages; nothing is printed behind our back.
class QuietErrors {
public:
    QuietErrors() {
        CPLErrorReset();
        CPLPushErrorHandler(CPLQuietErrorHandler);
    }
    ~QuietErrors() { CPLPopErrorHandler(); }
    QuietErrors(const QuietErrors&) = delete;
    QuietErrors& operator=(const QuietErrors&) = delete;
    static std::string last() { return CPLGetLastErrorMsg(); }
};

struct DatasetCloser {
    void operator()(GDALDatasetH d) const { GDALClose(d); }
};
using Dataset = std::unique_ptr<void, DatasetCloser>;

struct FeatureDestroyer {
    void operator()(OGRFeatureH f) const { OGR_F_Destroy(f); }
};
using FeaturePtr = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, FeatureDestroyer>;

struct SrsReleaser {
    void operator()(OGRSpatialReferenceH s) const { OSRRelease(s); }
};
using Srs = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, SrsReleaser>;

struct TransformDestroyer {
    void operator()(OGRCoordinateTransformationH t) const { OCTDestroyCoordinateTransformation(t); }
};
using Transform =
    std::unique_ptr<std::remove_pointer_t<OGRCoordinateTransformationH>, TransformDestroyer>;

Dataset open(const std::filesystem::path& file) {
    static std::once_flag registered;
    std::call_once(registered, [] {
        GDALAllRegister();
        CPLSetConfigOption("OSM_USE_CUSTOM_INDEXING", "NO");  // it refuses negative ids
    });
    if (!std::filesystem::exists(file)) {
        throw IoError(
            fmt::format("{}: no such file; check site.input (it is relative to the job "
                        "file)",
                        file.string()));
    }
    if (std::filesystem::is_regular_file(file) && std::filesystem::file_size(file) == 0) {
        throw InputError(
            fmt::format("{}: the file is empty; export the site again", file.string()));
    }
    std::string name = file.string();
    if (file.extension() == ".gz") name = "/vsigzip/" + name;
    Dataset set(
        GDALOpenEx(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
    if (!set) {
        const std::string why = QuietErrors::last();
        throw InputError(
            fmt::format("{}: not vector data that can be read{}{}; give GeoJSON, "
                        "GeoPackage, Shapefile, OSM or DXF",
                        file.string(), why.empty() ? "" : ": ", why));
    }
    return set;
}

std::vector<OGRLayerH> choose_layers(GDALDatasetH set, const std::string& driver,
                                     const ReadOptions& options,
                                     const std::filesystem::path& file) {
    const int count = GDALDatasetGetLayerCount(set);
    std::string names;
    std::vector<OGRLayerH> all;
    for (int i = 0; i < count; ++i) {
        OGRLayerH layer = GDALDatasetGetLayer(set, i);
        all.push_back(layer);
        names += (i > 0 ? ", " : "") + std::string(OGR_L_GetName(layer));
    }
    if (!options.layer.empty() && driver != "DXF") {
        OGRLayerH layer = GDALDatasetGetLayerByName(set, options.layer.c_str());
        if (layer == nullptr) {
            throw InputError(fmt::format("{}: no layer '{}'; the file has: {}", file.string(),
                                         options.layer, names));
        }
        return {layer};
    }
    if (driver == "OSM") {
        return {GDALDatasetGetLayerByName(set, "multipolygons")};
    }
    if (all.size() > 1 && driver != "DXF") {
        throw InputError(fmt::format("{}: {} layers, and site.layer names none; choose one of: {}",
                                     file.string(), count, names));
    }
    return all;
}

// The role that a feature's words tell, the most telling first; empty when they say nothing.
std::optional<Role> role_of(OGRFeatureH feature, bool& skip) {
    for (const char* field : {"class", "Class", "CLASS", "type", "Type", "layer", "Layer"}) {
        const int i = OGR_F_GetFieldIndex(feature, field);
        if (i < 0 || !OGR_F_IsFieldSetAndNotNull(feature, i)) continue;
        if (const auto role = role_of_word(OGR_F_GetFieldAsString(feature, i))) return role;
    }
    // OSM: a polygon is a building only when it says so.
    const int building = OGR_F_GetFieldIndex(feature, "building");
    if (building >= 0) {
        const std::string value = OGR_F_IsFieldSetAndNotNull(feature, building)
                                      ? OGR_F_GetFieldAsString(feature, building)
                                      : "";
        if (value.empty() || value == "no") skip = true;
        return Role::building;
    }
    return std::nullopt;
}

// DXF drawings are one layer to GDAL; their own layers are a field. True when its name contains
// one of the words in `wanted`, which are parted by commas.
bool on_dxf_layer(OGRFeatureH feature, const std::string& wanted) {
    const int field = OGR_F_GetFieldIndex(feature, "Layer");
    const std::string layer = field < 0 ? "" : OGR_F_GetFieldAsString(feature, field);
    std::istringstream words(wanted);
    for (std::string word; std::getline(words, word, ',');) {
        word.erase(0, word.find_first_not_of(' '));
        word.erase(word.find_last_not_of(' ') + 1);
        if (!word.empty() && layer.find(word) != std::string::npos) return true;
    }
    return false;
}

// Appends a ring or line; `closed` drops the repeated last point.
Line points_of(OGRGeometryH g, bool closed, double unit_m) {
    Line line;
    const int n = OGR_G_GetPointCount(g);
    line.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        line.emplace_back(OGR_G_GetX(g, i) * unit_m, OGR_G_GetY(g, i) * unit_m);
    }
    if (closed && line.size() > 1 && line.front() == line.back()) line.pop_back();
    return line;
}

void collect(OGRGeometryH g, double unit_m, Feature& out) {
    switch (wkbFlatten(OGR_G_GetGeometryType(g))) {
        case wkbPolygon:
        case wkbTriangle: {
            Polygon p;
            for (int i = 0; i < OGR_G_GetGeometryCount(g); ++i) {
                Ring ring = points_of(OGR_G_GetGeometryRef(g, i), true, unit_m);
                if (i == 0) {
                    p.outer = std::move(ring);
                } else {
                    p.holes.push_back(std::move(ring));
                }
            }
            if (!p.outer.empty()) out.polygons.push_back(std::move(p));
            break;
        }
        case wkbLineString: {
            Line line = points_of(g, false, unit_m);
            if (line.size() > 1) out.lines.push_back(std::move(line));
            break;
        }
        default:
            for (int i = 0; i < OGR_G_GetGeometryCount(g); ++i) {
                collect(OGR_G_GetGeometryRef(g, i), unit_m, out);
            }
    }
}

template <class F>
void each_point(FeatureSet& set, F&& f) {
    for (Feature& feature : set.features) {
        each_point(feature, [&](Vec2d& v) { f(feature, v); });
    }
}

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
bool looks_like_degrees(FeatureSet& set) {
    bool in_range = true;
    each_point(set, [&](const Feature&, const Vec2d& v) {
        in_range = in_range && std::abs(v.x()) <= 180 && std::abs(v.y()) <= 90;
    });
    const double edge = longest_edge(set);
    return in_range && edge > 0 && edge < 0.03;
}

Srs make_srs(const std::string& definition) {
    Srs srs(OSRNewSpatialReference(nullptr));
    if (OSRSetFromUserInput(srs.get(), definition.c_str()) != OGRERR_NONE) {
        throw UsageError(
            fmt::format("site.crs = \"{}\": no coordinate reference system of that "
                        "name; give \"utm\" or an EPSG code such as \"EPSG:32617\"",
                        definition));
    }
    OSRSetAxisMappingStrategy(srs.get(), OAMS_TRADITIONAL_GIS_ORDER);
    return srs;
}

std::string utm_zone_of(FeatureSet& set) {
    Box box;
    each_point(set, [&](const Feature&, const Vec2d& v) { box.add(v); });
    const Vec2d middle = (box.min + box.max) / 2;
    const int zone = std::clamp(static_cast<int>(std::floor((middle.x() + 180) / 6)) + 1, 1, 60);
    return fmt::format("EPSG:{}", (middle.y() >= 0 ? 32600 : 32700) + zone);
}

std::string wkt_of(OGRSpatialReferenceH srs) {
    char* text = nullptr;
    OSRExportToWkt(srs, &text);
    std::string wkt = text == nullptr ? "" : text;
    CPLFree(text);
    return wkt;
}

void project(FeatureSet& set, OGRSpatialReferenceH from, const std::string& definition) {
    const Srs to = make_srs(definition);
    const Transform transform(OCTNewCoordinateTransformation(from, to.get()));
    if (!transform) {
        throw InputError(
            fmt::format("cannot project the site to {}: {}", definition, QuietErrors::last()));
    }
    each_point(set, [&](const Feature& f, Vec2d& v) {
        double x = v.x();
        double y = v.y();
        if (OCTTransform(transform.get(), 1, &x, &y, nullptr) == 0 || !std::isfinite(x)) {
            throw InputError(
                fmt::format("feature {}: ({}, {}) cannot be projected to {}; choose "
                            "another site.crs",
                            f.number, v.x(), v.y(), definition));
        }
        v = {x, y};
    });
    set.crs_wkt = wkt_of(to.get());
}

void settle_crs(FeatureSet& set, OGRSpatialReferenceH srs, const std::string& driver,
                const ReadOptions& options, const std::filesystem::path& file) {
    Srs source(srs == nullptr ? nullptr : OSRClone(srs));
    if (source) OSRSetAxisMappingStrategy(source.get(), OAMS_TRADITIONAL_GIS_ORDER);
    const bool degrees = looks_like_degrees(set);
    // GeoJSON without a crs member counts as WGS 84 by its standard; files in plain metres are
    // common all the same, and their edges tell.
    if (driver == "GeoJSON" && source && OSRIsGeographic(source.get()) != 0 && !degrees) {
        source.reset();
    }
    if (!source && degrees) source = make_srs("EPSG:4326");
    const bool geographic = source && OSRIsGeographic(source.get()) != 0;
    if (!options.crs.empty() || driver == "OSM") {
        const std::string wanted = options.crs.empty() ? "utm" : options.crs;
        if (!source) {
            throw InputError(
                fmt::format("{}: site.crs asks for {}, but the file does not say what "
                            "its coordinates are; leave site.crs out if they are "
                            "metres",
                            file.string(), wanted));
        }
        if (geographic) {
            project(set, source.get(), wanted == "utm" ? utm_zone_of(set) : wanted);
            return;
        }
        if (wanted != "utm") {
            project(set, source.get(), wanted);
            return;
        }
        const Srs wgs84 = make_srs("EPSG:4326");
        project(set, source.get(), "EPSG:4326");
        project(set, wgs84.get(), utm_zone_of(set));
        return;
    }
    if (geographic) {
        throw InputError(
            fmt::format("{}: coordinates are in degrees, but walls and ranges are in "
                        "metres; set site.crs = \"utm\" to have them projected",
                        file.string()));
    }
    if (!source) return;
    if (OSRIsProjected(source.get()) != 0) {
        char* unit = nullptr;
        const double metres = OSRGetLinearUnits(source.get(), &unit);
        if (std::abs(metres - 1) > 1e-6) {
            throw InputError(
                fmt::format("{}: coordinates are in {} of {} m, not in metres; set "
                            "site.crs = \"utm\" to have them projected",
                            file.string(), unit, metres));
        }
        const char* code = OSRGetAuthorityCode(source.get(), nullptr);
        if (code != nullptr && std::string(code) == "3857") {
            set.warnings.emplace_back(
                "EPSG:3857 stretches lengths away from the equator; set site.crs = \"utm\" for "
                "true metres");
        }
    }
    set.crs_wkt = wkt_of(source.get());
}

}  // namespace

FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options) {
    const QuietErrors quiet;
    const Dataset set = open(file);
    const std::string driver = GDALGetDriverShortName(GDALGetDatasetDriver(set.get()));
    FeatureSet out;
    std::vector<bool> told;  // by feature: whether its words told its role
    OGRSpatialReferenceH srs = nullptr;
    for (OGRLayerH layer : choose_layers(set.get(), driver, options, file)) {
        if (srs == nullptr) srs = OGR_L_GetSpatialRef(layer);
        OGR_L_ResetReading(layer);
        std::int64_t number = 0;
        while (FeaturePtr f{OGR_L_GetNextFeature(layer)}) {
            Feature feature;
            feature.number = ++number;
            const int id = std::max(OGR_F_GetFieldIndex(f.get(), "osm_id"),
                                    OGR_F_GetFieldIndex(f.get(), "id"));
            if (id >= 0) feature.id = OGR_F_GetFieldAsString(f.get(), id);
            OGRGeometryH geometry = OGR_F_GetGeometryRef(f.get());
            if (geometry != nullptr) {
                OGRGeometryH linear = OGR_G_GetLinearGeometry(geometry, 0, nullptr);
                collect(linear, options.unit_m, feature);
                OGR_G_DestroyGeometry(linear);
            }
            bool skip = feature.polygons.empty() && feature.lines.empty();
            const std::optional<Role> role = role_of(f.get(), skip);
            if (driver == "DXF" && !options.layer.empty()) {
                skip = skip || !on_dxf_layer(f.get(), options.layer);
            }
            if (skip) {
                ++out.ignored;
                continue;
            }
            feature.role = role.value_or(default_role(options.kind, !feature.polygons.empty()));
            told.push_back(role.has_value());
            out.features.push_back(std::move(feature));
        }
    }
    // A drawing with a layer of walls has furniture, fixtures and text on its other layers.
    if (driver == "DXF" && std::find(told.begin(), told.end(), true) != told.end()) {
        for (std::size_t i = 0; i < told.size(); ++i) {
            if (!told[i]) out.features[i].role = Role::drawing;
        }
    }
    if (CPLGetLastErrorType() >= CE_Failure) {
        throw InputError(fmt::format("{}: {}; the file is damaged, export the site again",
                                     file.string(), QuietErrors::last()));
    }
    each_point(out, [&](const Feature& f, const Vec2d& v) {
        constexpr double farthest_m = 1e8;  // beyond any map of the earth
        const bool number = std::isfinite(v.x()) && std::isfinite(v.y());
        if (number && v.cwiseAbs().maxCoeff() < farthest_m) return;
        throw InputError(
            fmt::format("{}: feature {}{}{}: a coordinate is no {} ({}, {}); correct or "
                        "remove the feature",
                        file.string(), f.number, f.id.empty() ? "" : ", id ", f.id,
                        number ? "place on earth" : "number", v.x(), v.y()));
    });
    settle_crs(out, srs, driver, options, file);
    return out;
}

}  // namespace vfplan
