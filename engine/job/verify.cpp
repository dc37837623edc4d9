#include "engine/job/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <unordered_map>

#include "engine/check/run_check.h"
#include "engine/folder/contents.h"
#include "engine/folder/input_state.h"
#include "engine/folder/lock.h"
#include "engine/folder/publication.h"
#include "engine/folder/run_dir.h"
#include "engine/job/reread.h"
#include "engine/tables/scenes.h"
#include "io/checksum.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/plan_file.h"
#include "kernels/disjoint_sets.h"
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
    void note(const std::string& text) { result_.text += "--   " + text + "\n"; }
    VerifyResult result() {
        result_.good = all_;
        return result_;
    }

private:
    VerifyResult result_;
    bool all_ = true;
};

// What the stations see, looked at anew.
struct Rechecked {
    std::vector<std::uint8_t> main;      // pieces covered by the main network
    std::vector<std::uint8_t> other;     // by another one
    std::vector<double> link_overlap;    // of each link
    std::vector<double> ray_difference;  // rays against the exact view, of each station
};

// Patch by patch, so that memory is a patch's. The exact kernel made the rows and looks again from
// the stations: the same mistake twice would not show. Rays share nothing with it but the walls.
Rechecked recheck(const PlanTable& table, const CoverageTables& t, const Threads& threads,
                  Scenes& scenes, Progress& progress) {
    const Plan& plan = table.plan;
    const Layout& layout = scenes.layout();
    Rechecked out{std::vector<std::uint8_t>(plan.pieces.size(), 0),
                  std::vector<std::uint8_t>(plan.pieces.size(), 0),
                  std::vector<double>(plan.links.size(), 0),
                  std::vector<double>(plan.stations.size(), 0)};
    const auto eye_of = [&](std::int32_t station) {
        return t.candidates[idx(plan.stations[idx(station)].candidate)].at;
    };
    std::map<std::int64_t, std::vector<std::int32_t>> stations;  // by patch
    for (std::size_t s = 0; s < plan.stations.size(); ++s) {
        const auto number = static_cast<std::int32_t>(s);
        stations[layout.patch_of(layout.cell_at(eye_of(number)))].push_back(number);
    }
    std::vector<std::int64_t> patches;
    for (const auto& [patch, of_patch] : stations) patches.push_back(patch);
    std::vector<std::size_t> link_begin(plan.stations.size() + 1, 0);  // links ascend in `from`
    for (const Link& l : plan.links) ++link_begin[idx(l.from) + 1];
    std::partial_sum(link_begin.begin(), link_begin.end(), link_begin.begin());
    std::mutex guard;
    constexpr int many_rays = 1024;
    progress.stage("recheck", static_cast<std::int64_t>(patches.size()));
    threads.for_each(
        static_cast<std::int64_t>(patches.size()), 1, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t p = from; p < to; ++p) {
                const auto scene = scenes.of_patch(patches[idx(p)]);
                const auto margin = eye_margin_m(scenes.options().partition_m);
                const Window w = layout.patch_window(patches[idx(p)]);
                const Box around{
                    {-margin, -margin},
                    layout.grid.cell_m * Vec2d(w.x_end - w.x_begin, w.y_end - w.y_begin) +
                        Vec2d(margin, margin)};
                const Scanner& scanner = scenes.options().scanner;
                const std::unique_ptr<ViewKernel> rays = make_kernel(
                    KernelKind::embree, scene->walls(), around, scanner.range_max_m, many_rays);
                std::unordered_map<std::int32_t, OverlapRow> rows;
                const auto row_of = [&](std::int32_t station) -> const OverlapRow& {
                    const auto known = rows.find(station);
                    if (known != rows.end()) return known->second;
                    return rows.emplace(station, scenes.look(eye_of(station)).overlap_row())
                        .first->second;
                };
                std::vector<std::int32_t> covered[2];
                for (const std::int32_t s : stations.at(patches[idx(p)])) {
                    const Scene::Look look = scene->look(eye_of(s));
                    View hits;
                    View seen;
                    const Vec2d here = eye_of(s) - scene->origin();
                    rays->first_hits(here, hits);
                    observe(scene->walls(), scanner, here, hits, seen);
                    out.ray_difference[idx(s)] = std::abs(view_angle_rad(seen) - look.vf_rad);
                    for (const Seen& piece : look.row) {
                        covered[plan.stations[idx(s)].network == 0 ? 0 : 1].push_back(piece.piece);
                    }
                    rows.emplace(s, look.overlap_row());
                    for (std::size_t l = link_begin[idx(s)]; l < link_begin[idx(s) + 1]; ++l) {
                        const OverlapRow& other = row_of(plan.links[l].to);
                        out.link_overlap[l] = overlap(table.overlap.ratio, row_of(s), other);
                    }
                }
                const std::lock_guard lock(guard);
                for (const std::int32_t piece : covered[0]) out.main[idx(piece)] = 1;
                for (const std::int32_t piece : covered[1]) out.other[idx(piece)] = 1;
                progress.advance(1);
            }
        });
    return out;
}

// Every piece's status against what the stations cover.
void check_coverage(const Plan& plan, const Rechecked& found, Checks& checks) {
    std::int64_t covered = 0;
    std::int64_t not_covered = 0;
    std::int64_t unreached = 0;
    std::int64_t unreached_wrong = 0;
    std::int64_t rest = 0;
    std::int64_t seen_after_all = 0;
    for (std::size_t p = 0; p < plan.pieces.size(); ++p) {
        switch (plan.pieces[p]) {
            case PieceStatus::covered:
                ++covered;
                if (found.main[p] == 0) ++not_covered;
                break;
            case PieceStatus::unreached:
                ++unreached;
                if (found.other[p] == 0 || found.main[p] != 0) ++unreached_wrong;
                break;
            default:
                ++rest;
                if (found.main[p] != 0 || found.other[p] != 0) ++seen_after_all;
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
    checks.add(
        seen_after_all == 0,
        fmt::format(
            "{} pieces are covered by no station, as the plan says{}", rest - seen_after_all,
            seen_after_all > 0 ? fmt::format("; {} more are, after all", seen_after_all) : ""));
}

void check_connection(const PlanTable& table, const Rechecked& found, Checks& checks) {
    const Plan& plan = table.plan;
    constexpr double rounding = 1e-6;  // angles are stored as floats
    DisjointSets sets(static_cast<std::int64_t>(plan.stations.size()));
    std::int64_t weak = 0;
    double weakest = 1;
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        const double o = found.link_overlap[i];
        if (o + rounding < table.overlap.threshold) {
            ++weak;
        } else {
            sets.merge(plan.links[i].from, plan.links[i].to);
        }
        weakest = std::min(weakest, o);
    }
    checks.add(weak == 0, fmt::format("{} links overlap by {} >= {}{}",
                                      static_cast<std::int64_t>(plan.links.size()) - weak,
                                      name_of(table.overlap.ratio), table.overlap.threshold,
                                      weak > 0 ? fmt::format("; {} do not", weak)
                                               : fmt::format(" (weakest {:.4f})",
                                                             plan.links.empty() ? 0.0 : weakest)));
    std::map<std::int32_t, std::int32_t> first;  // station of each network
    bool whole = true;
    for (std::size_t s = 0; s < plan.stations.size(); ++s) {
        const auto number = static_cast<std::int32_t>(s);
        const auto one = first.emplace(plan.stations[s].network, number).first;
        whole = whole && sets.together(one->second, number);
    }
    checks.add(whole, first.size() <= 1
                          ? fmt::format("all {} stations are one network", plan.stations.size())
                          : fmt::format("{} stations are {} networks, each connected",
                                        plan.stations.size(), first.size()));
}

// Free cells spread evenly over the site, with the field there.
std::vector<std::pair<std::int64_t, float>> sample_of(const FieldFile& field) {
    constexpr std::int64_t sample = 1000;
    std::int64_t cells = 0;
    const auto free = [](float v) { return !std::isnan(v); };
    field.each_band([&](const Window&, const Raster<float>& vf) {
        cells += std::count_if(vf.begin(), vf.end(), free);
    });
    const std::int64_t step = std::max<std::int64_t>(1, cells / sample);
    std::vector<std::pair<std::int64_t, float>> out;
    std::int64_t number = 0;
    field.each_band([&](const Window& w, const Raster<float>& vf) {
        for (std::size_t i = 0; i < vf.size(); ++i) {
            if (!free(vf[i])) continue;
            if (number++ % step != step / 2) continue;
            out.emplace_back(field.grid().id(0, w.y_begin) + static_cast<std::int64_t>(i), vf[i]);
        }
    });
    return out;
}

// These cells seen anew: the field there, and pieces that are said to have no viewpoint.
void check_field(Scenes& scenes, const Threads& threads, const FieldFile& field, const Plan& plan,
                 KernelKind kernel, Checks& checks) {
    const auto chosen = sample_of(field);
    std::vector<Vec2d> eyes;
    for (const auto& [cell, vf] : chosen) eyes.push_back(field.grid().centre(cell));
    std::vector<double> error(chosen.size(), 0);
    std::vector<std::int64_t> seen_after_all(chosen.size(), 0);
    scenes.each(threads, eyes, [&](std::size_t i, const Scene& scene) {
        const Scene::Look look = scene.look(eyes[i]);
        error[i] = std::abs(look.vf_rad - static_cast<double>(chosen[i].second));
        for (const Seen& s : look.row) {
            if (plan.pieces[idx(s.piece)] == PieceStatus::no_viewpoint) ++seen_after_all[i];
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
    const double allowed = kernel == KernelKind::exact ? 1e-6 : 5e-3;
    checks.add(
        mean <= allowed,
        fmt::format("field at {} cells: mean error {:.2e} rad, worst {:.2e} (kernel {}, mean "
                    "allowed {:.0e})",
                    chosen.size(), mean, worst, name_of(kernel), allowed));
    checks.add(wrong == 0, fmt::format("none of these cells sees a piece that is said to have no "
                                       "viewpoint{}",
                                       wrong > 0 ? fmt::format(": {} times wrong", wrong) : ""));
}

void check_rays(const std::vector<double>& error, Checks& checks) {
    double sum = 0;
    double worst = 0;
    for (const double e : error) {
        sum += e;
        worst = std::max(worst, e);
    }
    const double mean = error.empty() ? 0 : sum / static_cast<double>(error.size());
    checks.add(mean <= 5e-3,
               fmt::format("rays from {} stations: mean difference to the exact views {:.2e} rad, "
                           "worst {:.2e} (mean allowed 5e-03)",
                           error.size(), mean, worst));
}

void check_bound(const CoverageTables& t, const CoverageEntries& entries, const PlanTable& table,
                 Checks& checks) {
    const RunCheck found = check_plan(t, entries, table, table.plan.certificate);
    checks.add(found.wrong.empty(),
               found.wrong.empty()
                   ? fmt::format("at least {} stations are needed over these {} candidates: the "
                                 "certificate proves it for {} networks",
                                 found.bound, t.candidates.size(), found.networks)
                   : fmt::format("the certificate's bound of {} stations: {}", found.bound,
                                 found.wrong.front()));
    if (!table.survives || !found.wrong.empty()) return;
    checks.add(true, fmt::format("without any one station all is covered but {} pieces that one "
                                 "candidate alone sees, and connected but for {} stations where "
                                 "the candidates have no other way",
                                 found.pieces_alone, found.parting));
}

// True when every number in the plan points into the tables.
bool fits(const CoverageTables& t, const Plan& plan) {
    const auto below = [](std::int64_t i, std::size_t end) {
        return i >= 0 && static_cast<std::size_t>(i) < end;
    };
    bool good = plan.pieces.size() == idx(t.pieces.size());
    for (const Station& s : plan.stations) {
        good = good && below(s.candidate, t.candidates.size()) &&
               below(s.network, plan.stations.size());
    }
    for (const Link& l : plan.links) {
        good = good && below(l.from, plan.stations.size()) && below(l.to, plan.stations.size());
    }
    for (const PieceStatus s : plan.pieces) good = good && below(static_cast<int>(s), 4);
    return good;
}

// Every file of the plan as it was published, and job.toml of the job that made the tables.
void check_published(const RunDir& dir, const std::string& tables_key, Checks& checks) {
    const std::vector<std::string> faults = faults_since_published(dir.path());
    for (const std::string& fault : faults) checks.add(false, fault);
    std::error_code ignored;
    if (std::filesystem::exists(dir.file(lock_name), ignored) && !is_marked(dir.path())) {
        checks.add(false, fmt::format("{}: not the mark of a run directory", lock_name));
    }
    if (faults.empty()) checks.add(true, "all files of the plan are as they were published");
    if (faults.empty()) dir.check_job(tables_key);  // it goes by what these files say
}

// The walls against the site's own file, when it is still what it was.
void check_site(const Config& config, const CoverageTables& t, const FieldFile& field,
                Checks& checks) {
    std::error_code ignored;
    if (!std::filesystem::exists(config.site.input, ignored)) {
        checks.note(fmt::format("{} is not there: walls were not compared with it",
                                config.site.input.string()));
        return;
    }
    if (job_keys(config, InputState(config).sha256()).tables != t.key) {
        checks.note(fmt::format("{} has changed: walls were not compared with it",
                                config.site.input.string()));
        return;
    }
    const Reread found = reread(config, t, &field);
    for (const std::string& line : found.text) checks.add(line.starts_with("yes"), line.substr(5));
}

}  // namespace

VerifyResult verify_run(const std::filesystem::path& path, int thread_count, Progress& progress) {
    const Threads threads(thread_count);
    const RunDir dir(path);
    const Config config = dir.config();
    progress.stage("read");
    const FieldFile field(dir.file(field_name));
    if (!std::filesystem::exists(dir.file(plan_name))) {
        throw IoError(fmt::format("{}: tables, but no plan.h5 yet; make it with vfplan plan {}",
                                  path.string(), path.string()));
    }
    Checks checks;
    check_published(dir, field.info().key, checks);
    const PlanTable table = read_plan(dir.file(plan_name));
    const Candidates candidates = read_candidates(dir.path(), table.pool);
    const CoverageTables& t = candidates.tables;
    const CoverageEntries& entries = candidates.entries;
    const bool one_job = table.key == t.key && field.info().key == t.key;
    const bool fitting = fits(t, table.plan);
    checks.add(one_job, "field, coverage and plan belong to one job");
    checks.add(fitting, "the plan's numbers point into its tables");
    if (!one_job || !fitting) return checks.result();
    SceneOptions options = scene_options(config);
    options.kernel = KernelKind::exact;
    const Layout& layout = field.info().layout;
    const NearWalls near = near_walls(
        layout, t.walls,
        wall_reach_m(options.scanner.range_max_m, options.partition_m, config.site.snap_m));
    Scenes scenes(
        layout, [&](std::int64_t patch) { return patch_site(t.walls, t.pieces, near, patch); },
        options, 16 * threads.count());
    try {
        const Rechecked found = recheck(table, t, threads, scenes, progress);
        check_coverage(table.plan, found, checks);
        check_connection(table, found, checks);
        progress.stage("field");
        check_field(scenes, threads, field, table.plan, config.visibility.kernel, checks);
        check_rays(found.ray_difference, checks);
    } catch (const InputError& e) {  // of walls that no reader makes
        damaged(dir.file(coverage_name), e.what());
    }
    check_bound(t, entries, table, checks);
    check_site(config, t, field, checks);
    progress.finish();
    return checks.result();
}

}  // namespace vfplan
