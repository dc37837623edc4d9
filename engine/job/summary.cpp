#include "engine/job/summary.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "io/tables/crs.h"
#include "kernels/index.h"
#include "vfplan_version.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

// What it was measured over how far networks are apart.
std::string measured_over(const Planned& p) {
    const std::int64_t cells = p.join_thresholds.free_cells;
    return cells > 0 ? fmt::format("all {} free cells", cells) : std::string("candidates");
}

// Why there is more than one network.
std::string apart_text(const Planned& p, const Config& config) {
    const Metrics& m = p.metrics;
    std::int64_t enclosed = 0;
    double least = 1;
    for (const double at : p.join_thresholds.joins_at) {
        if (at > 0) {
            least = std::min(least, at);
        } else {
            ++enclosed;
        }
    }
    const auto networks = [](std::int64_t n) {
        return fmt::format("{} network{}", n, n == 1 ? "" : "s");
    };
    const std::int64_t cells = p.join_thresholds.free_cells;
    const std::string over = measured_over(p);
    std::string out = fmt::format(
        "apart        {} pieces are seen from {} only, not from the main one (network_list in "
        "summary.json)\n",
        m.pieces_unreached, networks(m.networks - 1));
    if (enclosed > 0) {
        out += fmt::format(
            "             {}: no chain of {} shares a piece with the main one; walls or "
            "distance part them, or cells of {} m are too coarse for a path between\n",
            networks(enclosed), cells > 0 ? fmt::format("the {} free cells", cells) : over,
            config.field.cell_m);
    }
    if (const std::int64_t weak = m.networks - 1 - enclosed; weak > 0) {
        out += fmt::format(
            "             {}: over {} joined from overlap.threshold = {:.3f} down (now {}); "
            "smaller cells may help; with ratio min_len there would be {} in all at most\n",
            networks(weak), over, std::floor(least * 1000) / 1000, config.overlap.threshold,
            networks(p.join_thresholds.networks_by_min_len));
    }
    return out;
}

}  // namespace

Json summary_of_tables(const FieldFile& field, const CoverageTables& coverage) {
    Json j = Json::parse(coverage.summary);
    j.update(Json::parse(field.info().summary));
    return j;
}

Json summary_of_plan(const Planned& p, const CoverageTables& t) {
    const Metrics& m = p.metrics;
    Json j;
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
    // The bound is one of connected plans: it holds with loops too, but a gap compares it with
    // connected plans alone.
    const double connected_gap = gap(p.report.connected, m.lower_bound);
    j["lower_bound"] = m.lower_bound;
    j["gap"] = connected_gap;
    j["gap_connected"] = connected_gap;
    j["candidate_pool"] = {{"name", name_of(t.pool)}, {"candidates", t.candidates.size()}};
    const auto count = [&](const std::string& kind, std::int64_t stations) {
        j["stations_" + kind] = stations;
        j["bound_" + kind] = m.lower_bound;
    };
    count("connected", p.report.connected);
    if (p.loops) {
        const std::int64_t more =
            p.report.shortcuts + (p.report.survival ? p.report.survival->stations : 0);
        count("loops", static_cast<std::int64_t>(p.plan.stations.size()) - more);
    }
    j["plan"] = {{"stations_greedy", p.report.greedy_stations},
                 {"off_cycle_connected", p.report.off_cycle_before},
                 {"off_cycle", p.report.off_cycle_after},
                 {"shortcuts", p.report.shortcuts},
                 {"too_near", p.report.too_near}};
    if (const auto& survival = p.report.survival) {
        j["plan"]["survival"] = {{"stations", survival->stations},
                                 {"pieces_alone", survival->pieces_alone},
                                 {"length_alone_m", survival->length_alone_m}};
    }
    j["histograms"] = {{"stations_per_piece", m.multiplicity},
                       {"range_by_tenth_of_max", m.range_tenths},
                       {"incidence_by_10_deg", m.incidence_tens}};
    std::vector<std::int64_t> stations(p.join_thresholds.joins_at.size(), 0);
    std::vector<double> length(stations.size(), 0);
    for (const Station& s : p.plan.stations) {
        ++stations[idx(s.network)];
        length[idx(s.network)] += s.new_length_m;
    }
    Json networks = Json::array();
    for (std::size_t n = 0; n < stations.size(); ++n) {
        networks.push_back({{"stations", stations[n]},
                            {"length_m", length[n]},
                            {"joins_main_at", p.join_thresholds.joins_at[n]}});
    }
    j["network_list"] = networks;
    if (stations.size() > 1) {
        j["joins_main_at_over"] = measured_over(p);
    }
    j["networks_by_min_len"] = p.join_thresholds.networks_by_min_len;
    return j;
}

void add_times(Json& j, const Progress& progress) {
    Json wall = Json::object();
    Json cpu = Json::object();
    Json peak = Json::object();
    for (const StageTime& s : progress.times()) {
        wall[s.name] = wall.value(s.name, 0.0) + s.wall_s;
        cpu[s.name] = cpu.value(s.name, 0.0) + s.cpu_s;
        peak[s.name] = std::max(peak.value(s.name, 0.0), s.peak_rss_mb);
    }
    j["stage_wall_s"] = wall;
    j["stage_cpu_s"] = cpu;
    j["stage_peak_rss_mb"] = peak;
    j["wall_s"] = progress.wall_s();
    j["peak_rss_mb"] = progress.peak_rss_mb();
}

namespace {

// What loops and wishes beyond them have added.
std::string loops_text(const Planned& p) {
    const std::int64_t survival = p.report.survival ? p.report.survival->stations : 0;
    const std::int64_t more = p.report.shortcuts + survival;
    std::string out = fmt::format(": {} before loops", p.report.connected);
    if (more > 0) {
        out +=
            fmt::format(", {} with them", static_cast<std::int64_t>(p.plan.stations.size()) - more);
    }
    if (survival != 0) out += fmt::format(", {} to stand a loss", survival);
    if (p.report.shortcuts > 0) out += fmt::format(", {} for shortcuts", p.report.shortcuts);
    return out;
}

}  // namespace

std::string plan_text(const Planned& p, const CoverageTables& t, const Config& config) {
    const Metrics& m = p.metrics;
    std::string out = fmt::format(
        "stations     {} in {} network{} with {} links{}\n"
        "bound        no plan over these {} candidates ({}) has fewer than {}: gap {:.1f} %{}\n"
        "covered      {} of {} coverable pieces, {:.2f} % of their {:.0f} m, by the main network\n",
        p.plan.stations.size(), m.networks, m.networks == 1 ? "" : "s", p.plan.links.size(),
        p.loops ? loops_text(p) : "", t.candidates.size(), name_of(t.pool), m.lower_bound,
        100 * gap(p.report.connected, m.lower_bound), p.loops ? " before loops" : "",
        m.pieces_covered, m.pieces_coverable, percent(m.length_covered_m, m.length_coverable_m),
        m.length_coverable_m);
    if (m.networks > 1) out += apart_text(p, config);
    const std::int64_t nobody = t.pieces.size() - m.pieces_coverable;
    if (nobody > 0) {
        out += fmt::format("no viewpoint {} pieces, {:.2f} % of all wall length (pieces.csv)\n",
                           nobody, percent(m.length_all_m - m.length_coverable_m, m.length_all_m));
    }
    out += fmt::format(
        "network      WAPL {:.3f}{}, weakest needed overlap {:.3f}, {} bridge{}, {} "
        "articulation stations\n",
        m.wapl,
        m.standard_error > 0
            ? fmt::format(" +- {:.3f} (from {} of the stations)", m.standard_error, m.sources)
            : "",
        m.bottleneck_overlap, m.bridges, m.bridges == 1 ? "" : "s", m.articulation_stations);
    if (p.report.survival) {
        out += fmt::format(
            "survives     the loss of any one station, but for {} pieces ({:.1f} m) that one "
            "candidate alone sees and {} stations that part it where the candidates have no other "
            "way\n",
            p.report.survival->pieces_alone, p.report.survival->length_alone_m,
            m.articulation_stations);
    }
    return out;
}

std::string plan_line(const Planned& p) {
    const Metrics& m = p.metrics;
    return fmt::format(
        "{} stations in {} network{}, {:.1f} % of the coverable wall in the main network",
        p.plan.stations.size(), m.networks, m.networks == 1 ? "" : "s",
        percent(m.length_covered_m, m.length_coverable_m));
}

std::string provenance(const Config& config, const std::string& input_sha256, int threads,
                       int ranks) {
    char host[256] = {};
    gethostname(host, sizeof host - 1);
    const std::time_t now = std::time(nullptr);
    char when[32] = {};
    std::strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    const Json j = {{"program", "vfplan"},
                    {"version", version},
                    {"version_git", version_git},
                    {"build_type", build_type},
                    {"input", config.site.input.string()},
                    {"input_sha256", input_sha256},
                    {"host", host},
                    {"threads", threads},
                    {"ranks", ranks},
                    {"finished_utc", when}};
    // Paths are bytes, and need not be UTF-8; JSON must.
    return j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace vfplan
