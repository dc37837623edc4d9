#include "io/site/vector_reader.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <tuple>

#include "io/site/crs.h"
#include "io/site/roles.h"
#include "io/site/units.h"
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
        std::vector<OGRLayerH> out = {GDALDatasetGetLayerByName(set, "multipolygons")};
        if (options.osm_barriers) out.push_back(GDALDatasetGetLayerByName(set, "lines"));
        return out;
    }
    if (all.size() > 1 && driver != "DXF") {
        throw InputError(fmt::format("{}: {} layers, and site.layer names none; choose one of: {}",
                                     file.string(), count, names));
    }
    return all;
}

std::string text_of(OGRFeatureH feature, const char* field) {
    const int i = OGR_F_GetFieldIndex(feature, field);
    return i >= 0 && OGR_F_IsFieldSetAndNotNull(feature, i) ? OGR_F_GetFieldAsString(feature, i)
                                                            : "";
}

// What a feature is, and whether the file or the user said so.
struct Told {
    std::optional<Role> role;  // none: its shape decides
    bool skip = false;         // it is nothing of ours
    std::string text;          // by which it was told
    const char* why = "shape";
};

// OSM: only what is tagged counts, whatever relation it hangs in.
Told told_by_osm(OGRFeatureH feature, const ReadOptions& options) {
    const std::string building = text_of(feature, "building");
    if (!building.empty() && building != "no") return {Role::building, false, "building", "tag"};
    if (options.osm_parts &&
        text_of(feature, "other_tags").find("\"building:part\"=>") != std::string::npos) {
        return {Role::building, false, "building:part", "tag"};
    }
    if (options.osm_barriers) {
        for (const char* kind : {"wall", "city_wall", "retaining_wall", "fence", "hedge"}) {
            if (text_of(feature, "barrier") == kind) return {Role::wall, false, kind, "tag"};
        }
    }
    return {std::nullopt, true, "no building", "tag"};
}

// The most telling field first: `class`, then outdoors whether it is a building, then type and
// layer.
Told told_by_words(OGRFeatureH feature, const std::string& layer, const ReadOptions& options) {
    constexpr std::array fields = {"class", "Class", "CLASS", "type", "Type", "layer", "Layer"};
    constexpr std::size_t of_class = 3;
    std::vector<std::string> texts;
    for (const char* field : fields) texts.push_back(text_of(feature, field));
    texts.push_back(layer);
    for (const std::string& text : texts) {
        if (text.empty()) continue;
        if (const auto role = role_by_rules(options.roles, text)) {
            return {role, false, text, "site.roles"};
        }
    }
    texts.pop_back();  // what a file's only layer is called tells nothing
    const bool outdoors = options.kind == SiteKind::outdoor;
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (i == of_class && outdoors && OGR_F_GetFieldIndex(feature, "building") >= 0) {
            const std::string building = text_of(feature, "building");
            const bool none = building.empty() || building == "no";
            return {Role::building, none, none ? "no building" : "building", "tag"};
        }
        // A municipality's boundary is no building, whatever shape it has.
        if (outdoors && (texts[i] == "boundary" || texts[i] == "Boundary")) {
            return {std::nullopt, true, texts[i], "word"};
        }
        if (const auto role = role_of_word(texts[i])) return {role, false, texts[i], "word"};
    }
    const auto said =
        std::find_if(texts.begin(), texts.end(), [](const auto& t) { return !t.empty(); });
    return {std::nullopt, false, said == texts.end() ? "" : *said, "shape"};
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
        const auto same = [](char a, char b) {
            return std::tolower(static_cast<unsigned char>(a)) ==
                   std::tolower(static_cast<unsigned char>(b));
        };
        if (!word.empty() && std::search(layer.begin(), layer.end(), word.begin(), word.end(),
                                         same) != layer.end()) {
            return true;
        }
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

// The features of a layer. `told`: by feature, whether its words told its role.
void read_layer(OGRLayerH layer, const std::string& driver, double unit_m,
                const ReadOptions& options, const std::filesystem::path& file, FeatureSet& out,
                std::vector<bool>& told) {
    std::map<std::tuple<std::string, std::string, std::string>, std::int64_t>
        as;  // text, role, why
    if (!options.where.empty() &&
        OGR_L_SetAttributeFilter(layer, options.where.c_str()) != OGRERR_NONE) {
        throw UsageError(fmt::format("site.where = '{}': {}; {} has the fields it can ask for",
                                     options.where, QuietErrors::last(), file.string()));
    }
    OGR_L_ResetReading(layer);
    std::int64_t number = 0;
    while (FeaturePtr f{OGR_L_GetNextFeature(layer)}) {
        Feature feature;
        feature.number = ++number;
        feature.id = text_of(f.get(), "osm_id");
        if (feature.id.empty()) feature.id = text_of(f.get(), "id");
        OGRGeometryH geometry = OGR_F_GetGeometryRef(f.get());
        if (geometry != nullptr) {
            OGRGeometryH linear = OGR_G_GetLinearGeometry(geometry, 0, nullptr);
            collect(linear, unit_m, feature);
            OGR_G_DestroyGeometry(linear);
        }
        const Told what = driver == "OSM" ? told_by_osm(f.get(), options)
                                          : told_by_words(f.get(), OGR_L_GetName(layer), options);
        if (what.skip || (feature.polygons.empty() && feature.lines.empty()) ||
            (driver == "DXF" && !options.layer.empty() && !on_dxf_layer(f.get(), options.layer))) {
            ++out.ignored;
            ++as[{what.text, "left out", what.why}];
            continue;
        }
        feature.role = what.role.value_or(default_role(options.kind, !feature.polygons.empty()));
        ++as[{what.text, std::string(name_of(feature.role)), what.why}];
        told.push_back(what.role.has_value());
        out.features.push_back(std::move(feature));
    }
    for (const auto& [key, count] : as) {
        const auto& [text, role, why] = key;
        out.how.as.push_back({OGR_L_GetName(layer), text, role, why, count});
    }
}

void check_coordinates(const FeatureSet& set, const std::filesystem::path& file) {
    constexpr double farthest_m = 1e8;  // beyond any map of the earth
    for (const Feature& f : set.features) {
        each_point(f, [&](const Vec2d& v) {
            const bool number = std::isfinite(v.x()) && std::isfinite(v.y());
            if (number && v.cwiseAbs().maxCoeff() < farthest_m) return;
            throw InputError(
                fmt::format("{}: feature {}{}{}: a coordinate is no {} ({}, {}); correct or "
                            "remove the feature",
                            file.string(), f.number, f.id.empty() ? "" : ", id ", f.id,
                            number ? "place on earth" : "number", v.x(), v.y()));
        });
    }
}

DeclaredCrs declared_crs(OGRLayerH layer, const std::string& driver) {
    DeclaredCrs out;
    OGRSpatialReferenceH srs = OGR_L_GetSpatialRef(layer);
    out.always_project = driver == "OSM";
    if (srs == nullptr) return out;
    char* text = nullptr;
    OSRExportToWkt(srs, &text);
    if (text != nullptr) out.wkt = text;
    CPLFree(text);
    out.by_default = driver == "GeoJSON" && OSRIsGeographic(srs) != 0;
    return out;
}

}  // namespace

FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options) {
    const QuietErrors quiet;
    const Dataset set = open(file);
    const std::string driver = GDALGetDriverShortName(GDALGetDatasetDriver(set.get()));
    Unit unit;
    if (driver == "DXF") unit = unit_of_dxf(file);
    const double unit_m = options.unit_m > 0 ? options.unit_m : unit.metres;
    FeatureSet out;
    std::vector<bool> told;
    const std::vector<OGRLayerH> layers = choose_layers(set.get(), driver, options, file);
    for (OGRLayerH layer : layers) read_layer(layer, driver, unit_m, options, file, out, told);
    // A drawing with a layer of walls has furniture, fixtures and text on its other layers.
    bool walls_told = false;
    for (std::size_t i = 0; i < told.size(); ++i) {
        walls_told = walls_told || (told[i] && out.features[i].role == Role::wall);
    }
    for (std::size_t i = 0; driver == "DXF" && walls_told && i < told.size(); ++i) {
        if (!told[i]) out.features[i].role = Role::ignored;
    }
    for (ReadAs& as : out.how.as) {
        if (driver == "DXF" && walls_told && as.why == "shape" && as.role != "left out") {
            as.role = "ignored";
            as.why = "other layers have the walls";
        }
    }
    if (CPLGetLastErrorType() >= CE_Failure) {
        throw InputError(fmt::format("{}: {}; the file is damaged, export the site again",
                                     file.string(), QuietErrors::last()));
    }
    out.how.format = driver;
    out.how.unit = options.unit_m > 0   ? fmt::format("{} m (site.unit_m)", options.unit_m)
                   : !unit.said.empty() ? unit.said
                                        : "none said, taken for metres";
    check_coordinates(out, file);
    if (!layers.empty()) settle_crs(out, declared_crs(layers.front(), driver), options, file);
    check_size(out, unit, options, file);
    return out;
}

}  // namespace vfplan
