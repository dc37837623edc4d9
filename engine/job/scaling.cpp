#include "engine/job/scaling.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/joining/paths.h"
#include "engine/tables/skeleton.h"

namespace vfplan {
namespace {

// How many cells are read for each that is worked on, with so many around each tile.
double with_margin(const Layout& layout, double margin_cells) {
    const auto along = [&](std::int32_t cells) {
        double sum = 0;
        for (double from = 0; from < cells; from += layout.tile_cells) {
            sum += std::min<double>(cells, from + layout.tile_cells + margin_cells) -
                   std::max(0.0, from - margin_cells);
        }
        return sum / cells;
    };
    return along(layout.grid.nx) * along(layout.grid.ny);
}

// What a phase costs for each cell of a grid, in units of its own; 0 for phases that do not go from
// cell to cell.
double cell_cost(const std::string& phase, const Layout& layout, double range_m) {
    const double range_cells = range_m / layout.grid.cell_m;
    if (phase == "field") {
        // Every tile reads which cells of its patches are free, and has room for their field.
        constexpr double read = 5e-3;  // of a view
        const double patch =
            std::sqrt(static_cast<double>(std::min(layout.patch_cells, layout.grid.nx)) *
                      std::min(layout.patch_cells, layout.grid.ny));
        return 1 + read * std::pow(patch / layout.tile_cells, 2);
    }
    if (phase == "skeleton") return with_margin(layout, range_cells + skeleton_margin_cells);
    if (phase == "paths") return with_margin(layout, paths_reach_ranges * range_cells);
    // For each piece all cells in sight are looked at.
    if (phase == "rescues" || phase == "site" || phase == "tables") return 1;
    return 0;
}

// Smaller cells find a few more candidates: a fifth more for each halving or less, on towns and
// floors from 4 m down to 5 cm.
double finer(double tried_m, double cell_m) {
    return std::pow(std::clamp(tried_m / cell_m, 1.0, 8.0), 0.2);
}

// Sums of trials with their weights.
template <class F>
double sum(const std::vector<Weighed>& trials, F&& of) {
    double out = 0;
    for (const Weighed& w : trials) out += w.weight * of(w);
    return out;
}

// `by_count`: what the weighed sums are multiplied by where cells do not decide.
Totals scaled(const std::vector<Weighed>& trials, double by_count, double cells, const Layout& job,
              double range_m) {
    Totals out;
    if (trials.empty()) return out;
    const double more = by_count * finer(trials[0].layout.grid.cell_m, job.grid.cell_m);
    const double ratio = trials[0].layout.grid.cell_m / job.grid.cell_m;
    const double cells_tried = sum(trials, [](const Weighed& w) { return w.trial.cells; });
    out.candidates = more * sum(trials, [](const Weighed& w) { return w.trial.candidates; });
    out.entries = more * sum(trials, [](const Weighed& w) { return w.trial.entries * w.pieces; });
    out.coverage_bytes =
        more * sum(trials, [](const Weighed& w) { return w.trial.coverage_bytes * w.pieces; });
    out.field_bytes =
        cells / cells_tried * sum(trials, [](const Weighed& w) { return w.trial.field_bytes; });
    // Lines of cells.
    out.working_bytes = by_count * std::max(1.0, ratio) *
                        sum(trials, [](const Weighed& w) { return w.trial.working_bytes; });
    for (const auto& [phase, ignored] : trials[0].trial.cpu_s) {
        const auto cpu = [&, &name = phase](const Weighed& w) {
            const auto found = w.trial.cpu_s.find(name);
            if (found == w.trial.cpu_s.end()) return 0.0;
            return found->second * (name == "rescues" || name == "coverage" ? w.pieces : 1);
        };
        const double cost = cell_cost(phase, job, range_m);
        if (cost > 0) {
            const double tried = sum(trials, [&, &name = phase](const Weighed& w) {
                return w.trial.cells * cell_cost(name, w.layout, range_m);
            });
            out.cpu_s += sum(trials, cpu) * cells * cost / tried;
        } else {
            out.cpu_s += more * sum(trials, cpu);
        }
    }
    return out;
}

}  // namespace

Totals& Totals::operator+=(const Totals& o) {
    candidates += o.candidates;
    entries += o.entries;
    field_bytes += o.field_bytes;
    coverage_bytes += o.coverage_bytes;
    working_bytes += o.working_bytes;
    cpu_s += o.cpu_s;
    return *this;
}

Totals scaled_by_walls(const std::vector<Weighed>& trials, double times, double cells,
                       const Layout& job, double range_m) {
    return scaled(trials, times, cells, job, range_m);
}

Totals scaled_by_cells(const std::vector<Weighed>& trials, double cells, const Layout& job,
                       double range_m) {
    const double tried_m2 = sum(
        trials, [](const Weighed& w) { return w.trial.cells * std::pow(w.layout.grid.cell_m, 2); });
    const double m2 = cells * std::pow(job.grid.cell_m, 2);
    return scaled(trials, tried_m2 > 0 ? m2 / tried_m2 : 0, cells, job, range_m);
}

}  // namespace vfplan
