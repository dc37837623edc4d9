// task_times DIR: what each task of the parallel stages takes, for the model of bench/scaling.py.
//
// Does the field and the coverage rows of a finished run again on one thread, task by task as
// visibility_field and Viewer::rows cut them, and prints processor seconds as CSV. An answer that
// differs from the run's tables ends the program: the time of a wrong answer is worth nothing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>

#include "engine/run_dir.h"
#include "engine/tables_stage.h"
#include "engine/viewer.h"
#include "io/tables.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr int passes = 3;
constexpr std::int64_t eyes_per_task = 4;  // the grain of Viewer::rows

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
    std::vector<Task> tasks(at(count));
    for (int pass = 0; pass < passes; ++pass) {
        for (std::int64_t i = 0; i < count; ++i) {
            const double begin_s = thread_cpu_s();
            tasks[at(i)].items = work(i);
            tasks[at(i)].seconds = std::min(tasks[at(i)].seconds, thread_cpu_s() - begin_s);
        }
    }
    return tasks;
}

std::vector<Task> field_tasks(const ViewKernel& kernel, const Scanner& scanner,
                              const FieldTable& field) {
    const Grid& grid = field.grid;
    Raster<std::uint8_t> standable(field.vf_rad.size(), 0);
    std::transform(field.vf_rad.begin(), field.vf_rad.end(), standable.begin(),
                   [](float v) { return static_cast<std::uint8_t>(std::isnan(v) ? 0 : 1); });
    Raster<float> vf_rad(standable.size(), std::numeric_limits<float>::quiet_NaN());
    const std::int32_t columns = (grid.nx + window_cells - 1) / window_cells;
    const std::int32_t rows = (grid.ny + window_cells - 1) / window_cells;
    std::vector<Task> tasks = best_of_passes(std::int64_t{columns} * rows, [&](std::int64_t w) {
        const auto x = static_cast<std::int32_t>(w % columns) * window_cells;
        const auto y = static_cast<std::int32_t>(w / columns) * window_cells;
        const Window window{x, y, std::min(x + window_cells, grid.nx),
                            std::min(y + window_cells, grid.ny)};
        return kernel.field(scanner, grid, window, standable, vf_rad).cells;
    });
    for (std::int64_t i = 0; i < grid.size(); ++i) {
        const float was = field.vf_rad[at(i)];
        const float is = vf_rad[at(i)];
        if (standable[at(i)] == 0 || was == is) continue;
        throw Differs(fmt::format("field.h5 has {} rad at cell ({}, {}) and this program {}", was,
                                  grid.ix(i), grid.iy(i), is));
    }
    return tasks;
}

std::vector<Task> coverage_tasks(const Viewer& viewer, const CoverageTables& t) {
    const auto eyes = static_cast<std::int64_t>(t.candidates.size());
    std::vector<CoverageRow> rows(at(eyes));
    std::vector<Task> tasks =
        best_of_passes((eyes + eyes_per_task - 1) / eyes_per_task, [&](std::int64_t task) {
            const std::int64_t from = task * eyes_per_task;
            const std::int64_t to = std::min(from + eyes_per_task, eyes);
            for (std::int64_t i = from; i < to; ++i) {
                rows[at(i)] = viewer.row(t.candidates[at(i)].at);
            }
            return to - from;
        });
    for (std::int64_t i = 0; i < eyes; ++i) {
        const bool same = std::equal(rows[at(i)].begin(), rows[at(i)].end(), t.table.row_begin(i),
                                     t.table.row_end(i), [](const Seen& a, const Seen& b) {
                                         return a.piece == b.piece && a.fraction == b.fraction &&
                                                a.angle_rad == b.angle_rad;
                                     });
        if (!same) throw Differs(fmt::format("coverage.h5 has other pieces for candidate {}", i));
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
    const FieldTable field = read_field(dir.file("field.h5"));
    const CoverageTables t = read_coverage(dir.file("coverage.h5"));
    Box box{field.grid.origin,
            field.grid.origin + field.grid.cell_m * Vec2d(field.grid.nx, field.grid.ny)};
    for (const Candidate& c : t.candidates) box.add(c.at);
    const Scanner scanner = scanner_of(config);
    const auto of_field =
        make_kernel(config.visibility.kernel, t.walls, box, scanner.range_max_m, rays_of(config));
    const auto exact = make_kernel("exact", t.walls, box, scanner.range_max_m, 0);
    const Viewer viewer(*exact, t.walls, t.pieces, scanner, config.coverage.visible_fraction);
    const std::vector<Task> windows = field_tasks(*of_field, scanner, field);
    const std::vector<Task> rows = coverage_tasks(viewer, t);
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
