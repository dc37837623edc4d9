#include "io/formats/vector_reader.h"

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

#include "io/features/crs.h"
#include "io/features/role_tally.h"
#include "io/features/roles.h"
#include "io/formats/dxf_text.h"
#include "io/formats/json_document.h"
#include "io/formats/osm_text.h"
#include "io/formats/text.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

struct FeatureDestroyer {
    void operator()(OGRFeatureH f) const { OGR_F_Destroy(f); }
};
using FeaturePtr = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, FeatureDestroyer>;

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
    const std::string boundary = text_of(feature, "boundary");
    if (!boundary.empty()) return {std::nullopt, true, "boundary", "tag"};
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
Line points_of(OGRGeometryH g, bool closed) {
    Line line;
    const int n = OGR_G_GetPointCount(g);
    line.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
        line.emplace_back(OGR_G_GetX(g, i), OGR_G_GetY(g, i));
    }
    if (closed && line.size() > 1 && line.front() == line.back()) line.pop_back();
    return line;
}

void collect(OGRGeometryH g, Feature& out) {
    switch (wkbFlatten(OGR_G_GetGeometryType(g))) {
        case wkbPolygon:
        case wkbTriangle: {
            Polygon p;
            for (int i = 0; i < OGR_G_GetGeometryCount(g); ++i) {
                Ring ring = points_of(OGR_G_GetGeometryRef(g, i), true);
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
            Line line = points_of(g, false);
            if (line.size() > 1) out.lines.push_back(std::move(line));
            break;
        }
        default:
            for (int i = 0; i < OGR_G_GetGeometryCount(g); ++i) {
                collect(OGR_G_GetGeometryRef(g, i), out);
            }
    }
}

// The features of a layer. `told`: by feature, whether its words told its role.
void read_layer(OGRLayerH layer, const std::string& driver, const ReadOptions& options,
                const std::filesystem::path& file, FeatureSet& out, std::vector<bool>& told) {
    RoleTally tally;
    if (!options.where.empty() &&
        OGR_L_SetAttributeFilter(layer, options.where.c_str()) != OGRERR_NONE) {
        std::string fields;
        OGRFeatureDefnH defn = OGR_L_GetLayerDefn(layer);
        for (int i = 0; i < OGR_FD_GetFieldCount(defn); ++i) {
            fields +=
                (i > 0 ? ", " : "") + std::string(OGR_Fld_GetNameRef(OGR_FD_GetFieldDefn(defn, i)));
        }
        std::string why = QuietGdal::last();
        if (!why.empty() && why.back() == '.') why.pop_back();
        throw UsageError(
            fmt::format("site.where = \"{}\": {}; {} has the fields {} (texts stand in "
                        "single quotes)",
                        options.where, why, file.string(), fields));
    }
    OGR_L_ResetReading(layer);
    std::int64_t number = 0;
    std::int64_t lost = 0;  // told to be something of ours, but without a shape
    std::string lost_text;
    while (FeaturePtr f{OGR_L_GetNextFeature(layer)}) {
        Feature feature;
        feature.number = ++number;
        feature.id = text_of(f.get(), "osm_id");
        if (feature.id.empty()) feature.id = text_of(f.get(), "id");
        OGRGeometryH geometry = OGR_F_GetGeometryRef(f.get());
        if (geometry != nullptr) {
            OGRGeometryH linear = OGR_G_GetLinearGeometry(geometry, 0, nullptr);
            collect(linear, feature);
            OGR_G_DestroyGeometry(linear);
        }
        const Told what = driver == "OSM" ? told_by_osm(f.get(), options)
                                          : told_by_words(f.get(), OGR_L_GetName(layer), options);
        const bool shapeless = feature.polygons.empty() && feature.lines.empty();
        if (shapeless && what.role && !what.skip && what.role != Role::ignored) {
            ++lost;
            if (lost <= 5) lost_text += fmt::format("{}{}", lost > 1 ? ", " : "", feature.number);
        }
        if (what.skip || shapeless ||
            (driver == "DXF" && !options.layer.empty() && !on_dxf_layer(f.get(), options.layer))) {
            tally.count(what.text, {}, what.why);
            continue;
        }
        feature.role = what.role.value_or(default_role(options.kind, !feature.polygons.empty()));
        tally.count(what.text, feature.role, what.why);
        told.push_back(what.role.has_value());
        out.features.push_back(std::move(feature));
    }
    tally.add_to(out, OGR_L_GetName(layer));
    if (lost > 0) {
        out.warnings.push_back(fmt::format(
            "{} features have no line or polygon that can be read and are left out (number {}{} of "
            "layer {}); are their coordinates whole?",
            lost, lost_text, lost > 5 ? ", ..." : "", OGR_L_GetName(layer)));
    }
}

// A drawing with a layer of walls has furniture, fixtures and text on its other layers.
void leave_out_fixtures(FeatureSet& set, const std::vector<bool>& told) {
    bool walls_told = false;
    for (std::size_t i = 0; i < told.size(); ++i) {
        walls_told = walls_told || (told[i] && set.features[i].role == Role::wall);
    }
    if (!walls_told) return;
    for (std::size_t i = 0; i < told.size(); ++i) {
        if (!told[i]) set.features[i].role = Role::ignored;
    }
    for (ReadAs& as : set.how.as) {
        if (as.why == "shape" && as.role != "left out") {
            as.role = "ignored";
            as.why = "other layers have the walls";
        }
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

bool is_json(const PackedFile& packed) {
    const auto first = packed.head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    return first != std::string::npos && packed.head[first] == '{';
}

// Where in a JSON text the words stand that GDAL complains of, as ":line:column"; empty if nowhere.
std::string place_of(const std::string& why, const PackedFile& packed,
                     const std::filesystem::path& file) {
    const auto from = why.find('\'', why.find(" for ")) + 1;
    const auto to = why.rfind('\'');
    if (!is_json(packed) || from == 0 || to == std::string::npos || to <= from) return "";
    const std::string text = read_text(packed, file);
    const auto at = text.find(why.substr(from, to - from));
    return at == std::string::npos ? "" : fmt::format(":{}", place_in(text, at));
}

}  // namespace

Drawing read_vector(const PackedFile& packed, const std::filesystem::path& file,
                    const ReadOptions& options) {
    use_gdal();
    const QuietGdal quiet;
    // Reading GML would leave a file beside it.
    const bool gml = packed.head.find("opengis.net/gml") != std::string::npos;
    std::unique_ptr<FileInMemory> changed;  // lives longer than the set
    Dataset set = open_vector(packed.name, options.allow_network, gml);
    if (const std::string where = leads_to(packed.head); !options.allow_network && !where.empty()) {
        throw InputError(fmt::format(
            "{}: this is {}; give the file that it leads to, or set site.allow_network = true",
            file.string(), where));
    }
    if (!set) {
        const std::string why = QuietGdal::last();
        if (is_json(packed)) check_json(read_text(packed, file), file);
        throw InputError(
            fmt::format("{}: not a site that can be read{}{}; docs/formats.md has the "
                        "formats: GeoJSON, GeoPackage, Shapefile, OSM, DXF and more",
                        file.string(), why.empty() ? "" : ": ", why));
    }
    const std::string driver = GDALGetDriverShortName(GDALGetDatasetDriver(set.get()));
    Drawing out;
    if (driver == "DXF") {
        out.unit = unit_of_dxf(packed.head);
        const std::string text = read_text(packed, file);
        check_dxf(text, file);
        if (auto drawn = with_splines_drawn(text)) {
            changed = std::make_unique<FileInMemory>(std::move(*drawn));
            set = open_vector(changed->name(), options.allow_network);
        }
    }
    if (driver == "OSM" && packed.head.find("<osm") != std::string::npos) check_osm(packed, file);
    std::vector<bool> told;
    const std::vector<OGRLayerH> layers = choose_layers(set.get(), driver, options, file);
    for (OGRLayerH layer : layers) read_layer(layer, driver, options, file, out.set, told);
    if (driver == "DXF") leave_out_fixtures(out.set, told);
    if (QuietGdal::failed()) {
        const std::string why = QuietGdal::last();
        throw InputError(fmt::format("{}{}: {}; the file is damaged, export the site again",
                                     file.string(), place_of(why, packed, file), why));
    }
    out.set.how.format = driver;
    out.set.how.plan = driver == "DXF";
    out.set.how.layers = true;
    if (!layers.empty()) out.crs = declared_crs(layers.front(), driver);
    return out;
}

}  // namespace vfplan
