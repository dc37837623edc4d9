// Sites made by hand, for the readers' tests.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/site/site_reader.h"
#include "io/temporary_folder.h"

namespace vfplan::test {

using vfplan::TemporaryFolder;

inline Ring box_ring(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

inline void add_polygon(FeatureSet& set, Role role, Ring outer, std::vector<Ring> holes = {}) {
    Feature f;
    f.number = static_cast<std::int64_t>(set.features.size()) + 1;
    f.role = role;
    f.polygons = {{std::move(outer), std::move(holes)}};
    set.features.push_back(std::move(f));
}

inline void add_line(FeatureSet& set, Role role, Line line) {
    Feature f;
    f.number = static_cast<std::int64_t>(set.features.size()) + 1;
    f.role = role;
    f.lines = {std::move(line)};
    set.features.push_back(std::move(f));
}

inline SiteOptions indoor() {
    SiteOptions options;
    options.kind = SiteKind::indoor;
    return options;
}

inline double total_length(const Site& site) {
    double sum = 0;
    for (const Wall& w : site.walls) sum += w.length_m();
    return sum;
}

// The wall that runs through a point given in the input's coordinates; null where there is none.
inline const Wall* wall_through(const Site& site, const Vec2d& input) {
    const Vec2d p = input - site.origin;
    for (const Wall& w : site.walls) {
        const Vec2d e = (w.b - w.a).normalized();
        const double along = (p - w.a).dot(e);
        if (std::abs(cross(e, p - w.a)) < 1e-6 && along > -1e-6 && along < w.length_m() + 1e-6) {
            return &w;
        }
    }
    return nullptr;
}

// Whether the side of a wall that faces an input point is free.
inline bool free_towards(const Site& site, const Wall& w, const Vec2d& input) {
    return w.free_side[orient(w.a, w.b, input - site.origin) > 0 ? left : right];
}

inline bool is_free(const Site& site, const Vec2d& input) {
    const Vec2d p = input - site.origin;
    bool odd = false;
    for (const auto& [a, b] : site.free_border) {
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x()) odd = !odd;
    }
    return odd;
}

// A file under the system's folder for temporary ones, gone at the end.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& name)
        : path_(std::filesystem::temp_directory_path() /
                (std::to_string(::getpid()) + "_" + name)) {  // tests run side by side
        std::filesystem::remove(path_);
    }
    TemporaryFile(const std::string& name, const std::string& text) : TemporaryFile(name) {
        std::ofstream(path_) << text;
    }
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

// Damages a file. Readers check a file again when its time or size is another: as days later.
inline void overwrite(const std::filesystem::path& file, const std::string& bytes) {
    static int writes = 0;
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
    std::filesystem::last_write_time(
        file, std::filesystem::last_write_time(file) + std::chrono::seconds(++writes));
}

}  // namespace vfplan::test
