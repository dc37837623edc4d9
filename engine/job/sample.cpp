#include "engine/job/sample.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/runtime/progress.h"
#include "engine/runtime/ranks.h"
#include "engine/tables/site.h"
#include "engine/tables/tables.h"
#include "io/tables/coverage_file.h"
#include "io/temporary_folder.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr double square_cells = 320;  // side of a square that is tried, at least
constexpr int squares_tried = 6;

// Walls of a site by the square that their middle lies in.
struct Squares {
    std::int64_t columns = 0;
    double side_m = 0;
    Vec2d origin{0, 0};
    std::vector<double> weight;  // wall length, m

    // Two ranges wide at least: in less, what lies at the edge would be most of it.
    Squares(const Site& site, double cell_m, double range_m)
        : side_m(std::max(square_cells * cell_m, 2 * range_m)) {
        origin = site.extent.min;
        const Vec2d size = site.extent.size();
        columns = static_cast<std::int64_t>(std::ceil(size.x() / side_m));
        const auto rows = static_cast<std::int64_t>(std::ceil(size.y() / side_m));
        weight.assign(idx(columns * rows), 0);
        for (const Wall& w : site.walls) {
            const Vec2d p = ((w.a + w.b) / 2 - origin) / side_m;
            const auto x = static_cast<std::int64_t>(p.x());
            const auto y = static_cast<std::int64_t>(p.y());
            weight[idx(std::min(y, rows - 1) * columns + std::min(x, columns - 1))] += w.length_m();
        }
    }
    // Systematic sampling: each square as often as its share of walls.
    std::vector<std::size_t> sample() const {
        double whole = 0;
        for (const double w : weight) whole += w;
        std::vector<std::size_t> out;
        double before = 0;
        int taken = 0;
        for (std::size_t i = 0; i < weight.size(); ++i) {
            before += weight[i];
            bool hit = false;
            while (taken < squares_tried && before >= whole * (taken + 0.5) / squares_tried) {
                ++taken;
                hit = true;
            }
            if (hit) out.push_back(i);
        }
        return out;
    }
    Box box(std::size_t square) const {
        const auto n = static_cast<std::int64_t>(square);
        const Vec2d lo = origin + side_m * Vec2d(static_cast<double>(n % columns),
                                                 static_cast<double>(n / columns));
        return {lo, lo + Vec2d(side_m, side_m)};
    }
};

// The part of a site in a box, with the walls that are in sight of it.
Site part_of_site(const Site& site, const Box& box, double range_m) {
    Site out = site;
    out.required.clear();  // they may lie elsewhere
    out.existing.clear();
    out.extent = {box.min.cwiseMax(site.extent.min), box.max.cwiseMin(site.extent.max)};
    const Vec2d reach(range_m, range_m);
    const Box around{out.extent.min - reach, out.extent.max + reach};
    const auto meets = [&](const Vec2d& lo, const Vec2d& hi) {
        return lo.x() <= around.max.x() && hi.x() >= around.min.x() && lo.y() <= around.max.y() &&
               hi.y() >= around.min.y();
    };
    std::erase_if(out.walls,
                  [&](const Wall& w) { return !meets(w.a.cwiseMin(w.b), w.a.cwiseMax(w.b)); });
    // A piece in the north, south or east of all cells is crossed by no count of theirs.
    std::erase_if(out.free_border, [&](const Border& piece) {
        return std::min(piece.a.y(), piece.b.y()) > around.max.y() ||
               std::max(piece.a.y(), piece.b.y()) < around.min.y() ||
               std::min(piece.a.x(), piece.b.x()) > around.max.x();
    });
    return out;
}

double bytes_below(const std::filesystem::path& folder, const std::string& prefix) {
    double sum = 0;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder)) {
        if (e.is_regular_file() && e.path().filename().string().starts_with(prefix)) {
            sum += static_cast<double>(e.file_size());
        }
    }
    return sum;
}

// Makes the tables of a part of the site and adds what they took.
void try_part(const GroundOptions& ground, const TableOptions& options, const Site& site,
              const Threads& threads, Sample& sum) {
    const TemporaryFolder folder("vfplan-estimate");
    const Ranks alone{Ranks::Alone{}};
    Progress quiet(true);
    make_shard_folders(folder.path(), options.tile_cells);
    const Moment begin = Moment::now();
    store_site(ground, "estimate", site, threads, folder.path() / "work" / "site.h5");
    make_tables(options, folder.path(), "estimate", threads, alone, quiet);
    sum.cpu_s += Moment::now().cpu_s - begin.cpu_s;
    const CoverageTables tables = read_coverage(folder.path() / "coverage.h5");
    sum.candidates += static_cast<double>(tables.rows());
    sum.entries += static_cast<double>(tables.entries());
    sum.field_bytes += bytes_below(folder.path() / "shards", "field");
    sum.coverage_bytes += bytes_below(folder.path() / "shards", "coverage");
    sum.working_bytes += bytes_below(folder.path() / "work", "");
}

}  // namespace

Sample try_squares(const GroundOptions& ground, const TableOptions& tables, const Site& site,
                   const Threads& threads) {
    const Squares squares(site, ground.cell_m, ground.range_max_m);
    Sample out;
    out.whole = squares.weight.size() <= squares_tried;
    if (out.whole) {
        try_part(ground, tables, site, threads, out);
        return out;
    }
    double all_m = 0;
    for (const double w : squares.weight) all_m += w;
    double tried_m = 0;
    for (const std::size_t square : squares.sample()) {
        try_part(ground, tables, part_of_site(site, squares.box(square), ground.range_max_m),
                 threads, out);
        tried_m += squares.weight[square];
    }
    if (tried_m > 0) out.share = tried_m / all_m;
    return out;
}

}  // namespace vfplan
