#include "engine/tables/scenes.h"

#include <algorithm>
#include <numeric>

#include "engine/runtime/memory.h"
#include "kernels/index.h"

namespace vfplan {

Scene::Scene(const Layout& layout, std::int64_t patch, const PatchSite& site,
             const SceneOptions& options)
    : options_(options), origin_(layout.patch_origin(patch)) {
    const Window window = layout.patch_window(patch);
    grid_ = {
        {0, 0}, layout.grid.cell_m, window.x_end - window.x_begin, window.y_end - window.y_begin};
    walls_ = site.walls;
    for (std::size_t w = 0; w < walls_.size(); ++w) {
        const double length = walls_[w].length_m();  // in the site's frame, as everybody reckons it
        for (Wall& wall = walls_[w]; Vec2d * end : {&wall.a, &wall.b}) *end -= origin_;
        const auto on = [&](Side side) { return site.first[side][w] >= 0 ? site.count[w] : 0; };
        pieces_.add_wall(walls_[w].length_m(), on(left), on(right));
        for (const Side side : {left, right}) {
            for (std::int32_t k = 0; k < on(side); ++k) {
                site_piece_.push_back(site.first[side][w] + k);
                length_m_.push_back(piece_begin_m(length, k + 1, on(side)) -
                                    piece_begin_m(length, k, on(side)));
            }
        }
    }
    const double margin = eye_margin_m(options.partition_m);
    around_ = {{-margin, -margin},
               grid_.cell_m * Vec2d(grid_.nx, grid_.ny) + Vec2d(margin, margin)};
    const double reach = options.scanner.range_max_m;
    exact_ = make_kernel(KernelKind::exact, walls_, around_, reach, 0);
    if (options.kernel != KernelKind::exact) {
        of_field_ = make_kernel(options.kernel, walls_, around_, reach, options.rays);
    }
}

namespace {

// Windows of the smallest size, evenly spread over those of a patch that have a cell to look from.
std::vector<Window> spread_windows(const Grid& grid, const Raster<std::uint8_t>& standable) {
    constexpr std::size_t wanted = 32;
    std::vector<Window> all;
    for (std::int32_t y = 0; y < grid.ny; y += window_step) {
        for (std::int32_t x = 0; x < grid.nx; x += window_step) {
            const Window w{x, y, std::min(x + window_step, grid.nx),
                           std::min(y + window_step, grid.ny)};
            bool any = false;
            for (std::int32_t iy = y; iy < w.y_end && !any; ++iy) {
                for (std::int32_t ix = x; ix < w.x_end && !any; ++ix) {
                    any = standable[idx(grid.id(ix, iy))] != 0;
                }
            }
            if (any) all.push_back(w);
        }
    }
    if (all.size() <= wanted) return all;
    std::vector<Window> out;
    for (std::size_t i = 0; i < wanted; ++i)
        out.push_back(all[(2 * i + 1) * all.size() / (2 * wanted)]);
    return out;
}

}  // namespace

void Scene::take_rays_enough(const Raster<std::uint8_t>& standable) const {
    // verify allows 5e-3 rad over the whole site.
    constexpr double mean_error_rad = 2e-3;
    constexpr int most_rays = 16384;
    const std::lock_guard lock(taking_rays_);
    if (rays_taken_ || !of_field_ || !options_.more_rays) return;
    rays_taken_ = true;
    const std::vector<Window> windows = spread_windows(grid_, standable);
    const auto values = [&](const ViewKernel& kernel) {
        Raster<float> vf(standable.size(), 0);
        for (const Window& w : windows) kernel.field(options_.scanner, grid_, w, standable, vf);
        return vf;
    };
    const Raster<float> exact = values(*exact_);
    for (int rays = options_.rays; rays < most_rays;) {
        const Raster<float> got = values(*of_field_);
        double sum = 0;
        std::int64_t cells = 0;
        for (const Window& w : windows) {
            for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
                for (std::int32_t x = w.x_begin; x < w.x_end; ++x) {
                    const auto cell = idx(grid_.id(x, y));
                    if (standable[cell] == 0) continue;
                    sum += std::abs(static_cast<double>(got[cell] - exact[cell]));
                    ++cells;
                }
            }
        }
        if (sum <= mean_error_rad * static_cast<double>(cells)) return;
        rays *= 2;
        of_field_ =
            make_kernel(options_.kernel, walls_, around_, options_.scanner.range_max_m, rays);
    }
}

double Scene::bytes() const {
    constexpr double of_wall = 800;  // with its share of the triangulation
    constexpr double of_piece = 12;
    return of_wall * static_cast<double>(walls_.size()) +
           of_piece * static_cast<double>(site_piece_.size());
}

View Scene::observed(const Vec2d& here) const {
    View hits;
    View seen;
    exact_->first_hits(here, hits);
    observe(walls_, options_.scanner, here, hits, seen);
    return seen;
}

Scene::Look Scene::look(const Vec2d& eye) const {
    const Vec2d here = eye - origin_;
    const View seen = observed(here);
    Look out;
    out.vf_rad = view_angle_rad(seen);
    out.row = coverage_row(walls_, pieces_, here, seen, options_.visible_fraction);
    out.length_m.reserve(out.row.size());
    for (Seen& s : out.row) {
        out.length_m.push_back(length_m_[idx(s.piece)]);
        s.piece = site_piece(s.piece);
    }
    return out;
}

std::vector<std::int32_t> Scene::covered(const Vec2d& eye) const {
    const Vec2d here = eye - origin_;
    const CoverageRow row =
        coverage_row(walls_, pieces_, here, observed(here), options_.visible_fraction, false);
    std::vector<std::int32_t> out;
    out.reserve(row.size());
    for (const Seen& s : row) out.push_back(site_piece(s.piece));
    return out;
}

FieldCounts Scene::field(const Window& window, const Raster<std::uint8_t>& standable,
                         Raster<float>& vf_rad) const {
    const ViewKernel& kernel = of_field_ ? *of_field_ : *exact_;
    return kernel.field(options_.scanner, grid_, window, standable, vf_rad);
}

PatchSite patch_site(const std::vector<Wall>& walls, const Pieces& pieces, const NearWalls& near,
                     std::int64_t patch) {
    PatchSite out;
    for (std::int64_t i = near.begin[idx(patch)]; i < near.begin[idx(patch) + 1]; ++i) {
        const std::int32_t w = near.wall[idx(i)];
        out.number.push_back(w);
        out.walls.push_back(walls[idx(w)]);
        for (const Side side : {left, right}) {
            out.first[side].push_back(pieces.count(w, side) > 0 ? pieces.first(w, side) : -1);
        }
        out.count.push_back(std::max(pieces.count(w, left), pieces.count(w, right)));
    }
    return out;
}

Scenes::Scenes(const Layout& layout, std::function<PatchSite(std::int64_t)> site,
               const SceneOptions& options, int kept)
    : layout_(layout),
      site_(std::move(site)),
      options_(options),
      kept_(idx(kept)),
      bytes_most_(memory_left() / 4) {}

// Who holds a scene that goes may go on with it.
void Scenes::make_room() {
    while (entries_.size() > kept_ || (bytes_ > bytes_most_ && entries_.size() > 1)) {
        const auto last = entries_.find(latest_.back());
        bytes_ -= last->second.second->bytes;
        entries_.erase(last);
        latest_.pop_back();
    }
}

std::shared_ptr<const Scene> Scenes::of_patch(std::int64_t patch) {
    std::shared_ptr<Entry> entry;
    {
        const std::lock_guard lock(guard_);
        if (const auto found = entries_.find(patch); found != entries_.end()) {
            latest_.splice(latest_.begin(), latest_, found->second.first);
            entry = found->second.second;
        } else {
            latest_.push_front(patch);
            entry = std::make_shared<Entry>();
            entries_.emplace(patch, std::pair(latest_.begin(), entry));
            make_room();
        }
    }
    const std::lock_guard lock(entry->making);
    if (!entry->scene) {
        Threads::apart([&] {
            entry->scene = std::make_shared<const Scene>(layout_, patch, site_(patch), options_);
        });
        const std::lock_guard among_others(guard_);
        const auto found = entries_.find(patch);
        if (found != entries_.end() && found->second.second == entry) {
            entry->bytes = entry->scene->bytes();
            bytes_ += entry->bytes;
            make_room();
        }
    }
    return entry->scene;
}

void Scenes::each(const Threads& threads, const std::vector<Vec2d>& points,
                  const std::function<void(std::size_t, const Scene&)>& f) {
    std::vector<std::int64_t> patch(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        patch[i] = layout_.patch_of(layout_.cell_at(points[i]));
    }
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return patch[a] < patch[b]; });
    threads.for_each(static_cast<std::int64_t>(order.size()), 16,
                     [&](std::int64_t from, std::int64_t to) {
                         std::shared_ptr<const Scene> scene;
                         std::int64_t of = -1;
                         for (std::int64_t i = from; i < to; ++i) {
                             const std::size_t k = order[idx(i)];
                             if (patch[k] != of) {
                                 of = patch[k];
                                 scene = of_patch(of);
                             }
                             f(k, *scene);
                         }
                     });
}

std::vector<OverlapRow> Scenes::overlap_rows(const Threads& threads,
                                             const std::vector<Vec2d>& eyes) {
    std::vector<OverlapRow> out(eyes.size());
    each(threads, eyes,
         [&](std::size_t i, const Scene& scene) { out[i] = scene.look(eyes[i]).overlap_row(); });
    return out;
}

}  // namespace vfplan
