#include "engine/joining/connectors.h"

#include <algorithm>
#include <tuple>

#include "kernels/disjoint_sets.h"
#include "kernels/index.h"
#include "kernels/overlap_rows.h"
#include "kernels/ridges.h"

namespace vfplan {
namespace {

constexpr std::size_t paths_at_once = 64;  // in one shard

// A point of a path, looked from.
struct Stand {
    Vec2d at{0, 0};
    std::size_t step = 0;  // on the path, or no_step between two steps
    OverlapRow row;
};
constexpr std::size_t no_step = static_cast<std::size_t>(-1);

// Tries to connect the two ends of a path.
class Connecting {
public:
    Connecting(const TableJob& job, const OverlapRule& rule, const std::vector<std::int64_t>& cells)
        : job_(job), rule_(rule), cells_(cells) {}

    Connection run() {
        Connection out;
        out.good = between(look(0), look(cells_.size() - 1));
        if (!out.good) return out;
        for (const Stand& s : stands_) {
            out.connectors.push_back({s.at, s.step == no_step ? -1 : cells_[s.step]});
        }
        return out;
    }

private:
    Stand look(std::size_t step) const {
        const Vec2d at = job_.layout().grid.centre(cells_[step]);
        return {at, step, job_.scenes.look(at).overlap_row()};
    }

    // Depth first and from the near end, so that a path that cannot be connected is soon given up.
    bool between(const Stand& a, const Stand& b) {
        if (rule_.enough(overlap(rule_.ratio, a.row, b.row))) return true;
        Stand middle;
        if (a.step != no_step && b.step != no_step && b.step >= a.step + 2) {
            middle = look(arc_middle(job_.layout().grid, cells_, a.step, b.step));
        } else {
            if ((b.at - a.at).norm() / 2 < least_step_m) return false;
            middle.step = no_step;
            middle.at = (a.at + b.at) / 2;
            middle.row = job_.scenes.look(middle.at).overlap_row();
        }
        if (middle.row.empty()) return false;
        if (!between(a, middle) || !between(middle, b)) return false;
        stands_.push_back(std::move(middle));
        return true;
    }

    const TableJob& job_;
    const OverlapRule& rule_;
    const std::vector<std::int64_t>& cells_;
    std::vector<Stand> stands_;
};

// Takes connections, the shortest paths first, while they join what is apart. `components`: how
// many there are, before and after.
std::vector<Candidate> chosen_connectors(const std::vector<ShortestPath>& paths,
                                         const std::vector<Connection>& connections,
                                         std::int64_t& components) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (connections[i].good) order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tuple(paths[a].order(), paths[a].components()) <
               std::tuple(paths[b].order(), paths[b].components());
    });
    DisjointSets sets(components);
    std::vector<Candidate> out;
    for (const std::size_t i : order) {
        const auto [a, b] = paths[i].components();
        if (sets.together(a, b)) continue;
        sets.merge(a, b);
        --components;
        for (const Connector& c : connections[i].connectors) {
            out.push_back({c.at, c.cell, CandidateKind::connector, 0});
        }
    }
    return out;
}

}  // namespace

CandidateList make_connectors(const TableJob& job, const CandidateList& candidates,
                              const Components& components, const std::vector<ShortestPath>& paths,
                              const std::vector<Candidate>& of_user, const OverlapRule& rule) {
    const ShardNames names = job.passing("connectors");
    const auto shards =
        static_cast<std::int64_t>((paths.size() + paths_at_once - 1) / paths_at_once);
    make_shards(job, names, shards, [&](std::int64_t shard, const std::filesystem::path& path) {
        const std::size_t from = idx(shard) * paths_at_once;
        std::vector<Connection> some(std::min(paths.size() - from, paths_at_once));
        job.threads.for_each(
            static_cast<std::int64_t>(some.size()), 1, [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t i = begin; i < end; ++i) {
                    some[idx(i)] = Connecting(job, rule, paths[from + idx(i)].cells).run();
                }
            });
        write_connections(path, job.key, some);
    });
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        std::vector<Candidate> all = candidates.read(0, candidates.listed());
        std::vector<std::int64_t> taken;
        for (const Candidate& c : all) taken.push_back(c.cell);
        std::sort(taken.begin(), taken.end());
        std::vector<Connection> connections;
        for (std::int64_t shard = 0; shard < shards; ++shard) {
            for (Connection& c : read_connections(names.one(shard))) {
                connections.push_back(std::move(c));
            }
        }
        std::int64_t count = components.count();
        for (const Candidate& c : chosen_connectors(paths, connections, count)) {
            if (c.cell >= 0 && std::binary_search(taken.begin(), taken.end(), c.cell)) continue;
            all.push_back(c);
        }
        write_candidate_list(path, job.key, job.layout(), std::move(all), {count});
    });
    return {names.whole(), job.layout(), of_user};
}

}  // namespace vfplan
