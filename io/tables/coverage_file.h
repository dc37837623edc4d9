// coverage.h5: walls, pieces, candidates, and the coverage table, an index over blocks of its rows
// (docs/file_format.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

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

// The entries of the rows, as far as they are asked for, from the shards beside the index. What is
// read keeps to its bounds: pieces that there are, ascending in each row. Throws IoError.
// Thread-safe.
class CoverageEntries {
public:
    // `path`: a coverage.h5.
    explicit CoverageEntries(const std::filesystem::path& path);
    // Those of a pool.h5 behind them.
    void add(const std::filesystem::path& path);
    std::vector<std::int32_t> pieces(std::int64_t from, std::int64_t count) const;
    std::vector<float> fractions(std::int64_t from, std::int64_t count) const;
    std::vector<float> angles_rad(std::int64_t from, std::int64_t count) const;

private:
    template <class T, class Check>
    std::vector<T> read(const char* name, std::int64_t from, std::int64_t count,
                        const Check& check) const;

    struct Part {
        std::filesystem::path shard;
        std::int64_t begin = 0;  // its first entry
        std::int64_t count = 0;
    };
    std::vector<Part> parts_;
    std::vector<std::int64_t> begin_ = {0};  // of rows
    std::int64_t pieces_ = 0;
};

// coverage.h5 of a run directory, and pool.h5 behind it where it takes part.
struct Candidates {
    CoverageTables tables;
    CoverageEntries entries;
};
// Throws IoError.
Candidates read_candidates(const std::filesystem::path& dir, CandidatePool pool);

}  // namespace vfplan
