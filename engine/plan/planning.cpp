#include "engine/plan/planning.h"

#include "engine/plan/overlap_graph.h"
#include "engine/plan/roles.h"

namespace vfplan {

PlanTables plan_tables_of(const CoverageTables& t, const CoverageEntries& entries,
                          OverlapRatio ratio) {
    const std::int64_t all = t.entries();
    return {t,
            {t.begin, entries.pieces(0, all),
             formula(ratio).by_angle ? entries.angles_rad(0, all) : std::vector<float>()},
            piece_lengths_m(t.pieces),
            [&entries](std::int64_t from, std::int64_t count) {
                return entries.angles_rad(from, count);
            }};
}

Planned plan_stations(const PlanTables& t, const PlanOptions& options, double range_max_m,
                      const Threads& threads, Progress& progress) {
    Planned out;
    progress.stage("overlap");
    const Graph graph =
        make_graph(overlap_pairs(threads, t.rows, t.piece_length_m, options.overlap));
    const PlanInput input{t.coverage.candidates, t.rows, t.piece_length_m, t.coverage.status,
                          graph};
    progress.stage("plan");
    out.plan = make_plan(threads, input, options, out.report, &progress);
    out.loops = options.loops;
    add_ratios(input, t.angles, out.plan);
    add_roles(input, out.plan);
    progress.stage("metrics");
    out.metrics = measure(threads, input, out.plan,
                          PiecePlaces(t.coverage.walls, t.coverage.pieces), range_max_m);
    progress.stage("join_thresholds");
    out.join_thresholds =
        find_join_thresholds(threads, input, options.overlap, t.coverage.apart, out.plan);
    return out;
}

}  // namespace vfplan
