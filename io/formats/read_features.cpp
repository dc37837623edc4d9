#include "io/formats/read_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <exception>
#include <optional>
#include <set>
#include <string_view>

#include "io/features/reach.h"
#include "io/formats/art_gallery.h"
#include "io/formats/cityjson.h"
#include "io/formats/gdal.h"
#include "io/formats/house_expo.h"
#include "io/formats/office_xml.h"
#include "io/formats/ros_map.h"
#include "io/formats/structured3d.h"
#include "io/formats/sweet_home.h"
#include "io/formats/vector_reader.h"
#include "io/sha256.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

bool holds(const std::string& text, std::string_view word) {
    return text.find(word) != std::string::npos;
}

// What people give that is no site, and what they can do.
struct Stranger {
    std::string_view begins;
    const char* what;
    const char* instead;
};
constexpr std::array<Stranger, 7> strangers = {{
    {"ISO-10303-21", "an IFC or STEP model",
     "cut it at the scanner's height with IfcConvert or another program (docs/formats.md says "
     "how)"},
    {"AC10", "a DWG drawing", "save it as DXF"},
    {"%PDF", "a PDF", "ask for the drawing as DXF, or trace it"},
    {"LASF", "a point cloud", "extract walls or footprints from it first"},
    {"\x89PNG", "an image", "give it with a ROS map's YAML file (docs/formats.md), or trace it"},
    {"P5", "an image", "give the YAML file that goes with it"},
    {"\xFF\xD8\xFF", "an image",
     "give it with a ROS map's YAML file (docs/formats.md), or trace it"},
}};

// JSON that GDAL does not know; nothing where GDAL shall try. GeoJSON is left to GDAL without being
// read whole: it may be a county.
std::optional<Drawing> read_json(const PackedFile& packed, const std::filesystem::path& file,
                                 const ReadOptions& options) {
    if (holds(packed.head, "\"FeatureCollection\"")) return {};
    constexpr std::array ours = {"\"CityObjects\"", "\"CityJSON\"", "\"verts\"", "\"junctions\""};
    const bool hinted = std::any_of(ours.begin(), ours.end(),
                                    [&](const char* key) { return holds(packed.head, key); });
    const std::string text = read_text(packed, file);
    nlohmann::json document;
    try {
        document = parse_json(text, file);
    } catch (const InputError&) {
        if (hinted) throw;
        return {};
    }
    const JsonAt root(document, file);
    try {
        if (root.has("CityObjects")) return read_cityjson(root, options);
        if (root.has("verts")) return read_house_expo(root, options);
        if (root.has("junctions") && root.has("lineJunctionMatrix")) {
            return read_structured3d(root, options);
        }
    } catch (const nlohmann::json::exception& e) {
        throw InputError(
            fmt::format("{}: something in it has another type than its format says "
                        "({}); export the site again",
                        file.string(), e.what()));
    }
    return {};
}

// A reader of ours that knows the content.
std::optional<Drawing> read_ours(const PackedFile& packed, const std::filesystem::path& file,
                                 const ReadOptions& options) {
    const std::string& head = packed.head;
    for (const Stranger& s : strangers) {
        if (head.rfind(s.begins, 0) == 0) {
            throw InputError(
                fmt::format("{}: this is {}, not a site; {}", file.string(), s.what, s.instead));
        }
    }
    const auto first = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first == std::string::npos) return {};
    if (head[first] == '{') return read_json(packed, file, options);
    if (head[first] == '<') {
        const std::string root = root_element(head);
        if (root == "home") {
            return read_sweet_home(XmlDocument(read_text(packed, file), file), options);
        }
        if (root == "building" && holds(head, "<scale>")) {
            return read_office_xml(XmlDocument(read_text(packed, file), file), options);
        }
        return {};
    }
    if (looks_like_art_gallery(head)) {
        return read_art_gallery(read_text(packed, file), file, options);
    }
    if (looks_like_ros_map(head, file)) return read_ros_map(read_text(packed, file), file, options);
    return {};
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

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// Of these formats a file has no others beside it, and opening one with GDAL would read it whole.
bool alone(const std::string& head) {
    const auto first = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    return first != std::string::npos && (head[first] == '{' || head[first] == '[');
}

void check_readable(const std::filesystem::path& path, const std::filesystem::path& input) {
    const bool there =
        is_remote(path) ? can_be_opened(path.string()) : std::filesystem::is_regular_file(path);
    if (there) return;
    throw InputError(
        fmt::format("{}: it leads to {}, which is no file that can be read; a job must "
                    "be able to tell whether its input has changed",
                    input.string(), path.string()));
}

}  // namespace

bool is_remote(const std::filesystem::path& file) {
    std::error_code error;
    return file.string().starts_with("/vsi") && !std::filesystem::exists(file, error);
}

std::vector<std::filesystem::path> input_files(const std::filesystem::path& input,
                                               bool allow_network) {
    const Reach reach(allow_network);
    const PackedFile packed = look_into(input);
    std::set<std::filesystem::path> out;
    const auto add = [&](const std::filesystem::path& path) {
        if (is_remote(path)) {
            out.insert(path);
        } else if (!std::filesystem::is_directory(path)) {
            out.insert(std::filesystem::absolute(path).lexically_normal());
        }
    };
    add(input);
    if (std::filesystem::is_directory(input) && lower(input.extension().string()) == ".gdb") {
        for (const auto& e : std::filesystem::recursive_directory_iterator(input)) {
            if (e.is_regular_file()) add(e.path());
        }
    } else if (looks_like_ros_map(packed.head, input)) {
        add(ros_image(packed.head, input));
    } else if (packed.name == input.string() && !alone(packed.head)) {
        for (const std::string& name : files_of(packed.name, allow_network)) add(name);
    }
    if (Reach::asked_a_service()) {
        throw InputError(
            fmt::format("{}: a service answers for it, and a job must be able to tell whether its "
                        "input has changed; save what it answers as a file (ogr2ogr) and give that",
                        input.string()));
    }
    for (const std::filesystem::path& path : out) check_readable(path, input);
    return {out.begin(), out.end()};
}

std::string input_sha256(const std::vector<std::filesystem::path>& files) {
    const Reach reach(true);  // of what was allowed when the files were listed
    std::string hashes;
    for (const std::filesystem::path& file : files) {
        if (!is_remote(file)) {
            hashes += sha256_of_file(file);
            continue;
        }
        Sha256 content;
        each_part({file.string(), ""}, file,
                  [&](std::string_view part) { content.add(part.data(), part.size()); });
        hashes += content.hex();
    }
    return files.size() == 1 ? hashes : sha256_of(hashes);
}

namespace {

FeatureSet read_set(const std::filesystem::path& file, const ReadOptions& options) {
    const PackedFile packed = look_into(file);
    std::optional<Drawing> ours = read_ours(packed, file, options);
    if (ours && !options.where.empty()) {
        throw UsageError(
            fmt::format("site.where = '{}': {} is {}, whose features have no "
                        "attributes to ask for; leave it out, or use site.roles",
                        options.where, file.string(), ours->set.how.format));
    }
    if (ours && !options.layer.empty() && !ours->set.how.layers) {
        throw InputError(fmt::format("{}: no layer '{}'; {} has no layers, leave site.layer out",
                                     file.string(), options.layer, ours->set.how.format));
    }
    Drawing drawing = ours ? std::move(*ours) : read_vector(packed, file, options);
    FeatureSet& set = drawing.set;
    const double unit_m = options.unit_m > 0 ? options.unit_m : drawing.unit.metres;
    if (unit_m != 1) {
        for (Feature& f : set.features) each_point(f, [&](Vec2d& v) { v *= unit_m; });
    }
    set.how.unit = options.unit_m > 0           ? fmt::format("{} m (site.unit_m)", options.unit_m)
                   : !drawing.unit.said.empty() ? drawing.unit.said
                                                : "none said, taken for metres";
    check_coordinates(set, file);
    settle_crs(set, drawing.crs, options, file);
    if (drawing.unit.said.empty() && options.unit_m <= 0 && !set.crs_wkt.empty()) {
        const bool projected = set.from_degrees || (!options.crs.empty() && drawing.crs.wkt != "");
        set.how.unit = set.from_degrees ? "degrees, projected to metres"
                       : projected      ? "as the file's CRS says, projected to metres"
                                        : "metres, by the CRS";
    }
    check_size(set, drawing.unit, options, file);
    return std::move(drawing.set);
}

}  // namespace

FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options) {
    const QuietGdal quiet;
    const Reach reach(options.allow_network);
    std::exception_ptr why;
    FeatureSet out;
    try {
        out = read_set(file, options);
    } catch (const Error&) {
        why = std::current_exception();
    }
    // Whatever came of it, nobody said that the network may be asked.
    if (!Reach::refused().empty()) {
        throw InputError(
            fmt::format("{}: it leads to {}, and nothing is fetched from the network; give a file "
                        "that has all in it, or set site.allow_network = true",
                        file.string(), Reach::refused()));
    }
    if (why) std::rethrow_exception(why);
    return out;
}

}  // namespace vfplan
