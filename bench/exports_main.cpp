// exports [STATIONS PIECES]: what the files of a plan of a county take, each by itself.
//
// The plan is made up (a grid of stations, each linked to its neighbours, and walls between them),
// of the size that docs/performance.md has for the county unless told otherwise, because a real one
// takes an hour. Prints a table in Markdown: seconds of the wall and of the processor, megabytes.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"
#include "io/exports/outputs.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/field_tiles.h"
#include "io/temporary_folder.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr double spacing_m = 60;

struct MadeUp {
    CoverageTables tables;
    Plan plan;
};

MadeUp made_up(std::int64_t stations, std::int64_t pieces) {
    MadeUp out;
    const auto side =
        static_cast<std::int32_t>(std::ceil(std::sqrt(static_cast<double>(stations))));
    out.tables.origin = {580'000, 4'470'000};
    constexpr std::int32_t in_wall = 12;
    for (std::int64_t w = 0; w < pieces / in_wall; ++w) {
        const double x = spacing_m * static_cast<double>(w % side) + 7.5;
        const double y = spacing_m / 5 * static_cast<double>(w / side) + 3.25;
        out.tables.walls.push_back(
            {{x, y}, {x + 12, y + 0.125}, WallClass::wall, true, {true, false}});
        out.tables.pieces.add_wall(out.tables.walls.back().length_m(), in_wall, 0);
        for (std::int32_t k = 0; k < in_wall; ++k) {
            out.plan.pieces.push_back(w % 16 == 0 ? PieceStatus::no_viewpoint
                                                  : PieceStatus::covered);
        }
    }
    for (std::int32_t i = 0; i < stations; ++i) {
        const std::int32_t x = i % side;
        const std::int32_t y = i / side;
        out.tables.candidates.push_back(
            {{spacing_m * x, spacing_m * y}, i, CandidateKind::joint, 3});
        out.plan.stations.push_back({i, 0, i, 12.5, 140.75, 3.25, false, false, 0.4321});
        if (x + 1 < side && i + 1 < stations) out.plan.links.push_back({i, i + 1, 0.5, {}});
        if (i + side < stations) out.plan.links.push_back({i, i + side, 0.375, {}});
    }
    return out;
}

// A field of one tile, which the map draws in the corner: its cost does not grow with the site.
FieldFile made_field(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "shards");
    const Layout layout = make_layout({{0, 0}, 30, 512, 512}, 75, 1024);
    const Window all = layout.tile_window(0);
    const std::filesystem::path tile = folder / "shards" / "field-1024-00000.h5";
    write_field_tile(
        tile, "key",
        {all, Raster<float>(idx(all.size()), 2.5F), Raster<std::uint8_t>(idx(all.size()), 0), {}});
    write_field_index(folder / "field.h5", {layout, {0, 0}, "", "key", "{}"}, {tile});
    return FieldFile(folder / "field.h5");
}

void measure(std::int64_t stations, std::int64_t pieces) {
    const TemporaryFolder folder("vfplan-exports");
    const MadeUp county = made_up(stations, pieces);
    const FieldFile field = made_field(folder.path());
    const Threads threads;
    const EachBlock each_block = [&](std::int64_t n, const std::function<void(std::int64_t)>& f) {
        threads.for_each(n, 1, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t i = from; i < to; ++i) f(i);
        });
    };
    fmt::print("{} stations, {} links, {} pieces, {} threads\n\n", stations,
               county.plan.links.size(), county.plan.pieces.size(), threads.count());
    fmt::print("| file | pieces listed | MB | wall s | cpu s |\n|---|---|--:|--:|--:|\n");
    for (const bool all : {false, true}) {
        for (const Output& o : outputs()) {
            const bool lists_pieces = o.file == "pieces.csv" || o.file == "plan.gpkg";
            if (all && !lists_pieces) continue;
            const std::filesystem::path file = folder.path() / o.file;
            const Moment begin = Moment::now();
            o.write(file, {field, county.tables, county.plan, "a county", "made up", 1600, all,
                           each_block});
            const Moment end = Moment::now();
            fmt::print("| {} | {} | {:.1f} | {:.2f} | {:.2f} |\n", o.file,
                       !lists_pieces ? ""
                       : all         ? "all"
                                     : "uncovered",
                       static_cast<double>(std::filesystem::file_size(file)) / 1e6,
                       end.wall_s - begin.wall_s, end.cpu_s - begin.cpu_s);
            std::filesystem::remove(file);
        }
    }
}

}  // namespace
}  // namespace vfplan

int main(int argc, char** argv) {
    const bool told = argc == 3;
    vfplan::measure(told ? std::atoll(argv[1]) : 325'937, told ? std::atoll(argv[2]) : 20'000'000);
    return 0;
}
