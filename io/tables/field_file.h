// field.h5: the visibility field, an index over its tiles (docs/file_format.md).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "kernels/layout.h"

namespace vfplan {

struct FieldInfo {
    Layout layout;
    Vec2d origin{0, 0};  // site frame to input coordinates
    std::string crs_wkt;
    std::string key;      // hash of everything that the table depends on
    std::string summary;  // JSON of how it was made, for summary.json
};

// `tiles`: the shard of every tile, in a folder of the index's own. Throws IoError when one of them
// is missing or damaged. Whole or not at all; equal tiles give equal bytes.
void write_field_index(const std::filesystem::path& path, const FieldInfo& info,
                       const std::vector<std::filesystem::path>& tiles);

// Reads the field from the shards beside its index. Opening checks every one and throws IoError,
// naming it, when it is missing, damaged or not the one that was indexed. Thread-safe.
class FieldFile {
public:
    explicit FieldFile(const std::filesystem::path& path);

    const FieldInfo& info() const { return info_; }
    const Grid& grid() const { return info_.layout.grid; }
    Raster<float> read(const Window& window) const;
    // Calls f(window, values) for bands of rows from the south that together are the field.
    void each_band(const std::function<void(const Window&, const Raster<float>&)>& f) const;

    // The field, or, where it has more cells than `most`, means over squares of cells; NaN where
    // less than half of a square has a value.
    struct Reduced {
        Grid grid;
        Raster<float> vf_rad;
    };
    Reduced reduced(std::int64_t most) const;

private:
    std::vector<std::filesystem::path> tiles_;
    FieldInfo info_;
};

}  // namespace vfplan
