#include "engine/coverage_blocks.h"

#include <algorithm>

#include "engine/field_tiles.h"
#include "io/columns.h"
#include "io/tables.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int64_t rows_in_block = 2048;

// Candidates numbered [from, to): those of the list, then the user's points.
std::vector<Candidate> numbered(const Work& work, std::int64_t from, std::int64_t to) {
    const std::int64_t listed = list_size(work, linked_list);
    const std::int64_t first = std::min(from, listed);
    std::vector<Candidate> out = read_list(work, linked_list, first, std::min(to, listed) - first);
    const std::vector<Candidate> users = points_of_user(work);
    for (std::int64_t i = std::max(from, listed); i < to; ++i) out.push_back(users[at(i - listed)]);
    return out;
}

// The field at some candidates; for points that are no cell's centre, what is seen from them.
void fill_vf(const Work& work, std::vector<Candidate>& some,
             const std::vector<double>& looked_rad) {
    const Layout& layout = work.layout();
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
        const FieldWindow field = read_field_window(work.dir, layout, layout.patch_window(patch));
        for (; i < by_patch.size() && layout.patch_of(some[by_patch[i]].cell) == patch; ++i) {
            Candidate& c = some[by_patch[i]];
            c.vf_rad = field.vf_rad[field.index(layout.grid.ix(c.cell), layout.grid.iy(c.cell))];
        }
    }
}

void make_block(const Work& work, std::vector<Candidate> some, const std::filesystem::path& path) {
    std::vector<Vec2d> eyes;
    for (const Candidate& c : some) eyes.push_back(c.at);
    std::vector<CoverageRow> rows(some.size());
    std::vector<double> vf_rad(some.size());
    work.scenes.each(work.threads, eyes, [&](std::size_t i, const Scene& scene) {
        Scene::Look look = scene.look(eyes[i]);
        rows[i] = std::move(look.row);
        vf_rad[i] = look.vf_rad;
    });
    fill_vf(work, some, vf_rad);
    CoverageTable table;
    for (const CoverageRow& row : rows) table.add(row);
    h5::Writer file = shard_writer(path, work.key);
    write_block(file, {std::move(some), std::move(table)});
    finish_shard(file);
}

}  // namespace

std::int64_t make_coverage_blocks(const Work& work) {
    const std::int64_t n =
        list_size(work, linked_list) + static_cast<std::int64_t>(points_of_user(work).size());
    const std::int64_t blocks = (n + rows_in_block - 1) / rows_in_block;
    make_shards(
        work, "coverage", blocks, [&](std::int64_t b) { return work.kept("coverage", b); },
        [&](std::int64_t b, const std::filesystem::path& path) {
            const std::int64_t from = b * rows_in_block;
            make_block(work, numbered(work, from, std::min(n, from + rows_in_block)), path);
        });
    return blocks;
}

std::int64_t rescued_pieces(const Work& work) {
    std::int64_t count = 0;
    for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
        const auto cells =
            h5::Reader(work.passing("rescue", tile)).read<std::int64_t>("piece_cell");
        count += std::count_if(cells.begin(), cells.end(), [](std::int64_t c) { return c >= 0; });
    }
    return count;
}

void write_coverage_tables(const Work& work, std::int64_t blocks, const std::string& summary) {
    make_shard(work, "tables", work.dir / "coverage.h5", [&](const std::filesystem::path& path) {
        const SiteFacts& facts = work.store.facts();
        std::vector<std::filesystem::path> parts;
        for (std::int64_t b = 0; b < blocks; ++b) parts.push_back(work.kept("coverage", b));
        const std::vector<Wall> walls = work.store.all_walls();
        write_coverage_index(path, walls, work.store.all_pieces(walls), parts,
                             {facts.origin, facts.crs_wkt, work.key, summary});
    });
}

}  // namespace vfplan
