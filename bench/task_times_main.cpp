// task_times DIR: what each task of the parallel stages takes, for the model of bench/scaling.py.
//
// Does the field and the coverage rows of a finished run again on one thread, in the portions that
// threads take them in, and prints processor seconds as CSV. The scenes of the patches are made
// beforehand and not counted. An answer that differs from the run's tables ends the program: the
// time of a wrong answer is worth nothing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>

#include "engine/config/options.h"
#include "engine/folder/run_dir.h"
#include "engine/tables/scenes.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr int passes = 3;
constexpr std::int32_t window_cells = 32;   // of the field
constexpr std::int64_t eyes_per_task = 16;  // the grain of Scenes::each

// The run's tables are not what this program computes.
struct Differs : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Task {
    std::int64_t items = 0;
    double seconds = std::numeric_limits<double>::infinity();
};

double thread_cpu_s() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Whole passes over all tasks, so that a task finds in the caches what its neighbour left there,
// as in a run, and not its own last pass. `work` returns the number of items of a task.
std::vector<Task> best_of_passes(std::int64_t count,
                                 const std::function<std::int64_t(std::int64_t)>& work) {
    std::vector<Task> tasks(idx(count));
    for (int pass = 0; pass < passes; ++pass) {
        for (std::int64_t i = 0; i < count; ++i) {
            const double begin_s = thread_cpu_s();
            tasks[idx(i)].items = work(i);
            tasks[idx(i)].seconds = std::min(tasks[idx(i)].seconds, thread_cpu_s() - begin_s);
        }
    }
    return tasks;
}

// Windows of the patches, as threads take them of a tile that holds whole patches.
std::vector<Task> field_tasks(Scenes& scenes, const FieldFile& field) {
    const Layout& layout = scenes.layout();
    struct Part {
        std::int64_t patch;
        Window window;  // of the patch
    };
    std::vector<Part> parts;
    std::vector<Raster<float>> was(idx(layout.patches()));
    std::vector<Raster<float>> is(was.size());
    std::vector<Raster<std::uint8_t>> standable(was.size());
    for (std::int64_t p = 0; p < layout.patches(); ++p) {
        const Window w = layout.patch_window(p);
        was[idx(p)] = field.read(w);
        is[idx(p)] = was[idx(p)];
        for (float& v : is[idx(p)]) {
            standable[idx(p)].push_back(std::isnan(v) ? 0 : 1);
            if (!std::isnan(v)) v = 0;
        }
        scenes.of_patch(p);
        const std::int32_t nx = w.x_end - w.x_begin;
        const std::int32_t ny = w.y_end - w.y_begin;
        for (std::int32_t y = 0; y < ny; y += window_cells) {
            for (std::int32_t x = 0; x < nx; x += window_cells) {
                parts.push_back(
                    {p, {x, y, std::min(x + window_cells, nx), std::min(y + window_cells, ny)}});
            }
        }
    }
    std::vector<Task> tasks =
        best_of_passes(static_cast<std::int64_t>(parts.size()), [&](std::int64_t i) {
            const Part& part = parts[idx(i)];
            return scenes.of_patch(part.patch)
                ->field(part.window, standable[idx(part.patch)], is[idx(part.patch)])
                .cells;
        });
    for (std::size_t p = 0; p < was.size(); ++p) {
        for (std::size_t i = 0; i < was[p].size(); ++i) {
            if (standable[p][i] == 0 || was[p][i] == is[p][i]) continue;
            throw Differs(
                fmt::format("field.h5 has {} rad at cell {} of patch {} and this program "
                            "{}",
                            was[p][i], i, p, is[p][i]));
        }
    }
    return tasks;
}

std::vector<Task> coverage_tasks(Scenes& scenes, const CoverageTables& t,
                                 const CoverageEntries& entries) {
    const auto eyes = static_cast<std::int64_t>(t.candidates.size());
    std::vector<CoverageRow> rows(idx(eyes));
    std::vector<Task> tasks =
        best_of_passes((eyes + eyes_per_task - 1) / eyes_per_task, [&](std::int64_t task) {
            const std::int64_t from = task * eyes_per_task;
            const std::int64_t to = std::min(from + eyes_per_task, eyes);
            for (std::int64_t i = from; i < to; ++i) {
                rows[idx(i)] = scenes.look(t.candidates[idx(i)].at).row;
            }
            return to - from;
        });
    constexpr std::int64_t at_once = 2048;  // rows: a read of the tables costs a chunk at least
    for (std::int64_t first = 0; first < eyes; first += at_once) {
        const std::int64_t last = std::min(first + at_once, eyes);
        const std::int64_t from = t.begin[idx(first)];
        const std::int64_t count = t.begin[idx(last)] - from;
        const auto pieces = entries.pieces(from, count);
        const auto fractions = entries.fractions(from, count);
        const auto angles = entries.angles_rad(from, count);
        for (std::int64_t i = first; i < last; ++i) {
            auto k = idx(t.begin[idx(i)] - from);
            bool same = static_cast<std::int64_t>(rows[idx(i)].size()) ==
                        t.begin[idx(i) + 1] - t.begin[idx(i)];
            for (const Seen& s : rows[idx(i)]) {
                if (!same) break;
                same =
                    s.piece == pieces[k] && s.fraction == fractions[k] && s.angle_rad == angles[k];
                ++k;
            }
            if (!same) {
                throw Differs(fmt::format("coverage.h5 has other pieces for candidate {}", i));
            }
        }
    }
    return tasks;
}

void print(const char* stage, const std::vector<Task>& tasks) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        fmt::print("{},{},{},{:.9f}\n", stage, i, tasks[i].items, tasks[i].seconds);
    }
}

void measure(const RunDir& dir) {
    const Config config = dir.config();
    const FieldFile field(dir.file("field.h5"));
    const CoverageTables t = read_coverage(dir.file("coverage.h5"));
    const CoverageEntries entries(dir.file("coverage.h5"));
    const Layout& layout = field.info().layout;
    const SceneOptions options = scene_options(config);
    const NearWalls near = near_walls(
        layout, t.walls,
        wall_reach_m(options.scanner.range_max_m, options.partition_m, config.site.snap_m));
    Scenes scenes(
        layout, [&](std::int64_t patch) { return patch_site(t.walls, t.pieces, near, patch); },
        options, static_cast<int>(layout.patches()));
    const std::vector<Task> windows = field_tasks(scenes, field);
    const std::vector<Task> rows = coverage_tasks(scenes, t, entries);
    fmt::print("stage,task,items,seconds\n");
    print("field", windows);
    print("coverage", rows);
}

}  // namespace
}  // namespace vfplan

int main(int argc, char** argv) {
    try {
        if (argc != 2) {
            throw vfplan::UsageError("one folder is needed; task_times DIR, DIR of a finished run");
        }
        vfplan::measure(vfplan::RunDir(argv[1]));
        return 0;
    } catch (const vfplan::Error& e) {
        fmt::print(stderr, "task_times: {}\n", e.what());
        return static_cast<int>(e.code());
    } catch (const vfplan::Differs& e) {
        fmt::print(stderr, "task_times: {}; make the run again with the program of this build\n",
                   e.what());
        return 1;
    } catch (const std::exception& e) {
        fmt::print(stderr, "task_times: {}; this is a bug, please report it\n", e.what());
        return 70;
    }
}
