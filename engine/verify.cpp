#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/graph.h"
#include "engine/pipeline.h"
#include "engine/run_dir.h"
#include "engine/tables_stage.h"
#include "engine/viewer.h"
#include "io/tables.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

class Checks {
public:
    void add(bool good, const std::string& text) {
        result_.text += fmt::format("{}  {}\n", good ? "yes" : "NO ", text);
        all_ = all_ && good;
    }
    VerifyResult result() {
        result_.good = all_;
        return result_;
    }

private:
    VerifyResult result_;
    bool all_ = true;
};

// What the stations see when looked from again.
struct Again {
    PieceRows rows;                   // of the stations, with angles where overlap goes by angle
    std::vector<std::uint8_t> main;   // by piece: seen by a station of the main network
    std::vector<std::uint8_t> other;  // by one of another
};

Again look_again(const Viewer& viewer, const Threads& threads, const std::vector<Vec2d>& eyes,
                 const Plan& plan, bool angles) {
    Again out;
    out.main.assign(plan.pieces.size(), 0);
    out.other.assign(plan.pieces.size(), 0);
    constexpr std::size_t block = 4096;  // full rows are in memory for so many stations at a time
    for (std::size_t first = 0; first < eyes.size(); first += block) {
        const auto begin = eyes.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = begin + static_cast<std::ptrdiff_t>(std::min(block, eyes.size() - first));
        std::size_t station = first;
        for (const CoverageRow& row : viewer.rows(threads, {begin, end})) {
            std::vector<std::uint8_t>& seen =
                plan.stations[station++].network == 0 ? out.main : out.other;
            for (const Seen& s : row) {
                seen[at(s.piece)] = 1;
                out.rows.piece.push_back(s.piece);
                if (angles) out.rows.angle_rad.push_back(s.angle_rad);
            }
            out.rows.begin.push_back(static_cast<std::int64_t>(out.rows.piece.size()));
        }
    }
    return out;
}

// Every piece's status against what the stations' exact rows cover.
void check_coverage(const CoverageTables& t, const Plan& plan, const Again& again, Checks& checks) {
    const std::vector<std::uint8_t>& main = again.main;
    const std::vector<std::uint8_t>& other = again.other;
    std::int64_t covered = 0;
    std::int64_t not_covered = 0;
    std::int64_t unreached = 0;
    std::int64_t unreached_wrong = 0;
    std::int64_t seen_after_all = 0;
    for (std::size_t p = 0; p < plan.pieces.size(); ++p) {
        switch (plan.pieces[p]) {
            case PieceStatus::covered:
                ++covered;
                if (main[p] == 0) ++not_covered;
                break;
            case PieceStatus::unreached:
                ++unreached;
                if (other[p] == 0 || main[p] != 0) ++unreached_wrong;
                break;
            default:
                if (main[p] != 0 || other[p] != 0) ++seen_after_all;
        }
    }
    checks.add(not_covered == 0,
               fmt::format("{} pieces are covered by the main network{}", covered - not_covered,
                           not_covered > 0
                               ? fmt::format("; {} more are said to be and are not", not_covered)
                               : ""));
    if (unreached > 0) {
        checks.add(
            unreached_wrong == 0,
            fmt::format("{} pieces are covered by other networks only{}",
                        unreached - unreached_wrong,
                        unreached_wrong > 0
                            ? fmt::format("; {} more are said to be and are not", unreached_wrong)
                            : ""));
    }
    const std::int64_t rest = t.pieces.size() - covered - unreached;
    checks.add(
        seen_after_all == 0,
        fmt::format(
            "{} pieces are covered by no station, as the plan says{}", rest - seen_after_all,
            seen_after_all > 0 ? fmt::format("; {} more are, after all", seen_after_all) : ""));
}

void check_connection(const CoverageTables& t, const PlanTable& table, const PieceRows& rows,
                      Checks& checks) {
    const Plan& plan = table.plan;
    const std::vector<double> length_m = piece_lengths_m(t.pieces);
    const std::vector<SeenTotal> totals = seen_totals(rows, length_m);
    const OverlapRatio ratio = ratio_of(table.overlap_ratio);
    constexpr double rounding = 1e-6;  // angles are stored as floats
    std::vector<OverlapPair> pairs;
    std::int64_t weak = 0;
    double weakest = 1;
    for (const Link& l : plan.links) {
        const double o = overlap(ratio, totals[at(l.from)], totals[at(l.to)],
                                 seen_jointly(rows, length_m, l.from, l.to));
        if (o + rounding < table.threshold) ++weak;
        if (o + rounding >= table.threshold) pairs.push_back({l.from, l.to, o});
        weakest = std::min(weakest, o);
    }
    checks.add(weak == 0,
               fmt::format("{} links overlap by {} >= {}{}", plan.links.size() - at(weak),
                           table.overlap_ratio, table.threshold,
                           weak > 0 ? fmt::format("; {} do not", weak)
                                    : fmt::format(" (weakest {:.4f})",
                                                  plan.links.empty() ? 0.0 : weakest)));
    const std::vector<std::int32_t> part =
        components(make_graph(static_cast<std::int32_t>(plan.stations.size()), pairs));
    std::int32_t networks = 0;
    bool whole = true;
    std::vector<std::int32_t> part_of(plan.stations.size(), -1);  // by network: its first station's
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const std::int32_t network = plan.stations[i].network;
        networks = std::max(networks, network + 1);
        if (part_of[at(network)] < 0) part_of[at(network)] = part[i];
        whole = whole && part_of[at(network)] == part[i];
    }
    checks.add(whole, networks == 1
                          ? fmt::format("all {} stations are one network", plan.stations.size())
                          : fmt::format("{} stations are {} networks, each connected",
                                        plan.stations.size(), networks));
}

// A spread of free cells, seen anew: the field there, and pieces that are said to have no
// viewpoint.
void check_field(const Viewer& viewer, const Threads& threads, const FieldTable& field,
                 const Plan& plan, const std::string& kernel, Checks& checks) {
    constexpr std::size_t sample = 1000;
    std::vector<std::int64_t> cells;
    for (std::int64_t c = 0; c < field.grid.size(); ++c) {
        if (!std::isnan(field.vf_rad[at(c)])) cells.push_back(c);
    }
    const std::size_t step = std::max<std::size_t>(1, cells.size() / sample);
    std::vector<std::int64_t> chosen;
    for (std::size_t i = step / 2; i < cells.size(); i += step) chosen.push_back(cells[i]);
    std::vector<double> error(chosen.size(), 0);
    std::vector<std::int64_t> seen_after_all(chosen.size(), 0);
    threads.for_each(
        static_cast<std::int64_t>(chosen.size()), 8, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t i = from; i < to; ++i) {
                const Vec2d eye = field.grid.centre(chosen[at(i)]);
                const Viewer::Look look = viewer.look(eye);
                error[at(i)] =
                    std::abs(look.vf_rad - static_cast<double>(field.vf_rad[at(chosen[at(i)])]));
                for (const Seen& s : look.row) {
                    if (plan.pieces[at(s.piece)] == PieceStatus::no_viewpoint) {
                        ++seen_after_all[at(i)];
                    }
                }
            }
        });
    double sum = 0;
    double worst = 0;
    std::int64_t wrong = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        sum += error[i];
        worst = std::max(worst, error[i]);
        wrong += seen_after_all[i];
    }
    const double mean = chosen.empty() ? 0 : sum / static_cast<double>(chosen.size());
    // Floats keep 7 digits of an angle; rays may miss what is thinner than their spacing.
    const double allowed = kernel == "exact" ? 1e-6 : 5e-3;
    checks.add(
        mean <= allowed,
        fmt::format("field at {} cells: mean error {:.2e} rad, worst {:.2e} (kernel {}, mean "
                    "allowed {:.0e})",
                    chosen.size(), mean, worst, kernel, allowed));
    checks.add(wrong == 0, fmt::format("none of these cells sees a piece that is said to have no "
                                       "viewpoint{}",
                                       wrong > 0 ? fmt::format(": {} times wrong", wrong) : ""));
}

// The exact kernel made the rows and looks again from the stations: the same mistake twice would
// not show. Rays share nothing with it but the walls.
void check_with_rays(const Viewer& exact, const Viewer& rays, const Threads& threads,
                     const std::vector<Vec2d>& eyes, Checks& checks) {
    std::vector<double> error(eyes.size(), 0);
    threads.for_each(
        static_cast<std::int64_t>(eyes.size()), 4, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t i = from; i < to; ++i) {
                const Vec2d& eye = eyes[at(i)];
                error[at(i)] = std::abs(rays.look(eye).vf_rad - exact.look(eye).vf_rad);
            }
        });
    double sum = 0;
    double worst = 0;
    for (const double e : error) {
        sum += e;
        worst = std::max(worst, e);
    }
    const double mean = eyes.empty() ? 0 : sum / static_cast<double>(eyes.size());
    checks.add(mean <= 5e-3,
               fmt::format("rays from {} stations: mean difference to the exact views {:.2e} rad, "
                           "worst {:.2e} (mean allowed 5e-03)",
                           eyes.size(), mean, worst));
}

void check_bound(const CoverageTables& t, const Plan& plan, Checks& checks) {
    std::vector<std::uint8_t> in_bound(plan.pieces.size(), 0);
    for (const std::int32_t p : plan.bound_pieces) in_bound[at(p)] = 1;
    bool good = true;
    std::vector<std::uint8_t> seen(plan.pieces.size(), 0);
    for (std::int64_t r = 0; r < t.table.rows(); ++r) {
        int count = 0;
        for (const Seen* s = t.table.row_begin(r); s != t.table.row_end(r); ++s) {
            count += in_bound[at(s->piece)];
            seen[at(s->piece)] = 1;
        }
        good = good && count <= 1;
    }
    for (const std::int32_t p : plan.bound_pieces) good = good && seen[at(p)] != 0;
    checks.add(good && plan.bound_pieces.size() <= plan.stations.size(),
               fmt::format("at least {} stations are needed over these candidates: no candidate "
                           "covers two of the {} pieces of the certificate",
                           plan.bound_pieces.size(), plan.bound_pieces.size()));
}

// True when every number in the plan points into the tables.
bool fits(const CoverageTables& t, const Plan& plan) {
    const auto below = [](std::int64_t i, std::size_t end) {
        return i >= 0 && static_cast<std::size_t>(i) < end;
    };
    bool good = plan.pieces.size() == at(t.pieces.size());
    for (const Station& s : plan.stations) {
        good = good && below(s.candidate, t.candidates.size()) &&
               below(s.network, plan.stations.size());
    }
    for (const Link& l : plan.links) {
        good = good && below(l.from, plan.stations.size()) && below(l.to, plan.stations.size());
    }
    for (const std::int32_t p : plan.bound_pieces) good = good && below(p, plan.pieces.size());
    for (const PieceStatus s : plan.pieces) good = good && below(static_cast<int>(s), 4);
    return good;
}

}  // namespace

VerifyResult verify_run(const std::filesystem::path& path, int thread_count, Progress& progress) {
    const Threads threads(thread_count);
    const RunDir dir(path);
    const Config config = dir.config();
    progress.stage("read");
    const FieldTable field = read_field(dir.file("field.h5"));
    const CoverageTables t = read_coverage(dir.file("coverage.h5"));
    if (!std::filesystem::exists(dir.file("plan.h5"))) {
        throw IoError(fmt::format("{}: tables, but no plan.h5 yet; make it with vfplan plan {}",
                                  path.string(), path.string()));
    }
    const PlanTable table = read_plan(dir.file("plan.h5"));
    Checks checks;
    checks.add(table.key == t.key && field.key == t.key,
               "field, coverage and plan belong to one job");
    checks.add(fits(t, table.plan), "the plan's numbers point into its tables");
    if (!checks.result().good) return checks.result();
    progress.stage("look again");
    Box box{field.grid.origin,
            field.grid.origin + field.grid.cell_m * Vec2d(field.grid.nx, field.grid.ny)};
    for (const Candidate& c : t.candidates) box.add(c.at);
    const std::unique_ptr<ViewKernel> exact =
        make_kernel("exact", t.walls, box, config.scanner.range_max_m, 0);
    const Viewer viewer(*exact, t.walls, t.pieces, scanner_of(config),
                        config.coverage.visible_fraction);
    std::vector<Vec2d> eyes;
    for (const Station& s : table.plan.stations) eyes.push_back(t.candidates[at(s.candidate)].at);
    {
        const Again again =
            look_again(viewer, threads, eyes, table.plan, by_angle(ratio_of(table.overlap_ratio)));
        check_coverage(t, table.plan, again, checks);
        check_connection(t, table, again.rows, checks);
    }
    check_field(viewer, threads, field, table.plan, config.visibility.kernel, checks);
    constexpr int many_rays = 1024;
    const std::unique_ptr<ViewKernel> embree =
        make_kernel("embree", t.walls, box, config.scanner.range_max_m, many_rays);
    check_with_rays(
        viewer,
        Viewer(*embree, t.walls, t.pieces, scanner_of(config), config.coverage.visible_fraction),
        threads, eyes, checks);
    check_bound(t, table.plan, checks);
    progress.finish();
    return checks.result();
}

}  // namespace vfplan
