// The overlap graph over all free cells and candidates of a small site, by brute force: every view,
// every pair. Shares with the program what a view and an overlap are, and nothing else.
#pragma once

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "engine/tables/scenes.h"
#include "io/tables/coverage_file.h"
#include "io/tables/site_store.h"

namespace vfplan::test {

class AllCells {
public:
    AllCells(const SiteStore& site, const SceneOptions& options, const CoverageTables& tables,
             const OverlapRule& rule)
        : rule_(rule), lengths_(piece_lengths_m(tables.pieces)) {
        Scenes scenes(
            site.layout(), [&](std::int64_t patch) { return site.patch(patch); }, options, 4);
        for (const Candidate& c : tables.candidates) add(scenes, c.at);
        candidates_ = rows_.size();
        const Grid& grid = site.layout().grid;
        const Raster<std::uint8_t> free = site.standable(Window{0, 0, grid.nx, grid.ny});
        for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
            if (free[idx(cell)] == 0) continue;
            ++free_cells_;
            if (!scenes.look(grid.centre(cell)).row.empty()) add(scenes, grid.centre(cell));
        }
        part_.resize(rows_.size());
        std::iota(part_.begin(), part_.end(), 0U);
        for (std::size_t a = 0; a < rows_.size(); ++a) {
            for (std::size_t b = a + 1; b < rows_.size(); ++b) {
                if (root(a) == root(b)) continue;
                const double o = overlap(rule.ratio, rows_[a], rows_[b]);
                if (rule.enough(o)) part_[root(a)] = root(b);
            }
        }
    }

    std::int64_t free_cells() const { return free_cells_; }
    std::size_t rows() const { return rows_.size(); }

    // How many components see what none does that sees more wall.
    std::int64_t networks() const {
        std::vector<std::set<std::int32_t>> seen(rows_.size());
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            for (const std::int32_t p : rows_[i].seen().piece) seen[root(i)].insert(p);
        }
        const auto length = [&](const std::set<std::int32_t>& pieces) {
            double sum = 0;
            for (const std::int32_t p : pieces) sum += lengths_[idx(p)];
            return sum;
        };
        std::sort(seen.begin(), seen.end(), [&](const auto& a, const auto& b) {
            return std::pair(length(a), b) > std::pair(length(b), a);
        });
        std::set<std::int32_t> before;
        std::int64_t count = 0;
        for (const std::set<std::int32_t>& pieces : seen) {
            const std::size_t n = before.size();
            before.insert(pieces.begin(), pieces.end());
            if (before.size() > n) ++count;
        }
        return count;
    }

    // The largest threshold at which a chain joins two candidates; 0 where none does.
    double joins_at(std::int32_t a, std::int32_t b) const {
        std::vector<double> best(rows_.size(), 0);  // widest paths, after Dijkstra
        std::vector<bool> done(rows_.size(), false);
        best[idx(a)] = 2;
        for (;;) {
            std::size_t next = rows_.size();
            for (std::size_t i = 0; i < rows_.size(); ++i) {
                if (!done[i] && best[i] > 0 && (next == rows_.size() || best[i] > best[next])) {
                    next = i;
                }
            }
            if (next == rows_.size()) return 0;
            if (next == idx(b)) return best[next];
            done[next] = true;
            for (std::size_t i = 0; i < rows_.size(); ++i) {
                if (done[i]) continue;
                const double o = overlap(rule_.ratio, rows_[next], rows_[i]);
                best[i] = std::max(best[i], std::min(best[next], o));
            }
        }
    }

private:
    void add(Scenes& scenes, const Vec2d& eye) { rows_.push_back(scenes.look(eye).overlap_row()); }
    std::size_t root(std::size_t i) const {
        while (part_[i] != i) i = part_[i];
        return i;
    }

    OverlapRule rule_;
    std::vector<double> lengths_;
    std::vector<OverlapRow> rows_;  // of candidates, then of cells
    std::size_t candidates_ = 0;
    std::int64_t free_cells_ = 0;
    std::vector<std::size_t> part_;
};

}  // namespace vfplan::test
