#include "engine/joining/knowledge.h"

#include <algorithm>
#include <mutex>

#include "kernels/disjoint_sets.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int64_t at_once = 2048;

// f(number of the first, looks) for all candidates, some at a time.
template <class F>
void look_from_all(const TableJob& job, const CandidateList& candidates, F&& f) {
    for (std::int64_t from = 0; from < candidates.size(); from += at_once) {
        const std::int64_t to = std::min(candidates.size(), from + at_once);
        std::vector<Vec2d> eyes;
        for (const Candidate& c : candidates.read(from, to)) eyes.push_back(c.at);
        std::vector<Scene::Look> looks(eyes.size());
        job.scenes.each(job.threads, eyes,
                        [&](std::size_t i, const Scene& scene) { looks[i] = scene.look(eyes[i]); });
        f(from, looks);
    }
}

}  // namespace

std::vector<PieceComponent> pieces_of_components(const TableJob& job,
                                                 const CandidateList& candidates,
                                                 const std::vector<std::int32_t>& component) {
    std::vector<PieceComponent> out;
    look_from_all(job, candidates, [&](std::int64_t first, const std::vector<Scene::Look>& looks) {
        std::vector<PieceComponent> some;
        for (std::size_t i = 0; i < looks.size(); ++i) {
            for (const Seen& s : looks[i].row) {
                some.emplace_back(s.piece, component[idx(first) + i]);
            }
        }
        sort_once(some);
        out.insert(out.end(), some.begin(), some.end());
    });
    sort_once(out);
    return out;
}

CandidateRows candidates_covering(const TableJob& job, const CandidateList& candidates,
                                  const std::vector<bool>& pieces) {
    CandidateRows out;
    look_from_all(job, candidates, [&](std::int64_t first, const std::vector<Scene::Look>& looks) {
        for (std::size_t i = 0; i < looks.size(); ++i) {
            const CoverageRow& row = looks[i].row;
            if (std::none_of(row.begin(), row.end(),
                             [&](const Seen& s) { return pieces[idx(s.piece)]; })) {
                continue;
            }
            out.number.push_back(static_cast<std::int32_t>(idx(first) + i));
            out.rows.push_back(looks[i].overlap_row());
        }
    });
    return out;
}

std::vector<std::int32_t> spaces_of_pieces(const TableJob& job, const SiteStore& site,
                                           const Pieces& pieces) {
    const Layout& layout = job.layout();
    DisjointSets sides(2 * pieces.walls());
    std::mutex merging;
    job.threads.for_each(layout.patches(), 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t patch = from; patch < to; ++patch) {
            if (!site.has_walls(patch)) continue;
            const PatchSite near = site.patch(patch);
            const WeakView view = weak_view(job, near, patch);
            std::vector<std::int32_t> first(idx(view.spaces()), -1);
            const std::lock_guard lock(merging);
            for (std::size_t w = 0; w < near.walls.size(); ++w) {
                for (const Side side : {left, right}) {
                    const std::int32_t space = view.space(static_cast<std::int32_t>(w), side);
                    if (space < 0) continue;
                    const std::int32_t me = 2 * near.number[w] + side;
                    std::int32_t& other = first[idx(space)];
                    if (other < 0) other = me;
                    if (!sides.together(me, other)) sides.merge(me, other);
                }
            }
        }
    });
    std::vector<std::int32_t> out(idx(pieces.size()));
    for (std::int32_t w = 0; w < pieces.walls(); ++w) {
        for (const Side side : {left, right}) {
            const std::int32_t space = sides.root(2 * w + side);
            const std::int32_t begin = pieces.first(w, side);
            for (std::int32_t k = 0; k < pieces.count(w, side); ++k) out[idx(begin + k)] = space;
        }
    }
    return out;
}

WeakView weak_view(const TableJob& job, const PatchSite& near, std::int64_t patch) {
    std::vector<Wall> walls = near.walls;
    const Layout& layout = job.layout();
    const Vec2d origin = layout.patch_origin(patch);
    for (Wall& w : walls) {
        w.a -= origin;
        w.b -= origin;
    }
    const Window window = layout.patch_window(patch);
    const double reach = job.scenes.options().scanner.range_max_m;
    const Vec2d margin(reach, reach);
    const Vec2d size(layout.grid.cell_m * (window.x_end - window.x_begin),
                     layout.grid.cell_m * (window.y_end - window.y_begin));
    return {walls, Box{-margin, size + margin}};
}

}  // namespace vfplan
