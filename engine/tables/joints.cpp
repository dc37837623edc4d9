#include "engine/tables/joints.h"

#include "engine/tables/covered.h"
#include "kernels/ridges.h"

namespace vfplan {

std::vector<std::int64_t> points_without_joint(const Grid& grid, const TileRidges::Line& ridge) {
    const auto& cells = ridge.cells;
    if (ridge.joint[0] >= 0 || ridge.joint[1] >= 0) return {};
    if (ridge.ring && cells.size() > 2) {
        std::vector<std::int64_t> closed = cells;
        closed.push_back(cells.front());
        return {cells.front(), closed[arc_middle(grid, closed, 0, closed.size() - 1)]};
    }
    if (cells.size() < 3) return {cells.front()};
    return {cells[arc_middle(grid, cells, 0, cells.size() - 1)]};
}

FoundTiles make_joints(const TableJob& job, const RidgeTiles& ridges, std::int64_t pieces) {
    const Grid& grid = job.layout().grid;
    const ShardNames names = job.passing("joints");
    make_shards(job, names, job.layout().tiles(),
                [&](std::int64_t number, const std::filesystem::path& path) {
                    const TileRidges tile = ridges.tile(number);
                    FoundTile found;
                    for (const std::int64_t c : tile.joints) {
                        found.candidates.push_back({c, CandidateKind::joint});
                    }
                    for (const TileRidges::Line& ridge : tile.ridges) {
                        const CandidateKind kind =
                            ridge.ring ? CandidateKind::ring : CandidateKind::middle;
                        for (const std::int64_t c : points_without_joint(grid, ridge)) {
                            found.candidates.push_back({c, kind});
                        }
                    }
                    std::vector<Vec2d> eyes;
                    for (const FoundCandidate& c : found.candidates) {
                        eyes.push_back(grid.centre(c.cell));
                    }
                    found.covered = covered_from(job, eyes, pieces);
                    write_found_tile(path, job.key, found);
                });
    return {names, job.layout().tiles()};
}

}  // namespace vfplan
