#include "engine/joining/disputes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "engine/joining/knowledge.h"
#include "engine/joining/meetings.h"
#include "engine/joining/row_store.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int32_t nothing = sees_nothing;
constexpr std::int32_t several = sees_several;
// A look costs about a twentieth of asking for all places that may see a piece.
constexpr std::int64_t looks_for_a_piece = 20;

// A piece that is asked about.
struct Asked {
    std::size_t patch;  // in the list of patches
    std::int32_t wall;  // of the patch
    Side side;
    double s0_m;
    double s1_m;
    PieceRole role;
    std::int32_t set;
    std::int32_t x;  // cell of its middle
    std::int32_t y;
};

// The pieces around a window, and which of its cells may see them.
class Askers {
public:
    Askers(const TableJob& job, const SiteStore& site, const DisputeRound& round, bool first,
           const Window& window)
        : job_(job), layout_(job.layout()), window_(window), grid_(part_of(layout_.grid, window)) {
        const SceneOptions& o = job.scenes.options();
        reach_m_ = o.scanner.range_max_m;
        const Window around = window.grown(reach_cells(job), layout_.grid);
        for (const std::int64_t patch : layout_.patches_in(around)) {
            if (!site.has_walls(patch)) continue;
            const std::size_t before = asked_.size();
            add_pieces(site, round, first, around, patch);
            if (asked_.size() > before) patches_.push_back(patch);
        }
        if (first) drop_lonely(around);
        views_.resize(patches_.size());
        job.threads.for_each(
            static_cast<std::int64_t>(patches_.size()), 1, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    if (!is_asked(i)) continue;
                    const std::int64_t patch = patches_[idx(i)];
                    views_[idx(i)] =
                        std::make_unique<WeakView>(weak_view(job, site.patch(patch), patch));
                }
            });
    }

    // How far from a cell a piece may be that it sees, in cells.
    static std::int32_t reach_cells(const TableJob& job) {
        constexpr std::int32_t rounding = 2;
        return job.range_cells() + rounding +
               static_cast<std::int32_t>(
                   std::ceil(job.scenes.options().partition_m / job.layout().grid.cell_m));
    }

    const std::vector<Asked>& asked() const { return asked_; }

    // f(piece, index of the cell) for all pieces with a role, from any thread; a cell may come more
    // than once.
    template <class F>
    void each(PieceRole role, F&& f) const {
        std::vector<const Asked*> some;
        for (const Asked& a : asked_) {
            if (a.role == role) some.push_back(&a);
        }
        job_.threads.for_each(
            static_cast<std::int64_t>(some.size()), 4, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    cells(*some[idx(i)], [&](std::size_t cell) { f(*some[idx(i)], cell); });
                }
            });
    }

private:
    // The cells that may see a piece.
    template <class F>
    void cells(const Asked& a, F&& f) const {
        // The window's grid in the patch's frame.
        const Vec2d corner = grid_.origin - layout_.patch_origin(patches_[a.patch]);
        const WeakView& view = *views_[a.patch];
        const bool known = view.parts(a.wall, a.side, a.s0_m, a.s1_m, reach_m_,
                                      [&](std::span<const Vec2d> part) { fill(corner, part, f); });
        if (known) return;
        for (std::size_t i = 0; i < idx(grid_.size()); ++i) f(i);
    }

    // Where a set is alone within reach no cell sees pieces of two.
    void drop_lonely(const Window& around) {
        Meetings meetings(around, reach_cells(job_));
        for (const Asked& a : asked_) {
            const bool always = a.role == PieceRole::look || a.role == PieceRole::unseen;
            meetings.add(a.x, a.y, always ? several : a.set);
        }
        meetings.find();
        std::erase_if(asked_, [&](const Asked& a) { return !meetings.near_several(a.x, a.y); });
    }

    // Pieces are in the order of their patches.
    bool is_asked(std::int64_t patch) const {
        const auto first = std::lower_bound(
            asked_.begin(), asked_.end(), idx(patch),
            [](const Asked& a, std::size_t of_patch) { return a.patch < of_patch; });
        return first != asked_.end() && first->patch == idx(patch);
    }

    void add_pieces(const SiteStore& site, const DisputeRound& round, bool first,
                    const Window& around, std::int64_t patch) {
        const PatchSite near = site.patch(patch);
        for (std::size_t w = 0; w < near.walls.size(); ++w) {
            const double length = near.walls[w].length_m();
            for (const Side side : {left, right}) {
                if (near.first[side][w] < 0) continue;
                const std::int32_t n = near.count[w];
                for (std::int32_t k = 0; k < n; ++k) {
                    const std::size_t p = idx(near.first[side][w] + k);
                    const PieceRole role = round.role[p];
                    if (role == PieceRole::settled) continue;
                    if (!first && role != PieceRole::look) continue;
                    const double s0 = piece_begin_m(length, k, n);
                    const double s1 = piece_begin_m(length, k + 1, n);
                    const std::int64_t cell = layout_.cell_at(near.walls[w].at((s0 + s1) / 2));
                    if (layout_.patch_of(cell) != patch) continue;
                    const std::int32_t x = layout_.grid.ix(cell);
                    const std::int32_t y = layout_.grid.iy(cell);
                    if (!around.contains(x, y)) continue;
                    asked_.push_back({patches_.size(), static_cast<std::int32_t>(w), side, s0, s1,
                                      role, round.set[p], x, y});
                }
            }
        }
    }

    // The cells whose centres lie in a convex polygon, or nearly so.
    template <class F>
    void fill(const Vec2d& corner, std::span<const Vec2d> polygon, F&& f) const {
        constexpr double nearly = 1e-6;
        const double cell = grid_.cell_m;
        double y_min = polygon[0].y();
        double y_max = y_min;
        for (const Vec2d& p : polygon) {
            y_min = std::min(y_min, p.y());
            y_max = std::max(y_max, p.y());
        }
        const auto at_least = [&](double v, double from) {
            return std::ceil((v - nearly - from) / cell - 0.5);
        };
        const auto at_most = [&](double v, double from) {
            return std::floor((v + nearly - from) / cell - 0.5);
        };
        const double first = std::max(0.0, at_least(y_min, corner.y()));
        const double last = std::min(grid_.ny - 1.0, at_most(y_max, corner.y()));
        for (double row = first; row <= last; ++row) {
            const double y = std::clamp(corner.y() + (row + 0.5) * cell, y_min, y_max);
            double x0 = std::numeric_limits<double>::infinity();
            double x1 = -x0;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Vec2d& a = polygon[i];
                const Vec2d& b = polygon[(i + 1) % polygon.size()];
                if (y < std::min(a.y(), b.y()) || y > std::max(a.y(), b.y())) continue;
                const double t = a.y() == b.y() ? 0 : (y - a.y()) / (b.y() - a.y());
                const double x = a.x() + t * (b.x() - a.x());
                x0 = std::min({x0, x, a.y() == b.y() ? b.x() : x});
                x1 = std::max({x1, x, a.y() == b.y() ? b.x() : x});
            }
            const double from = std::max(0.0, at_least(x0, corner.x()));
            const double to = std::min(grid_.nx - 1.0, at_most(x1, corner.x()));
            const auto begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.nx);
            for (double x = from; x <= to; ++x) f(begin + static_cast<std::size_t>(x));
        }
    }

    const TableJob& job_;
    const Layout& layout_;
    Window window_;
    Grid grid_;
    double reach_m_ = 0;
    std::vector<std::int64_t> patches_;
    std::vector<std::unique_ptr<WeakView>> views_;
    std::vector<Asked> asked_;
};

// Notes of cells what they may see, from any thread.
void note(std::int32_t& of_cell, std::int32_t set) {
    const std::atomic_ref<std::int32_t> cell(of_cell);
    std::int32_t known = cell.load(std::memory_order_relaxed);
    while (
        seen_together(known, set) != known &&
        !cell.compare_exchange_weak(known, seen_together(known, set), std::memory_order_relaxed)) {
    }
}

// Pieces that no candidate sees are hardly ever seen from anywhere, but who knows. Cells of lesser
// sets that may see one are looked from, as all of theirs are where the largest set's pieces are
// not asked about: which of the two is done hangs on the block, and must not show. What they see is
// asked about in the next round.
void look_for_unseen(const Askers& askers, Raster<std::int32_t>& may_see) {
    Raster<std::int32_t> more(may_see.size(), nothing);
    askers.each(PieceRole::unseen, [&](const Asked& a, std::size_t cell) {
        if (may_see[cell] >= 0 && may_see[cell] != a.set) note(more[cell], several);
    });
    for (std::size_t i = 0; i < more.size(); ++i) {
        if (more[i] == several) may_see[i] = several;
    }
}

// For each cell of the window whether it must be looked from.
Raster<std::int32_t> cells_to_look_from(const Askers& askers, const FieldWindow& field,
                                        bool first) {
    Raster<std::int32_t> may_see(field.vf_rad.size(), nothing);
    askers.each(PieceRole::look,
                [&](const Asked&, std::size_t cell) { note(may_see[cell], several); });
    if (!first) return may_see;
    askers.each(PieceRole::lesser,
                [&](const Asked& a, std::size_t cell) { note(may_see[cell], a.set); });
    std::int64_t lesser = 0;
    for (std::size_t i = 0; i < may_see.size(); ++i) {
        if (may_see[i] != nothing && !std::isnan(field.vf_rad[i])) ++lesser;
    }
    const std::int64_t largest =
        std::count_if(askers.asked().begin(), askers.asked().end(),
                      [](const Asked& a) { return a.role == PieceRole::largest; });
    if (lesser <= looks_for_a_piece * largest) {
        // All others see pieces of the largest set only, or of none.
        for (std::int32_t& set : may_see) set = set == nothing ? nothing : several;
        return may_see;
    }
    askers.each(PieceRole::largest,
                [&](const Asked& a, std::size_t cell) { note(may_see[cell], a.set); });
    look_for_unseen(askers, may_see);
    return may_see;
}

// Whether a row holds more than pieces that one set has for itself.
bool disputed(const CoverageRow& row, const DisputeRound& round) {
    std::int32_t set = nothing;
    for (const Seen& s : row) {
        const PieceRole role = round.role[idx(s.piece)];
        if (role == PieceRole::settled) return false;
        if (role != PieceRole::lesser && role != PieceRole::largest) return true;
        if (set != nothing && round.set[idx(s.piece)] != set) return true;
        set = round.set[idx(s.piece)];
    }
    return false;
}

// Rows of all cells are kept, so in runs.
std::vector<PieceRun> runs_of(const CoverageRow& row) {
    std::vector<PieceRun> out;
    for (const Seen& s : row) add_piece(s.piece, 0, out);
    out.shrink_to_fit();
    return out;
}

// Looks from cells, some at a time; gives the disputed ones.
std::vector<std::int64_t> looked_from(const TableJob& job, const DisputeRound& round,
                                      const std::vector<std::int64_t>& cells,
                                      const OverlapRule& rule) {
    constexpr std::size_t at_once = 4096;
    const bool by_angle = formula(rule.ratio).by_angle;
    std::vector<std::int64_t> out;
    std::set<std::vector<PieceRun>> rows_seen;
    for (std::size_t from = 0; from < cells.size(); from += at_once) {
        const std::size_t to = std::min(cells.size(), from + at_once);
        std::vector<Vec2d> eyes;
        for (std::size_t i = from; i < to; ++i) eyes.push_back(job.layout().grid.centre(cells[i]));
        std::vector<CoverageRow> rows(eyes.size());
        job.scenes.each(job.threads, eyes, [&](std::size_t i, const Scene& scene) {
            rows[i] = scene.look(eyes[i]).row;
            if (!disputed(rows[i], round)) rows[i].clear();
        });
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (rows[i].empty()) continue;
            const bool news = rows_seen.insert(runs_of(rows[i])).second;
            if (news || by_angle) out.push_back(cells[from + i]);
        }
        if (by_angle) rows_seen.clear();
    }
    return out;
}

std::int32_t margin_cells(const TableJob& job) { return 2 * Askers::reach_cells(job); }

std::vector<std::int64_t> disputed_cells(const TableJob& job, const SiteStore& site,
                                         const FieldTiles& tiles, const DisputeRound& round,
                                         const std::vector<std::int64_t>& known,
                                         const OverlapRule& rule, std::int64_t block, bool first) {
    const Grid& grid = job.layout().grid;
    const Window core = dispute_blocks(job).tile_window(block);
    // What sets a piece is seen from hangs on cells around the block, too.
    const Window around = first ? core.grown(margin_cells(job), grid) : core;
    const Askers askers(job, site, round, first, around);
    const auto alone = [](const Asked& a) { return a.role == PieceRole::largest; };
    if (std::all_of(askers.asked().begin(), askers.asked().end(), alone)) return {};
    const FieldWindow field = tiles.window(around);
    const Raster<std::int32_t> may_see = cells_to_look_from(askers, field, first);
    std::vector<std::int64_t> cells;
    for (std::int32_t y = core.y_begin; y < core.y_end; ++y) {
        for (std::int32_t x = core.x_begin; x < core.x_end; ++x) {
            const std::size_t i = field.index(x, y);
            if (may_see[i] != several || std::isnan(field.vf_rad[i])) continue;
            const std::int64_t cell = grid.id(x, y);
            if (!std::binary_search(known.begin(), known.end(), cell)) cells.push_back(cell);
        }
    }
    return looked_from(job, round, cells, rule);
}

}  // namespace

Layout dispute_blocks(const TableJob& job) { return in_blocks(job.layout(), margin_cells(job)); }

void make_disputed(const TableJob& job, const std::vector<ShardNames>& rounds,
                   const SiteStore& site, const FieldTiles& field, const DisputeRound& round,
                   const OverlapRule& rule) {
    make_shards(job, rounds.back(), dispute_blocks(job).tiles(),
                [&](std::int64_t block, const std::filesystem::path& path) {
                    std::vector<std::int64_t> known;
                    for (std::size_t r = 0; r + 1 < rounds.size(); ++r) {
                        const auto some = read_disputed_cells(rounds[r].one(block));
                        known.insert(known.end(), some.begin(), some.end());
                    }
                    std::sort(known.begin(), known.end());
                    write_disputed_cells(path, job.key,
                                         disputed_cells(job, site, field, round, known, rule, block,
                                                        rounds.size() == 1));
                });
}

}  // namespace vfplan
