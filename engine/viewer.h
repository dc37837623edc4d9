// A scanner in a site: views, field values and coverage rows through one kernel.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/parallel.h"
#include "kernels/coverage.h"
#include "kernels/grid.h"
#include "kernels/view.h"

namespace vfplan {

// `name`: embree | exact. `rays` only matters to embree.
std::unique_ptr<ViewKernel> make_kernel(const std::string& name, const std::vector<Wall>& walls,
                                        const Box& around, double reach_m, int rays);

// Refers to walls, pieces and kernel of its maker. Thread-safe.
class Viewer {
public:
    Viewer(const ViewKernel& kernel, const std::vector<Wall>& walls, const Pieces& pieces,
           const Scanner& scanner, double visible_fraction)
        : kernel_(kernel),
          walls_(walls),
          pieces_(pieces),
          scanner_(scanner),
          visible_fraction_(visible_fraction) {}

    const std::vector<Wall>& walls() const { return walls_; }
    const Pieces& pieces() const { return pieces_; }
    const Scanner& scanner() const { return scanner_; }
    const ViewKernel& kernel() const { return kernel_; }
    double visible_fraction() const { return visible_fraction_; }

    // One view, read twice: VF and the coverage row.
    struct Look {
        double vf_rad = 0;
        CoverageRow row;
    };
    Look look(const Vec2d& eye) const {
        View hits;
        View seen;
        kernel_.first_hits(eye, hits);
        observe(walls_, scanner_, eye, hits, seen);
        return {view_angle_rad(seen), coverage_row(walls_, pieces_, eye, seen, visible_fraction_)};
    }
    CoverageRow row(const Vec2d& eye) const { return look(eye).row; }
    // Rows of many eyes, in their order.
    std::vector<CoverageRow> rows(const Threads& threads, const std::vector<Vec2d>& eyes) const;

private:
    const ViewKernel& kernel_;
    const std::vector<Wall>& walls_;
    const Pieces& pieces_;
    Scanner scanner_;
    double visible_fraction_;
};

struct FieldResult {
    Raster<float> vf_rad;
    FieldCounts counts;
};

inline constexpr std::int32_t window_cells = 32;  // side of the windows that threads take

// VF of every cell with standable != 0, NaN elsewhere. `progress` hears the number of cells done.
FieldResult visibility_field(const Viewer& viewer, const Threads& threads, const Grid& grid,
                             const Raster<std::uint8_t>& standable,
                             const std::function<void(std::int64_t)>& progress);

}  // namespace vfplan
