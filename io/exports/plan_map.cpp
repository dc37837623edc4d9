#include "io/exports/plan_map.h"

#include "io/exports/map_png.h"
#include "io/files.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/index.h"

namespace vfplan {

void write_map(const std::filesystem::path& path, const Results& r) {
    constexpr std::int64_t cells_most = std::int64_t{1} << 24;
    const FieldFile::Reduced field = r.field.reduced(cells_most);
    MapInput map;
    map.title = r.title;
    map.subtitle = r.subtitle;
    map.grid = &field.grid;
    map.field_rad = &field.vf_rad;
    map.walls = &r.tables.walls;
    for (const Station& s : r.plan.stations) {
        map.stations.push_back({r.tables.candidates[idx(s.candidate)].at, s.network});
    }
    for (const Link& l : r.plan.links) map.links.push_back({l.from, l.to});
    for (std::size_t p = 0; p < r.plan.pieces.size(); ++p) {
        if (r.plan.pieces[p] == PieceStatus::covered ||
            r.plan.pieces[p] == PieceStatus::unreached) {
            continue;
        }
        const Pieces::Place place = r.tables.pieces.place(static_cast<std::int64_t>(p));
        const Wall& wall = r.tables.walls[idx(place.wall)];
        map.uncovered.push_back({wall.at(place.s0_m), wall.at(place.s1_m)});
    }
    write_text(path, map_png(map, r.map_px));
}

}  // namespace vfplan
