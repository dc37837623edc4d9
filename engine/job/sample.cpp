#include "engine/job/sample.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/job/outlook.h"
#include "engine/job/squares.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"
#include "engine/runtime/stop.h"
#include "engine/tables/site.h"
#include "kernels/coverage.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr int squares_tried = 6;
constexpr int empty_squares_tried = 2;
constexpr double square_cells = 256;         // along a square's side
constexpr double whole_cells = 500'000;      // of a site that is tried as a whole
constexpr std::size_t walls_most = 100'000;  // in and around what is tried
constexpr double pieces_most = 80'000;       // likewise
constexpr double usual_spans = 50;           // in a view; more take longer
constexpr double cpu_most_s = 6;
constexpr std::int64_t tile_cells = 1024;  // one tile: what lies around would be read for each

// The clock has run down.
struct OutOfTime : Error {
    OutOfTime() : Error(Exit::stopped, "out of time") {}
};

class Sampling {
public:
    Sampling(const GroundOptions& ground, const TableOptions& tables, const Site& site,
             const Layout& layout, int threads)
        : ground_(ground), tables_(tables), site_(site), layout_(layout), threads_(threads, [this] {
              stop_if_asked();
              if (Moment::now().cpu_s > deadline_s_) throw OutOfTime();
          }) {}

    Sample run() {
        deadline_s_ = Moment::now().cpu_s + cpu_most_s;
        const Outlook outlook = look_around(site_, ground_.range_max_m, threads_);
        const double ease = std::clamp(usual_spans / std::max(outlook.spans, 1.0), 0.05, 1.0);
        const double cells = static_cast<double>(layout_.grid.size());
        const double larger = std::sqrt(std::max(1.0, cells / (whole_cells * ease)));
        const double largest_m = std::max(ground_.cell_m, outlook.sight_m / 32);
        if (ground_.cell_m * larger <= largest_m && site_.walls.size() <= walls_most &&
            pieces_of(site_, ground_) <= pieces_most && try_whole(ground_.cell_m * larger)) {
            return out_;
        }
        // Squares of four sights: of less, what lies at the edge would be most.
        const double cell_m = std::max(ground_.cell_m, outlook.sight_m / 64);
        double side_m = square_cells * cell_m * std::sqrt(ease);
        while (!try_squares(cell_m, side_m) && side_m > 8 * cell_m) {
            side_m /= 3;
            deadline_s_ = Moment::now().cpu_s + cpu_most_s / 6;
        }
        return out_;
    }

private:
    static double pieces_of(const Site& site, const GroundOptions& ground) {
        return static_cast<double>(cut_into_pieces(site.walls, ground.partition_m).size());
    }

    Weighed try_site(const Site& part, double cell_m, double weight) const {
        GroundOptions ground = ground_;
        TableOptions tables = tables_;
        ground.cell_m = std::min(cell_m, part.extent.size().minCoeff());
        ground.tile_cells = tables.tile_cells = tile_cells;
        const double pieces = pieces_of(part, ground);
        const double longer = std::max(1.0, pieces / pieces_most);
        ground.partition_m *= longer;
        tables.scenes.partition_m *= longer;
        const double tried = std::max(1.0, pieces_of(part, ground));
        return {try_part(ground, tables, part, threads_), layout_of(ground, part), weight,
                pieces / tried};
    }

    bool try_whole(double cell_m) {
        std::vector<Weighed> trials;
        try {
            trials.push_back(try_site(site_, cell_m, 1));
        } catch (const OutOfTime&) {
            out_.cut_short = true;
            return false;
        }
        const auto cells = static_cast<double>(layout_.grid.size());
        out_.site = scaled_by_walls(trials, 1, cells, layout_, ground_.range_max_m);
        out_.share = 1;
        out_.cell_m = cell_m;
        return true;
    }

    // False when there was time for none.
    bool try_squares(double cell_m, double side_m) {
        constexpr double squares_most = 4e6;
        const Vec2d size = site_.extent.size();
        const Squares squares(
            site_, std::max({side_m, 2 * cell_m, std::sqrt(size.x() * size.y() / squares_most)}));
        std::vector<Weighed> empty;
        std::vector<Weighed> built;
        double hits = 0;
        double tried_m = 0;
        const auto cells = static_cast<double>(layout_.grid.size());
        const double built_cells = cells * squares.share_with_walls();
        const auto part = [&](std::size_t square) {
            return part_of_site(site_, squares.box(square), ground_.range_max_m, walls_most);
        };
        try {
            if (built_cells < 0.98 * cells) {
                for (const auto& t : squares.without_walls(empty_squares_tried)) {
                    empty.push_back(try_site(part(t.square), cell_m, 1));
                }
            }
            for (const auto& t : squares.by_walls(squares_tried)) {
                const double walls_m = squares.walls_m(t.square);
                built.push_back(try_site(part(t.square), cell_m, t.times / walls_m));
                hits += t.times;
                tried_m += walls_m;
            }
        } catch (const OutOfTime&) {
            out_.cut_short = true;
            if (built.empty()) return false;
        }
        out_.site = scaled_by_walls(built, squares.all_walls_m() / hits, built_cells, layout_,
                                    ground_.range_max_m);
        out_.site += scaled_by_cells(empty, cells - built_cells, layout_, ground_.range_max_m);
        out_.share = tried_m / squares.all_walls_m();
        out_.squares = static_cast<int>(built.size() + empty.size());
        out_.cell_m = cell_m;
        return true;
    }

    const GroundOptions& ground_;
    const TableOptions& tables_;
    const Site& site_;
    const Layout& layout_;
    double deadline_s_ = 0;
    const Threads threads_;
    Sample out_;
};

}  // namespace

Sample try_job(const GroundOptions& ground, const TableOptions& tables, const Site& site,
               const Layout& layout, int threads) {
    return Sampling(ground, tables, site, layout, threads).run();
}

}  // namespace vfplan
