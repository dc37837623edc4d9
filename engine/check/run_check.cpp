#include "engine/check/run_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "engine/check/proof_check.h"
#include "engine/check/survival_check.h"
#include "kernels/disjoint_sets.h"

namespace vfplan {
namespace {

using Lists = std::vector<std::vector<std::int32_t>>;

Lists near_lists(const OverlapRows& rows, const std::vector<double>& length_m,
                 const OverlapRule& rule) {
    const std::vector<SeenTotal> total = seen_totals(rows, length_m);
    const PieceIndex index = index_of(rows, static_cast<std::int64_t>(length_m.size()));
    PairSearch search(rows, index, length_m, formula(rule.ratio).by_angle);
    Lists near(total.size());
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        search.after(
            c, [](std::int32_t) { return true; },
            [&](std::int32_t n, const SeenJointly& joint) {
                if (!rule.enough(overlap(rule.ratio, total[idx(c)], total[idx(n)], joint))) return;
                near[idx(c)].push_back(n);
                near[idx(n)].push_back(c);
            });
    }
    for (auto& list : near) std::sort(list.begin(), list.end());
    return near;
}

// Components, the one that can cover most length first; of equals the one with the first candidate.
Lists ranked_components(const OverlapRows& rows, const std::vector<double>& length_m,
                        const Lists& near) {
    DisjointSets sets(rows.size());
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        for (const std::int32_t n : near[idx(c)]) sets.merge(c, n);
    }
    Lists members;
    std::vector<std::int32_t> number(near.size(), -1);
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        std::int32_t& mine = number[idx(sets.root(c))];
        if (mine < 0) {
            mine = static_cast<std::int32_t>(members.size());
            members.emplace_back();
        }
        members[idx(mine)].push_back(c);
    }
    std::vector<double> sum_m(members.size(), 0);
    std::vector<std::int32_t> last(length_m.size(), -1);
    for (std::size_t m = 0; m < members.size(); ++m) {
        for (const std::int32_t c : members[m]) {
            for (const std::int32_t p : rows.row(c)) {
                if (std::exchange(last[idx(p)], static_cast<std::int32_t>(m)) !=
                    static_cast<std::int32_t>(m)) {
                    sum_m[m] += length_m[idx(p)];
                }
            }
        }
    }
    std::vector<std::size_t> order(members.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sum_m[a] > sum_m[b]; });
    Lists out;
    for (const std::size_t m : order) out.push_back(std::move(members[m]));
    return out;
}

}  // namespace

RunCheck check_plan(const CoverageTables& t, const CoverageEntries& entries, const PlanTable& table,
                    const Certificate& certificate) {
    const bool by_angle = formula(table.overlap.ratio).by_angle;
    const OverlapRows rows{t.begin, entries.pieces(0, t.entries()),
                           by_angle ? entries.angles_rad(0, t.entries()) : std::vector<float>()};
    const std::vector<double> length_m = piece_lengths_m(t.pieces);
    const Lists near = near_lists(rows, length_m, table.overlap);
    std::vector<std::uint8_t> standing(near.size(), 0);
    for (std::size_t c = 0; c < near.size(); ++c) {
        const CandidateKind kind = t.candidates[c].kind;
        standing[c] = kind == CandidateKind::required || kind == CandidateKind::existing ? 1 : 0;
    }
    std::vector<std::int32_t> owner(length_m.size(), -1);
    Lists networks;
    for (std::vector<std::int32_t>& members : ranked_components(rows, length_m, near)) {
        if (t.candidates[idx(members.front())].kind == CandidateKind::pool) continue;
        bool wanted = false;
        for (const std::int32_t c : members) {
            wanted = wanted || standing[idx(c)] != 0;
            for (const std::int32_t p : rows.row(c)) {
                if (owner[idx(p)] >= 0 && idx(owner[idx(p)]) < networks.size()) continue;
                owner[idx(p)] = static_cast<std::int32_t>(networks.size());
                wanted = true;
            }
        }
        if (wanted) networks.push_back(std::move(members));
    }
    RunCheck out;
    out.stations = static_cast<std::int64_t>(table.plan.stations.size());
    out.networks = static_cast<std::int64_t>(networks.size());
    out.bound = certificate.bound();
    const auto say = [&](std::size_t network, const std::string& what) {
        out.wrong.push_back(fmt::format("network {}: {}", network, what));
    };
    if (certificate.networks.size() != networks.size()) {
        out.wrong.push_back(fmt::format("there are {} networks, and the certificate speaks of {}",
                                        networks.size(), certificate.networks.size()));
        return out;
    }
    // The plan: each network of stations of its own component that cover its pieces and hang
    // together.
    std::vector<std::int32_t> network_of(near.size(), -1);
    std::vector<std::uint8_t> chosen(near.size(), 0);
    for (const Station& s : table.plan.stations) {
        if (s.candidate < 0 || idx(s.candidate) >= near.size()) {
            out.wrong.emplace_back("a station is no candidate");
            return out;
        }
        network_of[idx(s.candidate)] = s.network;
        chosen[idx(s.candidate)] = 1;
    }
    std::vector<std::int32_t> covered(owner.size(), -1);
    const CheckTables tables{rows, near, owner, standing};
    ProofCheck proofs(tables);
    std::int64_t found = 0;
    for (std::size_t k = 0; k < networks.size(); ++k) {
        const auto mine = static_cast<std::int32_t>(k);
        DisjointSets sets(static_cast<std::int64_t>(networks[k].size()));
        std::int64_t parts = 0;
        std::int64_t stations = 0;
        const auto place = [&](std::int32_t c) {
            return static_cast<std::int32_t>(
                std::lower_bound(networks[k].begin(), networks[k].end(), c) - networks[k].begin());
        };
        for (const std::int32_t c : networks[k]) {
            if (network_of[idx(c)] != mine) {
                if (standing[idx(c)] != 0) say(k, "a station is missing that must stand");
                continue;
            }
            ++stations;
            ++parts;
            for (const std::int32_t p : rows.row(c)) {
                if (owner[idx(p)] == mine) covered[idx(p)] = mine;
            }
            for (const std::int32_t n : near[idx(c)]) {
                if (network_of[idx(n)] != mine || sets.together(place(c), place(n))) continue;
                sets.merge(place(c), place(n));
                --parts;
            }
        }
        found += stations;
        if (table.survives) {
            const Survival lost = check_survival({networks[k], chosen, near, rows, owner, mine});
            out.pieces_alone += lost.pieces_alone;
            out.parting += lost.parting;
            if (!lost.wrong.empty()) say(k, lost.wrong);
        }
        if (parts > 1) say(k, fmt::format("its stations are {} parts", parts));
        const NetworkProof& proof = certificate.networks[k];
        if (proof.bound < 0) say(k, "a bound below none says nothing");
        if (proof.bound > stations) say(k, "it needs more stations than it has");
        if (const std::string wrong = proofs.wrong(mine, networks[k], proof); !wrong.empty()) {
            say(k, wrong);
        }
    }
    if (found != out.stations) out.wrong.emplace_back("stations are not of their networks");
    for (std::size_t p = 0; p < owner.size(); ++p) {
        if (owner[p] != covered[p]) say(idx(owner[p]), fmt::format("piece {} is not covered", p));
    }
    return out;
}

}  // namespace vfplan
