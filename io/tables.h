// The run directory's tables on disk (docs/file_format.md): field.h5, coverage.h5, plan.h5.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernels/candidate.h"
#include "kernels/coverage.h"
#include "kernels/grid.h"
#include "kernels/overlap.h"
#include "kernels/wall.h"

namespace vfplan {

// field.h5: the visibility field on its grid.
struct FieldTable {
    Grid grid;
    Raster<float> vf_rad;  // NaN where no station can stand
    Vec2d origin{0, 0};    // site frame to input coordinates
    std::string crs_wkt;
    std::string key;  // hash of everything that the table depends on
};

// coverage.h5: all that planning needs, so that it needs no geometry.
struct CoverageTables {
    std::vector<Wall> walls;
    Pieces pieces;
    std::vector<PieceStatus> reach;  // off_candidates, no_viewpoint; covered = some candidate does
    std::vector<Candidate> candidates;
    CoverageTable table;
    Vec2d origin{0, 0};
    std::string crs_wkt;
    std::string key;
};

// plan.h5: what was chosen.
struct PlanTable {
    Plan plan;
    std::string key;  // of the coverage table that it was made from
    std::string overlap_ratio;
    double threshold = 0;
};

// All throw IoError. Writing is whole or not at all; equal tables give equal bytes.
void write_field(const std::filesystem::path& path, const FieldTable& table);
FieldTable read_field(const std::filesystem::path& path);
void write_coverage(const std::filesystem::path& path, const CoverageTables& tables);
CoverageTables read_coverage(const std::filesystem::path& path);
void write_plan(const std::filesystem::path& path, const PlanTable& table);
PlanTable read_plan(const std::filesystem::path& path);

// The key stored in a complete table; empty when the file is missing or incomplete.
std::string key_of(const std::filesystem::path& path);

}  // namespace vfplan
