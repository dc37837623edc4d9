// A scanner in a site: views, field values and coverage rows, patch by patch.
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "io/tables/site_store.h"
#include "kernels/coverage.h"
#include "kernels/index.h"
#include "kernels/layout.h"
#include "kernels/overlap_rows.h"
#include "kernels/view.h"

namespace vfplan {

// The walls in and around one patch, ready to be looked at. Points go in and come out in the site's
// frame, pieces in the site's numbering. Thread-safe.
class Scene {
public:
    Scene(const Layout& layout, std::int64_t patch, const PatchSite& site,
          const SceneOptions& options);

    // One view, read twice: VF and the coverage row.
    struct Look {
        double vf_rad = 0;
        CoverageRow row;
        std::vector<double> length_m;  // of each piece of the row, as the site reckons it

        OverlapRow overlap_row() const { return {row, length_m}; }
    };
    // REQUIRES: the eye lies in the patch, or within eye_margin_m of it.
    Look look(const Vec2d& eye) const;
    // Only the pieces of that row.
    std::vector<std::int32_t> covered(const Vec2d& eye) const;

    // Before the first field() of a patch: takes rays enough that the field's mean error at a
    // sample of its cells is well below what verify allows. Depends on the patch alone. `standable`
    // covers it.
    void take_rays_enough(const Raster<std::uint8_t>& standable) const;

    // VF of a window of the patch, counted from its corner; see ViewKernel::field. Both rasters
    // cover the patch.
    FieldCounts field(const Window& window, const Raster<std::uint8_t>& standable,
                      Raster<float>& vf_rad) const;

    double bytes() const;  // that it takes, roughly

    // The patch's frame, for those who ask the exact kernel themselves.
    const Vec2d& origin() const { return origin_; }
    const ViewKernel& exact() const { return *exact_; }
    const std::vector<Wall>& walls() const { return walls_; }  // patch frame
    const Pieces& pieces() const { return pieces_; }           // of these walls, numbered from 0
    std::int32_t site_piece(std::int32_t piece) const { return site_piece_[idx(piece)]; }

private:
    View observed(const Vec2d& here) const;  // in the patch's frame

    SceneOptions options_;
    Vec2d origin_;
    Grid grid_;  // the patch's cells in its own frame
    std::vector<Wall> walls_;
    Pieces pieces_;
    std::vector<std::int32_t> site_piece_;
    std::vector<double> length_m_;
    std::unique_ptr<ViewKernel> exact_;
    Box around_;
    mutable std::mutex taking_rays_;
    mutable bool rays_taken_ = false;
    mutable std::unique_ptr<ViewKernel> of_field_;  // null: the exact one
};

// The walls in and around a patch with their pieces, from those of the whole site. `near`: see
// near_walls().
PatchSite patch_site(const std::vector<Wall>& walls, const Pieces& pieces, const NearWalls& near,
                     std::int64_t patch);

// Scenes as they are needed; the latest are kept, as far as a quarter of the memory that was left
// holds them. Thread-safe.
class Scenes {
public:
    // `site`: gives the walls of a patch; called from any thread.
    Scenes(const Layout& layout, std::function<PatchSite(std::int64_t)> site,
           const SceneOptions& options, int kept);

    const Layout& layout() const { return layout_; }
    const SceneOptions& options() const { return options_; }
    std::shared_ptr<const Scene> of_patch(std::int64_t patch);
    std::shared_ptr<const Scene> at_point(const Vec2d& point) {
        return of_patch(layout_.patch_of(layout_.cell_at(point)));
    }
    Scene::Look look(const Vec2d& eye) { return at_point(eye)->look(eye); }

    // f(i, scene of points[i]) for each i, in parallel, patch by patch.
    void each(const Threads& threads, const std::vector<Vec2d>& points,
              const std::function<void(std::size_t, const Scene&)>& f);
    // Rows of many eyes, in their order.
    std::vector<OverlapRow> overlap_rows(const Threads& threads, const std::vector<Vec2d>& eyes);

private:
    struct Entry {
        std::mutex making;
        std::shared_ptr<const Scene> scene;
        double bytes = 0;  // of the scene, when it is made; under guard_
    };
    void make_room();
    Layout layout_;
    std::function<PatchSite(std::int64_t)> site_;
    SceneOptions options_;
    std::size_t kept_;
    double bytes_most_;
    double bytes_ = 0;  // of those that are kept
    std::mutex guard_;
    std::list<std::int64_t> latest_;  // patches, the last used one first
    std::unordered_map<std::int64_t,
                       std::pair<std::list<std::int64_t>::iterator, std::shared_ptr<Entry>>>
        entries_;
};

}  // namespace vfplan
