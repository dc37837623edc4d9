#include "engine/plan_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/tables_stage.h"
#include "io/exports.h"
#include "io/files.h"
#include "io/h5.h"
#include "io/map_png.h"
#include "io/sha256.h"
#include "io/vector_writer.h"

namespace vfplan {
namespace {

bool wants(const Config& config, const char* format) {
    const auto& f = config.output.formats;
    return std::find(f.begin(), f.end(), format) != f.end();
}

template <class T>
void add_number(Sha256& hash, T value) {
    hash.add(&value, sizeof value);
}

MapInput map_of(const Config& config, const FieldFile::Reduced& field, const CoverageTables& t,
                const Planned& planned) {
    MapInput map;
    map.title = std::filesystem::path(config.site.input).filename().string();
    const Metrics& m = planned.metrics;
    map.subtitle =
        fmt::format("{} stations in {} network{}, {:.1f} % of the coverable wall in the main one",
                    planned.plan.stations.size(), m.networks, m.networks == 1 ? "" : "s",
                    m.length_coverable_m > 0 ? 100 * m.length_covered_m / m.length_coverable_m : 0);
    map.grid = &field.grid;
    map.field_rad = &field.vf_rad;
    map.walls = &t.walls;
    for (const Station& s : planned.plan.stations) {
        map.stations.push_back({t.candidates[static_cast<std::size_t>(s.candidate)].at, s.network});
    }
    for (const Link& l : planned.plan.links) map.links.push_back({l.from, l.to});
    for (std::size_t p = 0; p < planned.plan.pieces.size(); ++p) {
        if (planned.plan.pieces[p] == PieceStatus::covered ||
            planned.plan.pieces[p] == PieceStatus::unreached) {
            continue;
        }
        const Pieces::Place place = t.pieces.place(static_cast<std::int64_t>(p));
        const Wall& wall = t.walls[static_cast<std::size_t>(place.wall)];
        map.uncovered.push_back({wall.at(place.s0_m), wall.at(place.s1_m)});
    }
    return map;
}

}  // namespace

PlanOptions plan_options(const Config& c) {
    return {c.plan.method, c.plan.loops, ratio_of(c.overlap.ratio), c.overlap.threshold};
}

PlanTables plan_tables_of(const CoverageTables& t, const CoverageEntries& entries,
                          OverlapRatio ratio) {
    const std::int64_t all = t.entries();
    return {t,
            {t.begin, entries.pieces(0, all),
             by_angle(ratio) ? entries.angles_rad(0, all) : std::vector<float>()},
            piece_lengths_m(t.pieces),
            [&entries](std::int64_t from, std::int64_t count) {
                return entries.angles_rad(from, count);
            }};
}

Planned plan_tables(const PlanOptions& options, double range_max_m, const PlanTables& t,
                    const Threads& threads, Progress& progress) {
    const auto pieces = static_cast<std::int64_t>(t.piece_length_m.size());
    Planned out;
    progress.stage("overlap");
    std::vector<std::int32_t> bound_pieces;
    std::vector<PairBlock> pairs;
    {
        const PieceIndex index = index_of(t.rows, pieces);
        bound_pieces = independent_pieces(t.rows, index);
        pairs = overlap_pairs(threads, t.rows, index, t.piece_length_m, options.ratio,
                              options.threshold);
    }
    const Graph graph = make_graph(std::move(pairs));
    const PlanInput input{t.coverage.candidates, t.rows, t.piece_length_m, t.coverage.reach, graph};
    progress.stage("plan");
    out.plan = make_plan(input, options, out.report);
    out.plan.bound_pieces = std::move(bound_pieces);
    add_ratios(input, t.angles, out.plan);
    progress.stage("metrics");
    out.metrics = measure(threads, input, out.plan,
                          PiecePlaces(t.coverage.walls, t.coverage.pieces), range_max_m);
    progress.stage("joining");
    out.joining = find_joining(threads, input, options, out.plan);
    return out;
}

std::string result_hash(const FieldFile& field, const CoverageTables& t,
                        const CoverageEntries& entries, const Plan& plan) {
    Sha256 h;
    field.each_band([&](const Window&, const Raster<float>& vf_rad) { h.add(vf_rad); });
    for (const Candidate& c : t.candidates) {
        add_number(h, c.at.x());
        add_number(h, c.at.y());
        add_number(h, c.cell);
        add_number(h, c.kind);
    }
    h.add(t.begin);
    constexpr std::int64_t at_once = 1 << 20;
    for (std::int64_t from = 0; from < t.entries(); from += at_once) {
        const std::int64_t count = std::min(at_once, t.entries() - from);
        h.add(entries.pieces(from, count));
        h.add(entries.fractions(from, count));
        h.add(entries.angles_rad(from, count));
    }
    for (const Wall& w : t.walls) {
        for (const double v : {w.a.x(), w.a.y(), w.b.x(), w.b.y()}) add_number(h, v);
    }
    h.add(t.reach);
    for (const Station& s : plan.stations) {
        add_number(h, s.candidate);
        add_number(h, s.network);
        add_number(h, s.new_length_m);
    }
    for (const Link& l : plan.links) {
        add_number(h, l.from);
        add_number(h, l.to);
        add_number(h, l.overlap);
    }
    h.add(plan.pieces);
    return h.hex();
}

nlohmann::ordered_json summary_of(const Planned& p, const CoverageTables& t) {
    const Metrics& m = p.metrics;
    nlohmann::ordered_json j;
    j["crs"] = crs_name(t.crs_wkt);
    j["candidates"] = t.candidates.size();
    j["pieces"] = t.pieces.size();
    j["pieces_coverable"] = m.pieces_coverable;
    j["pieces_covered"] = m.pieces_covered;
    j["pieces_unreached"] = m.pieces_unreached;
    j["length_m"] = m.length_all_m;
    j["length_coverable_m"] = m.length_coverable_m;
    j["length_covered_m"] = m.length_covered_m;
    j["stations"] = p.plan.stations.size();
    j["networks"] = m.networks;
    j["links"] = p.plan.links.size();
    j["wapl"] = m.wapl;
    j["wapl_penalty100"] = m.wapl_penalty100;
    j["wapl_sources"] = m.sources;
    j["wapl_standard_error"] = m.standard_error;
    j["disconnected_pairs"] = m.disconnected_pairs;
    j["bottleneck_overlap"] = m.bottleneck_overlap;
    j["bridges"] = m.bridges;
    j["articulation_stations"] = m.articulation_stations;
    j["redundant_links"] = m.redundant_links;
    j["lower_bound"] = m.lower_bound;
    j["gap"] = m.gap;
    j["plan"] = {{"stations_greedy", p.report.greedy_stations},
                 {"stations_pruned", p.report.pruned_stations},
                 {"stations_before_loops", p.report.before_loops},
                 {"stations_after_loops", p.plan.stations.size()},
                 {"off_cycle_before_loops", p.report.loose_before},
                 {"off_cycle_after_loops", p.report.loose_after}};
    j["histograms"] = {{"stations_per_piece", m.multiplicity},
                       {"range_by_tenth_of_max", m.range_tenths},
                       {"incidence_by_10_deg", m.incidence_tens}};
    std::vector<std::int64_t> stations(p.joining.joins_at.size(), 0);
    std::vector<double> length(stations.size(), 0);
    for (const Station& s : p.plan.stations) {
        ++stations[static_cast<std::size_t>(s.network)];
        length[static_cast<std::size_t>(s.network)] += s.new_length_m;
    }
    nlohmann::ordered_json networks = nlohmann::ordered_json::array();
    for (std::size_t n = 0; n < stations.size(); ++n) {
        networks.push_back({{"stations", stations[n]},
                            {"length_m", length[n]},
                            {"joins_main_at", p.joining.joins_at[n]}});
    }
    j["network_list"] = networks;
    j["networks_by_min_len"] = p.joining.networks_by_min_len;
    return j;
}

void write_plan_files(const RunDir& dir, const Config& config, const FieldFile& field,
                      const CoverageTables& t, const Planned& p) {
    write_plan(dir.file("plan.h5"),
               {p.plan, t.key, config.overlap.ratio, config.overlap.threshold});
    // What is not asked for does not stay from a plan before.
    const auto asked = [&](const char* format, const char* name) {
        std::error_code ignored;
        if (!wants(config, format)) std::filesystem::remove(dir.file(name), ignored);
        return wants(config, format);
    };
    const auto put = [&](const char* format, const char* name, const auto& text) {
        if (asked(format, name)) write_text(dir.file(name), text());
    };
    put("csv", "stations.csv", [&] { return stations_csv(t, p.plan); });
    put("csv", "links.csv", [&] { return links_csv(p.plan); });
    if (asked("csv", "pieces.csv")) write_pieces_csv(dir.file("pieces.csv"), t, p.plan);
    put("geojson", "stations.geojson", [&] { return stations_geojson(t, p.plan); });
    if (asked("gpkg", "plan.gpkg")) write_gpkg(dir.file("plan.gpkg"), t, p.plan);
    put("png", "map.png", [&] {
        constexpr std::int64_t cells_most = std::int64_t{1} << 24;
        const FieldFile::Reduced reduced = field.reduced(cells_most);
        return map_png(map_of(config, reduced, t, p), static_cast<int>(config.output.map_px));
    });
}

namespace {

// Why there is more than one network.
std::string apart_text(const Planned& p, const Config& config) {
    const Metrics& m = p.metrics;
    std::int64_t enclosed = 0;
    double least = 1;
    for (const double at : p.joining.joins_at) {
        if (at > 0) {
            least = std::min(least, at);
        } else {
            ++enclosed;
        }
    }
    const auto networks = [](std::int64_t n) {
        return fmt::format("{} network{}", n, n == 1 ? "" : "s");
    };
    std::string out = fmt::format(
        "apart        {} pieces are seen from {} besides only (network_list in summary.json)\n",
        m.pieces_unreached, networks(m.networks - 1));
    if (enclosed > 0) {
        out += fmt::format(
            "             {}: no chain of candidates shares a piece with the main one; walls or "
            "distance part them, or cells of {} m are too coarse for the way between\n",
            networks(enclosed), config.field.cell_m);
    }
    if (const std::int64_t weak = m.networks - 1 - enclosed; weak > 0) {
        out += fmt::format(
            "             {}: joined from overlap.threshold = {:.3f} down (now {}); smaller cells "
            "may help; with ratio min_len there would be {} in all\n",
            networks(weak), std::floor(least * 1000) / 1000, config.overlap.threshold,
            networks(p.joining.networks_by_min_len));
    }
    return out;
}

}  // namespace

std::string plan_text(const Planned& p, const CoverageTables& t, const Config& config) {
    const Metrics& m = p.metrics;
    const auto share = [](double part, double whole) { return whole > 0 ? 100 * part / whole : 0; };
    std::string out = fmt::format(
        "stations     {} in {} network{} with {} links (of {} candidates; at least {} are needed)\n"
        "covered      {} of {} coverable pieces, {:.2f} % of their {:.0f} m, by the main network\n",
        p.plan.stations.size(), m.networks, m.networks == 1 ? "" : "s", p.plan.links.size(),
        t.candidates.size(), m.lower_bound, m.pieces_covered, m.pieces_coverable,
        share(m.length_covered_m, m.length_coverable_m), m.length_coverable_m);
    if (m.networks > 1) out += apart_text(p, config);
    const std::int64_t nobody = t.pieces.size() - m.pieces_coverable;
    if (nobody > 0) {
        out += fmt::format("no viewpoint {} pieces, {:.2f} % of all wall length (pieces.csv)\n",
                           nobody, share(m.length_all_m - m.length_coverable_m, m.length_all_m));
    }
    out += fmt::format(
        "network      WAPL {:.3f}{}, weakest needed overlap {:.3f}, {} bridge{}, {} "
        "articulation stations\n",
        m.wapl,
        m.standard_error > 0
            ? fmt::format(" +- {:.3f} (from {} of the stations)", m.standard_error, m.sources)
            : "",
        m.bottleneck_overlap, m.bridges, m.bridges == 1 ? "" : "s", m.articulation_stations);
    return out;
}

}  // namespace vfplan
