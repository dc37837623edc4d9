#include "engine/tables/coverage.h"

#include <algorithm>

#include "io/tables/coverage_file.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int64_t rows_in_block = 2048;

// The field at some candidates; for points that are no cell's centre, what is seen from them.
void fill_vf(const FieldTiles& tiles, std::vector<Candidate>& some,
             const std::vector<double>& looked_rad) {
    const Layout& layout = tiles.layout();
    std::vector<std::size_t> by_patch;
    for (std::size_t i = 0; i < some.size(); ++i) {
        if (some[i].cell >= 0) {
            by_patch.push_back(i);
        } else {
            some[i].vf_rad = static_cast<float>(looked_rad[i]);
        }
    }
    for (std::size_t i = 0; i < by_patch.size();) {
        const std::int64_t patch = layout.patch_of(some[by_patch[i]].cell);
        const FieldWindow field = tiles.window(layout.patch_window(patch));
        for (; i < by_patch.size() && layout.patch_of(some[by_patch[i]].cell) == patch; ++i) {
            Candidate& c = some[by_patch[i]];
            c.vf_rad = field.vf_rad[field.index(layout.grid.ix(c.cell), layout.grid.iy(c.cell))];
        }
    }
}

CoverageBlock block_of(const TableJob& job, const FieldTiles& field, std::vector<Candidate> some) {
    std::vector<Vec2d> eyes;
    for (const Candidate& c : some) eyes.push_back(c.at);
    std::vector<CoverageRow> rows(some.size());
    std::vector<double> vf_rad(some.size());
    job.scenes.each(job.threads, eyes, [&](std::size_t i, const Scene& scene) {
        Scene::Look look = scene.look(eyes[i]);
        rows[i] = std::move(look.row);
        vf_rad[i] = look.vf_rad;
    });
    fill_vf(field, some, vf_rad);
    CoverageBlock block;
    block.candidates = std::move(some);
    for (const CoverageRow& row : rows) block.table.add(row);
    return block;
}

}  // namespace

std::vector<std::filesystem::path> make_coverage(const TableJob& job, const FieldTiles& field,
                                                 const std::string& phase,
                                                 const CandidateList& candidates) {
    const std::int64_t n = candidates.size();
    const std::int64_t blocks = (n + rows_in_block - 1) / rows_in_block;
    const ShardNames names = job.kept(phase);
    make_shards(job, names, blocks, [&](std::int64_t b, const std::filesystem::path& path) {
        const std::int64_t from = b * rows_in_block;
        const std::int64_t to = std::min(n, from + rows_in_block);
        write_coverage_block(path, job.key, block_of(job, field, candidates.read(from, to)));
    });
    std::vector<std::filesystem::path> out;
    for (std::int64_t b = 0; b < blocks; ++b) out.push_back(names.one(b));
    return out;
}

}  // namespace vfplan
