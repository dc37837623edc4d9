// The run directory's tables on disk (docs/file_format.md): field.h5 and coverage.h5, indices over
// immutable shards, and plan.h5.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/h5.h"
#include "kernels/candidate.h"
#include "kernels/coverage.h"
#include "kernels/layout.h"
#include "kernels/overlap.h"
#include "kernels/wall.h"

namespace vfplan {

// --- field.h5 ------------------------------------------------------------------------------------

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

// Reads the field through its index. Opening checks every shard and throws IoError, naming it, when
// it is missing, damaged or not the one that was indexed. Thread-safe.
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
    h5::Reader file_;
    FieldInfo info_;
};

// --- coverage.h5 ---------------------------------------------------------------------------------

// Rows of some candidates; `table` has as many.
struct CoverageBlock {
    std::vector<Candidate> candidates;
    CoverageTable table;
};
void write_block(h5::Writer& file, const CoverageBlock& block);

// All that planning needs, so that it needs no geometry, but the entries of the rows.
struct CoverageTables {
    std::vector<Wall> walls;
    Pieces pieces;
    std::vector<PieceStatus> reach;  // no_viewpoint; covered = some candidate does
    std::vector<Candidate> candidates;
    std::vector<std::int64_t> begin = {0};  // entries of row i: [begin[i], begin[i + 1])
    Vec2d origin{0, 0};
    std::string crs_wkt;
    std::string key;
    std::string summary;

    std::int64_t rows() const { return static_cast<std::int64_t>(begin.size()) - 1; }
    std::int64_t entries() const { return begin.back(); }
};

// `blocks`: the shards with the rows, in order. As write_field_index().
struct CoverageInfo {
    Vec2d origin{0, 0};
    std::string crs_wkt;
    std::string key;
    std::string summary;  // JSON of how it was made, for summary.json
};
void write_coverage_index(const std::filesystem::path& path, const std::vector<Wall>& walls,
                          const Pieces& pieces, const std::vector<std::filesystem::path>& blocks,
                          const CoverageInfo& info);
// Checks every shard, as FieldFile.
CoverageTables read_coverage(const std::filesystem::path& path);

// The entries of the rows, as far as they are asked for. Thread-safe.
class CoverageEntries {
public:
    explicit CoverageEntries(const std::filesystem::path& path) : file_(path) {}
    std::vector<std::int32_t> pieces(std::int64_t from, std::int64_t count) const {
        return read<std::int32_t>("indices", from, count);
    }
    std::vector<float> fractions(std::int64_t from, std::int64_t count) const {
        return read<float>("data", from, count);
    }
    std::vector<float> angles_rad(std::int64_t from, std::int64_t count) const {
        return read<float>("angle_rad", from, count);
    }

private:
    template <class T>
    std::vector<T> read(const char* name, std::int64_t from, std::int64_t count) const {
        return file_.read<T>(std::string("coverage/") + name, static_cast<std::uint64_t>(from),
                             static_cast<std::uint64_t>(count));
    }
    h5::Reader file_;
};

// --- plan.h5 -------------------------------------------------------------------------------------

struct PlanTable {
    Plan plan;
    std::string key;  // of the coverage table that it was made from
    std::string overlap_ratio;
    double threshold = 0;
};
void write_plan(const std::filesystem::path& path, const PlanTable& table);
PlanTable read_plan(const std::filesystem::path& path);

// The key stored in a complete table; empty when the file is missing, incomplete or damaged.
std::string key_of(const std::filesystem::path& path);

// Throws IoError, naming it, for the first shard of an index that is missing, damaged or another.
void check_shards(const std::filesystem::path& index);

}  // namespace vfplan
