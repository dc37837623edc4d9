#include "engine/links.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "engine/disjoint_sets.h"
#include "engine/field_tiles.h"
#include "engine/flood.h"
#include "engine/overlap_parts.h"
#include "io/columns.h"
#include "kernels/index.h"
#include "kernels/ridges.h"

namespace vfplan {
namespace {

// The shortest way between two candidates of different parts, over the cells where floods from both
// meet.
struct Way {
    std::int32_t part[2] = {-1, -1};       // ascending
    std::int32_t candidate[2] = {-1, -1};  // ascending
    std::int32_t length = 0;
    std::int64_t meets_at = -1;  // cell, and the direction of its neighbour
    std::int32_t direction = 0;
    CellPath cells;  // from candidate to candidate

    std::pair<std::int32_t, std::int32_t> parts() const { return {part[0], part[1]}; }
    std::pair<std::int32_t, std::int32_t> candidates() const {
        return {candidate[0], candidate[1]};
    }
    auto order() const { return std::tuple(length, meets_at, direction); }
};

// Of each two candidates the shortest way, of each two parts the shortest few of these; by parts,
// then the shortest first. What is in the result of all tiles is in that of its own.
std::vector<Way> shortest_few(std::vector<Way> ways) {
    std::sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) {
        return std::tuple(a.parts(), a.order()) < std::tuple(b.parts(), b.order());
    });
    std::vector<Way> out;
    std::size_t first = 0;  // of the present parts, in `out`
    for (Way& way : ways) {
        if (out.empty() || out.back().parts() != way.parts()) first = out.size();
        if (out.size() - first >= ways_tried) continue;
        const auto same = [&](const Way& w) { return w.candidates() == way.candidates(); };
        if (std::any_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), same)) {
            continue;
        }
        out.push_back(std::move(way));
    }
    return out;
}

void write_ways(h5::Writer& file, const std::vector<Way>& ways) {
    file.write("part", [&] {
        std::vector<std::int32_t> out;
        for (const Way& w : ways) out.insert(out.end(), w.part, w.part + 2);
        return out;
    }());
    file.write("candidate", [&] {
        std::vector<std::int32_t> out;
        for (const Way& w : ways) out.insert(out.end(), w.candidate, w.candidate + 2);
        return out;
    }());
    file.write("length", column<std::int32_t>(ways, [](const Way& w) { return w.length; }));
    file.write("meets_at", column<std::int64_t>(ways, [](const Way& w) { return w.meets_at; }));
    file.write("direction", column<std::int32_t>(ways, [](const Way& w) { return w.direction; }));
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int64_t> cells;
    for (const Way& w : ways) {
        cells.insert(cells.end(), w.cells.begin(), w.cells.end());
        begin.push_back(static_cast<std::int64_t>(cells.size()));
    }
    file.write("cells_begin", begin);
    file.write("cells", cells);
}

std::vector<Way> read_ways(const std::filesystem::path& path) {
    const h5::Reader file(path);
    const auto part = file.read<std::int32_t>("part");
    const auto candidate = file.read<std::int32_t>("candidate");
    const auto length = file.read<std::int32_t>("length");
    const auto meets_at = file.read<std::int64_t>("meets_at");
    const auto direction = file.read<std::int32_t>("direction");
    const auto begin = file.read<std::int64_t>("cells_begin");
    const auto cells = file.read<std::int64_t>("cells");
    std::vector<Way> out(length.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {{part[2 * i], part[2 * i + 1]},
                  {candidate[2 * i], candidate[2 * i + 1]},
                  length[i],
                  meets_at[i],
                  direction[i],
                  {cells.begin() + begin[i], cells.begin() + begin[i + 1]}};
    }
    return out;
}

// The ways that meet in a tile's cells.
std::vector<Way> ways_of_tile(const Work& work, std::int64_t tile) {
    const Layout& layout = work.layout();
    const Window core = layout.tile_window(tile);
    const double reach_cells =
        ways_reach_ranges * work.config.scanner.range_max_m / layout.grid.cell_m;
    const auto margin = static_cast<std::int32_t>(std::ceil(reach_cells)) + 1;
    const Window around = core.grown(margin, layout.grid);
    const ListPart list = read_list(work, found_list, around);
    std::vector<std::int32_t> part(list.number.size());
    for (std::size_t i = 0; i < part.size();) {
        std::size_t k = i + 1;
        while (k < part.size() && list.number[k] == list.number[k - 1] + 1) ++k;
        const auto some = read_parts(work, list.number[i], static_cast<std::int64_t>(k - i));
        std::copy(some.begin(), some.end(), part.begin() + static_cast<std::ptrdiff_t>(i));
        i = k;
    }
    if (part.empty() ||
        std::all_of(part.begin(), part.end(), [&](std::int32_t p) { return p == part.front(); })) {
        return {};
    }
    const FieldWindow field = read_field_window(work.dir, layout, around);
    Raster<std::uint8_t> seeing(field.vf_rad.size());  // a way may lead over what sees anything
    for (std::size_t i = 0; i < seeing.size(); ++i) seeing[i] = field.vf_rad[i] > 0 ? 1 : 0;
    Flood flood(field.grid, seeing, field.closed, static_cast<std::int32_t>(10 * reach_cells));
    for (std::size_t i = 0; i < list.candidates.size(); ++i) {
        const std::int64_t cell = list.candidates[i].cell;
        if (cell < 0) continue;
        const std::int32_t x = layout.grid.ix(cell);
        const std::int32_t y = layout.grid.iy(cell);
        if (!around.contains(x, y)) continue;
        flood.add_source(static_cast<std::int64_t>(field.index(x, y)),
                         static_cast<std::int32_t>(i));
    }
    flood.run();
    const auto whole = [&](std::int64_t cell) {
        return layout.grid.id(field.grid.ix(cell) + around.x_begin,
                              field.grid.iy(cell) + around.y_begin);
    };
    std::vector<Way> ways;
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> known;  // by candidates
    for (std::int32_t y = core.y_begin; y < core.y_end; ++y) {
        for (std::int32_t x = core.x_begin; x < core.x_end; ++x) {
            const auto cell = static_cast<std::int64_t>(field.index(x, y));
            if (flood.distance(cell) == Flood::unreached) continue;
            const std::int32_t a = flood.source(cell);
            for (std::int32_t k = 0; k < 4; ++k) {
                const std::int32_t nx = x + around_dx[k];
                const std::int32_t ny = y + around_dy[k];
                if ((field.closed[at(cell)] >> k & 1U) != 0 || !around.contains(nx, ny)) continue;
                const auto n = static_cast<std::int64_t>(field.index(nx, ny));
                if (flood.distance(n) == Flood::unreached) continue;
                const std::int32_t b = flood.source(n);
                if (part[at(a)] == part[at(b)]) continue;
                const std::int32_t length =
                    flood.distance(cell) + flood.distance(n) + (k % 2 == 0 ? 10 : 14);
                const auto found = known.emplace(std::minmax(a, b), ways.size());
                if (!found.second && ways[found.first->second].length <= length) continue;
                if (found.second) ways.emplace_back();
                Way& way = ways[found.first->second];
                std::tie(way.part[0], way.part[1]) = std::minmax(part[at(a)], part[at(b)]);
                std::tie(way.candidate[0], way.candidate[1]) =
                    std::minmax(list.number[at(a)], list.number[at(b)]);
                way.length = length;
                way.meets_at = whole(cell);
                way.direction = k;
                way.cells = {cell, n};  // as they lie in the window, until the path is asked for
            }
        }
    }
    ways = shortest_few(std::move(ways));
    for (Way& way : ways) {
        CellPath path = flood.path_to(way.cells[0]);
        const CellPath rest = flood.path_to(way.cells[1]);
        path.insert(path.end(), rest.rbegin(), rest.rend());
        for (std::int64_t& cell : path) cell = whole(cell);
        way.cells = std::move(path);
    }
    return ways;
}

// A point of a way, looked from.
struct Stand {
    Vec2d at{0, 0};
    std::size_t step = 0;  // on the way, or no_step between two steps
    OverlapRow row;
};
constexpr std::size_t no_step = static_cast<std::size_t>(-1);

// Tries to bridge one way; the stands in between, or nothing when some neighbours stay apart.
class Bridge {
public:
    Bridge(const Work& work, const CellPath& way) : work_(work), way_(way) {}

    bool build(std::vector<Stand>& out) {
        const Stand first = look(0);
        const Stand last = look(way_.size() - 1);
        const bool good = between(first, last);
        if (good) out = std::move(stands_);
        return good;
    }

private:
    Vec2d centre(std::size_t step) const { return work_.layout().grid.centre(way_[step]); }
    Stand look(std::size_t step) const {
        return {centre(step), step, overlap_row(work_.scenes.look(centre(step)).seen)};
    }

    // Depth first and from the near end, so that a way that cannot be bridged is soon given up.
    bool between(const Stand& a, const Stand& b) {
        if (overlap(work_.ratio(), a.row, b.row) >= work_.threshold()) return true;
        Stand middle;
        if (a.step != no_step && b.step != no_step && b.step >= a.step + 2) {
            middle = look(arc_middle(work_.layout().grid, way_, a.step, b.step));
        } else {
            if ((b.at - a.at).norm() / 2 < least_step_m) return false;
            middle.step = no_step;
            middle.at = (a.at + b.at) / 2;
            middle.row = overlap_row(work_.scenes.look(middle.at).seen);
        }
        if (middle.row.seen.empty()) return false;
        if (!between(a, middle) || !between(middle, b)) return false;
        stands_.push_back(std::move(middle));
        return true;
    }

    const Work& work_;
    const CellPath& way_;
    std::vector<Stand> stands_;
};

// work/bridges: which of some ways can be bridged, and with which points.
void bridge_ways(const Work& work, const std::vector<Way>& ways, std::size_t from, std::size_t to,
                 const std::filesystem::path& path) {
    std::vector<std::uint8_t> good(to - from, 0);
    std::vector<std::vector<Stand>> stands(to - from);
    work.threads.for_each(static_cast<std::int64_t>(to - from), 1,
                          [&](std::int64_t begin, std::int64_t end) {
                              for (std::int64_t i = begin; i < end; ++i) {
                                  Bridge bridge(work, ways[from + at(i)].cells);
                                  good[at(i)] = bridge.build(stands[at(i)]) ? 1 : 0;
                              }
                          });
    std::vector<std::int64_t> begin = {0};
    std::vector<double> x;
    std::vector<double> y;
    std::vector<std::int64_t> cell;
    for (std::size_t i = 0; i < stands.size(); ++i) {
        for (const Stand& s : stands[i]) {
            x.push_back(s.at.x());
            y.push_back(s.at.y());
            cell.push_back(s.step == no_step ? -1 : ways[from + i].cells[s.step]);
        }
        begin.push_back(static_cast<std::int64_t>(x.size()));
    }
    h5::Writer file = shard_writer(path, work.key);
    file.write("good", good);
    file.write("begin", begin);
    file.write("x", x);
    file.write("y", y);
    file.write("cell", cell);
    finish_shard(file);
}

constexpr std::size_t ways_at_once = 64;  // in one shard of bridges

// Takes bridges, the shortest ways first, while they join what is apart. `parts`: how many there
// are, before and after.
std::vector<Candidate> chosen_bridges(const Work& work, const std::vector<Way>& ways,
                                      std::int64_t& parts) {
    std::vector<std::uint8_t> good;
    std::vector<std::vector<Candidate>> stands;
    const std::size_t shards = (ways.size() + ways_at_once - 1) / ways_at_once;
    for (std::size_t shard = 0; shard < shards; ++shard) {
        const h5::Reader file(work.passing("bridges", static_cast<std::int64_t>(shard)));
        const auto some = file.read<std::uint8_t>("good");
        good.insert(good.end(), some.begin(), some.end());
        const auto begin = file.read<std::int64_t>("begin");
        const auto x = file.read<double>("x");
        const auto y = file.read<double>("y");
        const auto cell = file.read<std::int64_t>("cell");
        for (std::size_t i = 0; i + 1 < begin.size(); ++i) {
            stands.emplace_back();
            for (std::size_t k = at(begin[i]); k < at(begin[i + 1]); ++k) {
                stands.back().push_back({{x[k], y[k]}, cell[k], CandidateKind::link, 0});
            }
        }
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < ways.size(); ++i) {
        if (good[i] != 0) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tuple(ways[a].order(), ways[a].parts()) <
               std::tuple(ways[b].order(), ways[b].parts());
    });
    DisjointSets sets(parts);
    std::vector<Candidate> out;
    for (const std::size_t i : order) {
        if (sets.together(ways[i].part[0], ways[i].part[1])) continue;
        sets.merge(ways[i].part[0], ways[i].part[1]);
        --parts;
        out.insert(out.end(), stands[i].begin(), stands[i].end());
    }
    return out;
}

std::filesystem::path chosen_path(const Work& work) { return work.passing("chosen", 0); }

void make_ways(const Work& work) {
    make_shards(
        work, "ways", work.layout().tiles(),
        [&](std::int64_t tile) { return work.passing("ways", tile); },
        [&](std::int64_t tile, const std::filesystem::path& path) {
            h5::Writer file = shard_writer(path, work.key);
            write_ways(file, ways_of_tile(work, tile));
            finish_shard(file);
        });
    make_shard(work, "ways", chosen_path(work), [&](const std::filesystem::path& path) {
        std::vector<Way> all;
        for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
            for (Way& way : read_ways(work.passing("ways", tile))) all.push_back(std::move(way));
        }
        h5::Writer file = shard_writer(path, work.key);
        write_ways(file, shortest_few(std::move(all)));
        finish_shard(file);
    });
}

}  // namespace

void make_links(const Work& work, CandidateReport& report) {
    report.parts_before_links = make_parts(work);
    std::vector<Way> ways;
    if (report.parts_before_links > 1) {
        make_ways(work);
        ways = read_ways(chosen_path(work));
    }
    make_shards(
        work, "links", static_cast<std::int64_t>((ways.size() + ways_at_once - 1) / ways_at_once),
        [&](std::int64_t shard) { return work.passing("bridges", shard); },
        [&](std::int64_t shard, const std::filesystem::path& path) {
            const std::size_t from = at(shard) * ways_at_once;
            bridge_ways(work, ways, from, std::min(ways.size(), from + ways_at_once), path);
        });
    const std::filesystem::path list = list_path(work, linked_list);
    make_shard(work, "links", list, [&](const std::filesystem::path&) {
        std::vector<Candidate> candidates =
            read_list(work, found_list, 0, list_size(work, found_list));
        std::vector<std::int64_t> taken;
        for (const Candidate& c : candidates) taken.push_back(c.cell);
        std::sort(taken.begin(), taken.end());
        std::int64_t parts = report.parts_before_links;
        for (const Candidate& c : chosen_bridges(work, ways, parts)) {
            if (c.cell >= 0 && std::binary_search(taken.begin(), taken.end(), c.cell)) continue;
            candidates.push_back(c);
        }
        write_list(work, linked_list, candidates, parts);
    });
    report.parts = static_cast<std::int64_t>(h5::Reader(list).number("/", "parts"));
}

}  // namespace vfplan
