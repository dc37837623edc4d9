#include "io/formats/ros_map.h"

#include <fmt/format.h>
#include <potracelib.h>
#include <yaml-cpp/yaml.h>

#include <climits>
#include <cmath>
#include <functional>
#include <memory>

#include "io/features/role_tally.h"
#include "io/formats/gdal.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

struct StateFreer {
    void operator()(potrace_state_t* s) const { potrace_state_free(s); }
};
struct ParamFreer {
    void operator()(potrace_param_t* p) const { potrace_param_free(p); }
};

constexpr int speck_pixels = 2;

// The pixels that are `wanted`, as polygons in pixels, y upwards from the lower left corner.
std::vector<Polygon> traced(const GreyImage& image, const std::function<bool(int)>& wanted,
                            std::int64_t& specks) {
    constexpr int bits = CHAR_BIT * static_cast<int>(sizeof(potrace_word));
    potrace_bitmap_t map;
    map.w = image.width;
    map.h = image.height;
    map.dy = (image.width + bits - 1) / bits;
    std::vector<potrace_word> words(idx(map.dy) * idx(map.h), 0);
    map.map = words.data();
    for (int y = 0; y < image.height; ++y) {
        const std::size_t from_below = idx(image.height - 1 - y) * idx(map.dy);
        for (int x = 0; x < image.width; ++x) {
            if (!wanted(image.pixels[idx(y) * idx(image.width) + idx(x)])) continue;
            words[from_below + idx(x / bits)] |= potrace_word{1} << (bits - 1 - x % bits);
        }
    }
    const std::unique_ptr<potrace_param_t, ParamFreer> param(potrace_param_default());
    param->turdsize = 0;
    param->alphamax = 0;  // corners only
    param->opticurve = 0;
    const std::unique_ptr<potrace_state_t, StateFreer> state(potrace_trace(param.get(), &map));
    if (!state || state->status != POTRACE_STATUS_OK) {
        throw IoError("potrace had no memory for the map; make it coarser");
    }
    const auto ring_of = [](const potrace_path_t& path) {
        Ring ring;
        for (int i = 0; i < path.curve.n; ++i) {
            ring.emplace_back(path.curve.c[i][1].x, path.curve.c[i][1].y);
        }
        return ring;
    };
    std::vector<Polygon> out;
    for (const potrace_path_t* p = state->plist; p != nullptr; p = p->next) {
        if (p->area <= speck_pixels) {
            ++specks;
            continue;
        }
        if (p->sign != '+') continue;
        Polygon polygon{ring_of(*p), {}};
        for (const potrace_path_t* hole = p->childlist; hole != nullptr; hole = hole->sibling) {
            if (hole->area > speck_pixels) polygon.holes.push_back(ring_of(*hole));
        }
        out.push_back(std::move(polygon));
    }
    return out;
}

// What the YAML file says.
struct MapInfo {
    std::filesystem::path image;
    double resolution_m = 0;
    double x = 0;
    double y = 0;
    double yaw = 0;
    bool negate = false;
    double occupied = 0.65;
    double free = 0.196;

    // How surely a grey value is occupied, 0 to 1.
    double probability(int grey) const { return (negate ? grey : 255 - grey) / 255.0; }
};

MapInfo info_of(const std::string& text, const std::filesystem::path& file) {
    const auto fail = [&](int line, const std::string& problem) {
        throw InputError(fmt::format("{}:{}: {}; correct the file, or save the map again",
                                     file.string(), line + 1, problem));
    };
    MapInfo out;
    try {
        const YAML::Node root = YAML::Load(text);
        const auto number = [&](const YAML::Node& node, const std::string& what) {
            double value = 0;
            try {
                value = node.as<double>();
            } catch (const YAML::Exception&) {
                value = NAN;
            }
            if (!std::isfinite(value)) fail(node.Mark().line, what + " is no number");
            return value;
        };
        const auto optional = [&](const char* key, double otherwise) {
            return root[key] ? number(root[key], key) : otherwise;
        };
        if (!root.IsMap() || !root["image"] || !root["resolution"]) {
            fail(0, "image and resolution are needed");
        }
        out.image = file.parent_path() / root["image"].as<std::string>();
        out.resolution_m = number(root["resolution"], "resolution");
        if (!(out.resolution_m > 0))
            fail(root["resolution"].Mark().line, "resolution is not above 0");
        if (const YAML::Node origin = root["origin"]) {
            if (!origin.IsSequence() || origin.size() < 2) {
                fail(origin.Mark().line, "origin is no list of x, y and yaw");
            }
            out.x = number(origin[0], "origin");
            out.y = number(origin[1], "origin");
            if (origin.size() > 2) out.yaw = number(origin[2], "origin");
        }
        if (const YAML::Node negate = root["negate"]) {
            const auto said = negate.as<std::string>();
            out.negate = said == "1" || said == "true";
        }
        out.occupied = optional("occupied_thresh", out.occupied);
        out.free = optional("free_thresh", out.free);
        if (root["mode"] && root["mode"].as<std::string>() == "raw") {
            fail(root["mode"].Mark().line, "mode raw has no occupied and free; save it as trinary");
        }
    } catch (const YAML::Exception& e) {
        fail(std::max(0, e.mark.line), e.msg);
    }
    return out;
}

}  // namespace

bool looks_like_ros_map(const std::string& head, const std::filesystem::path& file) {
    const auto has_key = [&](const std::string& key) {
        return head.rfind(key, 0) == 0 || head.find("\n" + key) != std::string::npos;
    };
    const bool yaml = file.extension() == ".yaml" || file.extension() == ".yml";
    return has_key("image:") && (yaml || has_key("resolution:"));
}

std::filesystem::path ros_image(const std::string& text, const std::filesystem::path& file) {
    return info_of(text, file).image;
}

Drawing read_ros_map(const std::string& text, const std::filesystem::path& file,
                     const ReadOptions& options) {
    const MapInfo info = info_of(text, file);
    const GreyImage image = read_grey_image(info.image);
    Drawing out;
    RoleTally tally;
    out.set.how.format = "ROS map";
    out.set.how.plan = true;
    out.unit = {1, fmt::format("metres, {} a pixel (ROS map)", info.resolution_m)};
    const Vec2d u(std::cos(info.yaw) * info.resolution_m, std::sin(info.yaw) * info.resolution_m);
    const Vec2d v(-u.y(), u.x());
    std::int64_t specks = 0;
    const auto add = [&](const std::string& text_of_it, Role own,
                         const std::function<bool(int)>& wanted) {
        for (Polygon& p : traced(image, wanted, specks)) {
            Feature* f = tally.add(out.set, options, text_of_it, own);
            if (f == nullptr) continue;
            f->polygons.push_back(std::move(p));
            each_point(*f, [&](Vec2d& q) { q = Vec2d(info.x, info.y) + q.x() * u + q.y() * v; });
        }
    };
    add("occupied", Role::wall, [&](int g) { return info.probability(g) > info.occupied; });
    add("free", Role::room, [&](int g) { return info.probability(g) < info.free; });
    if (specks > 0) {
        out.set.warnings.push_back(fmt::format(
            "{} specks of at most {} pixels in the map were left out", specks, speck_pixels));
    }
    tally.add_to(out.set, "");
    return out;
}

}  // namespace vfplan
