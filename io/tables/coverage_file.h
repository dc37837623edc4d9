// coverage.h5: walls, pieces, candidates, and the coverage table, an index over blocks of its rows
// (docs/file_format.md).
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "io/tables/join_shards.h"
#include "kernels/candidate.h"
#include "kernels/coverage.h"
#include "kernels/wall.h"

namespace vfplan {

inline constexpr const char* coverage_name = "coverage.h5";
inline constexpr const char* pool_name = "pool.h5";

// Rows of some candidates; `table` has as many.
struct CoverageBlock {
    std::vector<Candidate> candidates;
    CoverageTable table;
};
void write_coverage_block(const std::filesystem::path& path, const std::string& key,
                          const CoverageBlock& block);

// All that planning needs, so that it needs no geometry, but the entries of the rows.
struct CoverageTables {
    std::vector<Wall> walls;
    Pieces pieces;
    std::vector<PieceStatus> status;  // no_viewpoint; covered = some candidate does
    std::vector<Candidate> candidates;
    std::vector<std::int64_t> begin = {0};  // entries of row i: [begin[i], begin[i + 1])
    Vec2d origin{0, 0};
    std::string crs_wkt;
    std::string key;
    std::string summary;
    Apart apart;  // by the overlap of the job that made the tables
    CandidatePool pool = CandidatePool::axis;

    std::int64_t rows() const { return static_cast<std::int64_t>(begin.size()) - 1; }
    std::int64_t entries() const { return begin.back(); }
};

// `blocks`: the shards with the rows, in order. As write_field_index().
struct CoverageInfo {
    Vec2d origin{0, 0};
    std::string crs_wkt;
    std::string key;
    std::string summary;  // JSON of how it was made, for summary.json
    Apart apart;          // written where it is known
};
void write_coverage_index(const std::filesystem::path& path, const std::vector<Wall>& walls,
                          const Pieces& pieces, const std::vector<std::filesystem::path>& blocks,
                          const CoverageInfo& info);
// Checks every shard, as FieldFile.
CoverageTables read_coverage(const std::filesystem::path& path);

// pool.h5: more candidates with their rows, over the pieces of a coverage.h5. `key`: of the pool.
void write_pool_index(const std::filesystem::path& path,
                      const std::vector<std::filesystem::path>& blocks, const std::string& key,
                      std::int64_t pieces);

// The entries of the rows, as far as they are asked for. Thread-safe.
class CoverageEntries {
public:
    explicit CoverageEntries(const std::filesystem::path& path) { add(path); }
    // Those of another table behind them.
    void add(const std::filesystem::path& path);
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
        std::vector<T> out;
        for (const Part& part : parts_) {
            const std::int64_t first = std::max<std::int64_t>(0, from - part.begin);
            const std::int64_t end = std::min(part.count, from + count - part.begin);
            if (first >= end) continue;
            std::vector<T> some = part.file->read<T>(std::string("coverage/") + name,
                                                     static_cast<std::uint64_t>(first),
                                                     static_cast<std::uint64_t>(end - first));
            if (out.empty()) {
                out = std::move(some);
            } else {
                out.insert(out.end(), some.begin(), some.end());
            }
        }
        return out;
    }
    struct Part {
        std::unique_ptr<h5::Reader> file;
        std::int64_t begin = 0;  // its first entry
        std::int64_t count = 0;
    };
    std::vector<Part> parts_;
};

// coverage.h5 of a run directory, and pool.h5 behind it where it takes part.
struct Candidates {
    CoverageTables tables;
    CoverageEntries entries;
};
// Throws IoError.
Candidates read_candidates(const std::filesystem::path& dir, CandidatePool pool);

}  // namespace vfplan
