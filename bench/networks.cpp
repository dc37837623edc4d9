#include "bench/networks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>

#include "bench/scenes.h"
#include "engine/graphs/cuts.h"
#include "engine/job/tables.h"
#include "engine/plan/greedy.h"
#include "engine/plan/network_problem.h"
#include "engine/plan/overlap_graph.h"
#include "engine/plan/planning.h"
#include "engine/pool/pool.h"

namespace vfplan::bench {
namespace {

// The component that covers most length; required stations are none in these sites.
std::vector<std::int32_t> largest(const PlanInput& in) {
    const std::vector<std::int32_t> number = components(in.graph);
    std::vector<std::vector<std::int32_t>> members;
    for (std::int32_t c = 0; c < in.graph.size(); ++c) {
        members.resize(std::max(members.size(), idx(number[idx(c)]) + 1));
        members[idx(number[idx(c)])].push_back(c);
    }
    std::vector<std::int32_t> last(in.piece_length_m.size(), -1);
    std::size_t best = 0;
    double most = -1;
    for (std::size_t m = 0; m < members.size(); ++m) {
        double length = 0;
        for (const std::int32_t c : members[m]) {
            for (const std::int32_t p : in.rows.row(c)) {
                if (last[idx(p)] != static_cast<std::int32_t>(m))
                    length += in.piece_length_m[idx(p)];
                last[idx(p)] = static_cast<std::int32_t>(m);
            }
        }
        if (length > most) best = m;
        most = std::max(most, length);
    }
    return members[best];
}

MainNetwork made(const Scene& site, const std::filesystem::path& dir) {
    MainNetwork out;
    out.options = plan_options(site.config);
    const Threads threads(1);
    const Ranks ranks;
    Progress progress(true);
    write_site(site, dir, "bench");
    const TableOptions options = table_options(site.config);
    make_tables(options, dir, "bench", threads, ranks, progress);
    if (options.pool) make_pool(dir, *options.pool, threads, ranks, progress);
    const Candidates candidates = read_candidates(dir, out.options.candidates);
    const PlanTables t =
        plan_tables_of(candidates.tables, candidates.entries, out.options.overlap.ratio);
    const Graph graph =
        make_graph(overlap_pairs(threads, t.rows, t.piece_length_m, out.options.overlap));
    const PlanInput in{t.coverage.candidates, t.rows, t.piece_length_m, t.coverage.status, graph};
    out.table = {t.rows.begin, t.rows.piece};
    out.piece_length_m = t.piece_length_m;

    const std::vector<std::int32_t> members = largest(in);
    std::vector<std::int32_t> owner(t.piece_length_m.size(), -1);
    std::vector<std::uint8_t> wanted(owner.size(), 0);
    for (const std::int32_t c : members) {
        for (const std::int32_t p : t.rows.row(c)) {
            owner[idx(p)] = 0;
            wanted[idx(p)] = 1;
        }
    }
    Workspace work(graph);
    const std::clock_t before = std::clock();
    out.greedy = columns_of(members, choose_greedily(in, members, {}, wanted, work));
    out.greedy_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    NetworkProblems problems(in);
    out.problem = problems.of(members, owner, 0, std::vector<std::uint8_t>(idx(graph.size()), 0),
                              ProblemRows::all);
    for (const std::int32_t p : problems.pieces()) {
        out.row_length_m.push_back(t.piece_length_m[idx(p)]);
    }
    out.problem.block = find_cuts(induced(graph, members)).block;
    out.problem.loose.assign(idx(out.problem.columns()), 1);
    return out;
}

}  // namespace

const MainNetwork* main_network(const std::string& site) {
    static std::map<std::string, std::unique_ptr<MainNetwork>> all;
    const auto found = all.find(site);
    if (found != all.end()) return found->second.get();
    std::unique_ptr<MainNetwork>& network = all[site];
    if (const Scene* s = scene(site)) {
        const std::filesystem::path dir = std::filesystem::temp_directory_path() /
                                          fmt::format("vfplan_bench_{}_{}", site, getpid());
        network = std::make_unique<MainNetwork>(made(*s, dir));
        std::error_code ignored;
        std::filesystem::remove_all(dir, ignored);
    }
    return network.get();
}

}  // namespace vfplan::bench
