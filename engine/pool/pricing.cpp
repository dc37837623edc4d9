#include "engine/pool/pricing.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <unordered_map>

#include "kernels/certificate.h"

namespace vfplan {
namespace {

class Pricing {
public:
    Pricing(const TableJob& job, const FieldWindow& field, const Window& window,
            const PoolGrid& grid, const std::vector<std::int64_t>& weight)
        : job_(job), field_(field), window_(window), grid_(grid), weight_(weight) {}

    PoolSquare run(const CellRows* again) {
        if (again != nullptr) {
            for (std::size_t i = 0; i < again->cell.size(); ++i) {
                try_point(again->cell[i], again->covers[i]);
            }
        } else {
            if (grid_.taken > 0) {
                each(grid_.taken, [&](std::int64_t cell) { take(cell, look(cell)); });
            }
            each(grid_.tried, [&](std::int64_t cell) { keep(cell, look(cell)); });
        }
        const std::size_t most = out_.taken.cell.size() + tried_.size() / 4 + 1;
        std::vector<std::int64_t> score(tried_.size());
        int long_shots = 0;
        while (out_.taken.cell.size() < most) {
            std::size_t best = tried_.size();
            for (std::size_t i = 0; i < tried_.size(); ++i) {
                score[i] = used_[i] != 0 ? 0 : sum(rows_[i]);
                if (score[i] > worth_another_look &&
                    (best == tried_.size() || score[i] > score[best])) {
                    best = i;
                }
            }
            if (best == tried_.size()) break;
            if (score[best] <= proof_scale && ++long_shots > most_long_shots) break;
            used_[best] = 1;
            climb(tried_[best], score[best]);
        }
        return std::move(out_);
    }

private:
    static constexpr std::int64_t worth_another_look = proof_scale * 6 / 10;
    static constexpr int most_long_shots = 4;  // of points that may come to more than 1 by moving
    using Pieces = std::vector<std::int32_t>;

    bool standable(std::int32_t ix, std::int32_t iy) const {
        return field_.inside(ix, iy) && !std::isnan(field_.vf_rad[field_.index(ix, iy)]);
    }

    // Calls f(cell) for each point of a grid in the window where a station may stand.
    template <class F>
    void each(std::int32_t step, const F& f) const {
        const auto first = [&](std::int32_t from) {
            const std::int32_t half = step / 2;
            return half + (from - half + step - 1) / step * step;
        };
        for (std::int32_t iy = first(window_.y_begin); iy < window_.y_end; iy += step) {
            for (std::int32_t ix = first(window_.x_begin); ix < window_.x_end; ix += step) {
                if (standable(ix, iy)) f(job_.layout().grid.id(ix, iy));
            }
        }
    }

    Pieces look(std::int64_t cell) {
        const std::int64_t patch = job_.layout().patch_of(cell);
        if (patch != patch_) {
            scene_ = job_.scenes.of_patch(patch);
            patch_ = patch;
        }
        return scene_->covered(job_.layout().grid.centre(cell));
    }

    void take(std::int64_t cell, Pieces row) {
        if (row.empty()) return;
        out_.taken.cell.push_back(cell);
        out_.taken.covers.push_back(std::move(row));
    }

    void keep(std::int64_t cell, Pieces row) {
        if (!try_point(cell, row)) return;
        out_.again.cell.push_back(cell);
        out_.again.covers.push_back(std::move(row));
    }

    // Within a round weights only fall, so points that cover far less than 1 never come to more. Of
    // the others the row, as places among the pieces here that weigh something.
    bool try_point(std::int64_t cell, const Pieces& row) {
        std::int64_t all = 0;
        for (const std::int32_t p : row) all += weight_[idx(p)];
        if (all <= worth_another_look) return false;
        Pieces places;
        for (const std::int32_t p : row) {
            if (weight_[idx(p)] == 0) continue;
            const auto [at, fresh] = place_.try_emplace(p, static_cast<std::int32_t>(left_.size()));
            if (fresh) left_.push_back(weight_[idx(p)]);
            places.push_back(at->second);
        }
        tried_.push_back(cell);
        rows_.push_back(std::move(places));
        used_.push_back(0);
        return true;
    }

    std::int64_t sum(const Pieces& places) const {
        std::int64_t out = 0;
        for (const std::int32_t i : places) out += left_[idx(i)];
        return out;
    }

    // The weight of what a cell covers as it is by now; pieces that no kept point covers keep
    // theirs.
    std::int64_t weigh(const Pieces& row) const {
        std::int64_t out = 0;
        for (const std::int32_t p : row) {
            const auto at = place_.find(p);
            out += at != place_.end() ? left_[idx(at->second)] : weight_[idx(p)];
        }
        return out;
    }

    // From a tried point to where one covers most around, and takes that if it is more than 1.
    void climb(std::int64_t cell, std::int64_t score) {
        const Grid& grid = job_.layout().grid;
        Pieces row = look(cell);
        int moves = 0;
        for (std::int32_t step = std::max(1, grid_.tried / 2); step > 0;) {
            const std::int64_t from = cell;
            const std::int32_t x = grid.ix(from);
            const std::int32_t y = grid.iy(from);
            for (std::int32_t k = 0; k < 9; ++k) {
                const std::int32_t ix = x + (k % 3 - 1) * step;
                const std::int32_t iy = y + (k / 3 - 1) * step;
                if (k == 4 || !standable(ix, iy)) continue;
                Pieces other = look(grid.id(ix, iy));
                const std::int64_t more = weigh(other);
                if (more <= score) continue;
                score = more;
                cell = grid.id(ix, iy);
                row = std::move(other);
            }
            if (cell == from || step > 1 || ++moves > grid_.tried / 2) step /= 2;
        }
        if (score <= proof_scale) return;
        // As much less as keeps the next ones apart, and lets some stand in for others.
        const double less = 1 / std::sqrt(static_cast<double>(score) / proof_scale);
        for (const std::int32_t p : row) {
            const auto at = place_.find(p);
            if (at == place_.end()) continue;
            std::int64_t& left = left_[idx(at->second)];
            left = static_cast<std::int64_t>(static_cast<double>(left) * less);
        }
        take(cell, std::move(row));
    }

    const TableJob& job_;
    const FieldWindow& field_;
    Window window_;
    PoolGrid grid_;
    const std::vector<std::int64_t>& weight_;
    std::int64_t patch_ = -1;
    std::shared_ptr<const Scene> scene_;
    PoolSquare out_;
    std::vector<std::int64_t> tried_;
    std::vector<Pieces> rows_;  // of these, as places
    std::vector<std::uint8_t> used_;
    std::unordered_map<std::int32_t, std::int32_t> place_;  // of pieces
    std::vector<std::int64_t> left_;                        // of their weights, by place
};

}  // namespace

PoolSquare points_of(const TableJob& job, const FieldWindow& field, const Window& window,
                     const PoolGrid& grid, const std::vector<std::int64_t>& weight,
                     const CellRows* again) {
    return Pricing(job, field, window, grid, weight).run(again);
}

}  // namespace vfplan
