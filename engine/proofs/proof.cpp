#include "engine/proofs/proof.h"

#include <algorithm>

#include "engine/proofs/cases.h"
#include "engine/proofs/multipliers.h"
#include "engine/proofs/windows.h"
#include "engine/search/reduce.h"

namespace vfplan {
namespace {

constexpr std::int64_t rounds = 1500;
// Larger programs would not be solved.
constexpr std::int32_t most_columns = 6000;
constexpr std::size_t most_ways = 24000;

NetworkProof begin_proof(const Reduced& reduced, const Root& root) {
    NetworkProof out;
    for (const GoneColumn& g : reduced.gone) out.gone.push_back({g.gone, g.by});
    out.root_piece = root.row;
    out.root_station = root.column;
    return out;
}

NetworkProof weighed(const Reduced& reduced, const Root& root, std::int64_t stations) {
    const Problem& p = reduced.problem;
    NetworkProof out = begin_proof(reduced, root);
    out.cases.emplace_back();
    const std::vector<std::int64_t> weight = weigh_rows(p, stations, rounds);
    for (std::int32_t r = 0; r < p.rows(); ++r) {
        if (weight[idx(r)] == 0) continue;
        out.cases.front().weights.push_back(
            {static_cast<std::int32_t>(out.lines.size()), weight[idx(r)]});
        out.lines.push_back({LineKind::cover, r, {}});
    }
    Lines lines(p, root);
    Weighing weighing(lines);
    const std::vector<Known> nothing(idx(p.columns()), Known::free);
    out.bound = std::min(
        stations, stations_of(weighing.value(out.lines, out.cases.front().weights, nothing)));
    return out;
}

// Made better piece by piece.
NetworkProof by_windows(const Reduced& reduced, const Root& root, const NetworkProof& weighed,
                        Effort& effort) {
    const Problem& p = reduced.problem;
    std::vector<std::int64_t> weight(idx(p.rows()), 0);
    for (const LineWeight& w : weighed.cases.front().weights) {
        weight[idx(weighed.lines[idx(w.line)].of)] = w.weight;
    }
    Weighed better = weigh_by_windows(p, root, weight, effort);
    NetworkProof out = begin_proof(reduced, root);
    Lines lines(p, root);
    const std::vector<Known> nothing(idx(p.columns()), Known::free);
    out.bound = stations_of(Weighing(lines).value(better.lines, better.weights, nothing));
    out.lines = std::move(better.lines);
    out.cases.push_back({-1, std::move(better.weights)});
    return out;
}

}  // namespace

void renumber(const std::vector<std::int32_t>& column, const std::vector<std::int32_t>& row,
              NetworkProof& proof) {
    const auto turn = [](std::int32_t& number, const std::vector<std::int32_t>& into) {
        if (number >= 0) number = into[idx(number)];
    };
    turn(proof.root_piece, row);
    turn(proof.root_station, column);
    for (ProofLine& line : proof.lines) {
        turn(line.of, is_of_piece(line.kind) ? row : column);
        for (std::int32_t& c : line.within) turn(c, column);
    }
    for (ProofCase& c : proof.cases) turn(c.branch, column);
}

NetworkProof weighed_proof(const Problem& problem, const Choice& plan) {
    const Reduced reduced = reduce(problem);
    NetworkProof out =
        weighed(reduced, root_of(reduced.problem), static_cast<std::int64_t>(plan.size()));
    renumber(reduced.column, reduced.row, out);
    return out;
}

Proven prove(const Problem& problem, const Choice& plan, std::int64_t effort_millions) {
    const Reduced reduced = reduce(problem);
    const Problem& p = reduced.problem;
    const Root root = root_of(p);
    const auto stations = static_cast<std::int64_t>(plan.size());
    NetworkProof best = weighed(reduced, root, stations);
    Choice found = reduced_choice(reduced, problem.columns(), plan);
    Effort effort{effort_millions * 1'000'000};
    const auto is_open = [&] { return best.bound < static_cast<std::int64_t>(found.size()); };
    if (is_open() && p.columns() <= most_columns) {
        Lines lines(p, root);
        const auto take = [&](const Cases& cases) {
            if (cases.plan().size() < found.size()) found = cases.plan();
            if (cases.bound() <= best.bound) return;
            best = begin_proof(reduced, root);
            cases.write(best);
        };
        std::vector<ProofLine> start;
        for (const LineWeight& w : best.cases.front().weights) {
            start.push_back(best.lines[idx(w.line)]);
        }
        // Columns alone first: much smaller programs, whose lines serve the larger ones.
        const bool ways = p.near.to.size() <= most_ways;
        Effort part{ways ? effort.left / 3 : effort.left};
        effort.left -= part.left;
        Cases by_nodes(lines, found, false, start);
        by_nodes.run(part, !ways);
        take(by_nodes);
        effort.left += part.left;
        if (is_open() && ways) {
            Cases by_ways(lines, found, true, by_nodes.lines_of_first());
            by_ways.run(effort, true);
            take(by_ways);
        }
    }
    if (is_open() && p.columns() > most_columns) {
        NetworkProof better = by_windows(reduced, root, best, effort);
        if (better.bound > best.bound) best = std::move(better);
    }
    Proven out{std::move(best), {}};
    renumber(reduced.column, reduced.row, out.proof);
    for (const std::int32_t c : found) out.plan.push_back(reduced.column[idx(c)]);
    return out;
}

}  // namespace vfplan
