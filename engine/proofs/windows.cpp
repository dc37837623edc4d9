#include "engine/proofs/windows.h"

#include <algorithm>

#include "engine/proofs/broken_lines.h"
#include "engine/proofs/relaxation.h"
#include "engine/proofs/weighing.h"

namespace vfplan {
namespace {

constexpr std::size_t window_columns = 1000;
constexpr std::size_t centre_columns = 500;  // each column is in the centre of some window
constexpr std::size_t covers_at_once = 400;
constexpr std::size_t cuts_at_once = 150;

class Windows {
public:
    Windows(const Problem& p, const Root& root, const std::vector<std::int64_t>& weight)
        : p_(p),
          root_(root),
          whole_(p, root),
          weight_(weight),
          used_(idx(p.columns()), 0),
          cuts_of_(used_.size()),
          place_(used_.size(), -1),
          centred_(used_.size(), 0),
          row_place_(weight.size(), -1) {
        for (std::int32_t r = 0; r < p.rows(); ++r) {
            for (const std::int32_t c : p.columns_of.of(r)) used_[idx(c)] += weight_[idx(r)];
        }
    }

    // Again and again, from either end in turn, while that helps.
    void run(Effort& effort) {
        const std::int64_t about =
            1 + p_.columns() / static_cast<std::int64_t>(centre_columns * 2 / 3);
        do {
            gained_ = 0;
            std::fill(centred_.begin(), centred_.end(), 0);
            const std::int64_t share = effort.left / about;
            for (std::int32_t i = 0; i < p_.columns() && !effort.is_spent(); ++i) {
                const std::int32_t seed = backwards_ ? p_.columns() - 1 - i : i;
                if (centred_[idx(seed)] != 0) continue;
                Effort mine{std::min(share, effort.left)};
                effort.left -= mine.left;
                look_at(seed, mine);
                effort.left += mine.left;
            }
            backwards_ = !backwards_;
        } while (gained_ >= proof_scale && !effort.is_spent());
    }

    Weighed result() const {
        Weighed out;
        const auto add = [&](const ProofLine& line, std::int64_t weight) {
            if (weight == 0) return;
            out.weights.push_back({static_cast<std::int32_t>(out.lines.size()), weight});
            out.lines.push_back(line);
        };
        for (std::int32_t r = 0; r < p_.rows(); ++r) {
            add({LineKind::cover, r, {}}, weight_[idx(r)]);
        }
        for (const Cut& cut : cuts_) add(cut.line, cut.weight);
        return out;
    }

private:
    struct Cut {
        ProofLine line;
        std::vector<std::int32_t> columns;  // that it speaks of
        std::int64_t weight = 0;
    };

    // A ball around the seed, ascending; its inner part counts as centred.
    std::vector<std::int32_t> ball(std::int32_t seed) {
        std::vector<std::int32_t> out = {seed};
        place_[idx(seed)] = 0;
        for (std::size_t i = 0; i < out.size() && out.size() < window_columns; ++i) {
            for (const std::int32_t n : p_.near.of(out[i])) {
                if (place_[idx(n)] >= 0 || out.size() >= window_columns) continue;
                place_[idx(n)] = 0;
                out.push_back(n);
            }
        }
        for (std::size_t i = 0; i < out.size() && i < centre_columns; ++i)
            centred_[idx(out[i])] = 1;
        std::sort(out.begin(), out.end());
        for (std::size_t i = 0; i < out.size(); ++i) {
            place_[idx(out[i])] = static_cast<std::int32_t>(i);
        }
        return out;
    }

    bool is_inside(std::span<const std::int32_t> columns) const {
        return std::all_of(columns.begin(), columns.end(),
                           [&](std::int32_t c) { return place_[idx(c)] >= 0; });
    }

    void look_at(std::int32_t seed, Effort& effort) {
        const std::vector<std::int32_t> columns = ball(seed);
        const auto outside = static_cast<std::int32_t>(columns.size());
        std::vector<std::int32_t> rows;
        std::vector<std::int32_t> freed;  // cuts
        for (const std::int32_t c : columns) {
            for (const std::int32_t r : p_.rows_of.of(c)) {
                if (row_place_[idx(r)] >= 0 || !is_inside(p_.columns_of.of(r))) continue;
                row_place_[idx(r)] = static_cast<std::int32_t>(rows.size());
                rows.push_back(r);
            }
            for (const std::int32_t cut : cuts_of_[idx(c)]) {
                if (is_inside(cuts_[idx(cut)].columns) && is_inside(cuts_[idx(cut)].line.within)) {
                    freed.push_back(cut);
                }
            }
        }
        std::sort(freed.begin(), freed.end());
        freed.erase(std::unique(freed.begin(), freed.end()), freed.end());
        solve(columns, rows, freed, outside, effort);
        for (const std::int32_t c : columns) place_[idx(c)] = -1;
        for (const std::int32_t r : rows) row_place_[idx(r)] = -1;
    }

    // Of the window, with all that is outside as one column that stands.
    Problem problem_of(const std::vector<std::int32_t>& columns, std::size_t rows,
                       std::int32_t outside) const {
        Problem out;
        std::vector<std::int32_t> border;
        for (std::int32_t k = 0; k < outside; ++k) {
            const std::int32_t c = columns[idx(k)];
            for (const std::int32_t r : p_.rows_of.of(c)) {
                if (row_place_[idx(r)] >= 0) out.rows_of.to.push_back(row_place_[idx(r)]);
            }
            std::sort(out.rows_of.to.begin() + out.rows_of.begin.back(), out.rows_of.to.end());
            out.rows_of.end_list();
            bool at_border = false;
            for (const std::int32_t n : p_.near.of(c)) {
                if (place_[idx(n)] >= 0) out.near.to.push_back(place_[idx(n)]);
                at_border = at_border || place_[idx(n)] < 0;
            }
            if (at_border) {
                out.near.to.push_back(outside);
                border.push_back(k);
            }
            out.near.end_list();
            out.fixed.push_back(p_.fixed[idx(c)]);
        }
        out.rows_of.end_list();
        out.near.to.insert(out.near.to.end(), border.begin(), border.end());
        out.near.end_list();
        out.fixed.push_back(1);
        out.columns_of = transposed(out.rows_of, static_cast<std::int32_t>(rows));
        return out;
    }

    void solve(const std::vector<std::int32_t>& columns, const std::vector<std::int32_t>& rows,
               const std::vector<std::int32_t>& freed, std::int32_t outside, Effort& effort) {
        if (rows.empty()) return;
        const Problem local = problem_of(columns, rows.size(), outside);
        // What lines that stay leave of a column.
        std::vector<std::int64_t> cost;
        for (const std::int32_t c : columns) cost.push_back(proof_scale - used_[idx(c)]);
        cost.push_back(0);
        const auto give_back = [&](std::int32_t c, std::int64_t w) {
            cost[idx(place_[idx(c)])] += w;
        };
        for (const std::int32_t r : rows) {
            for (const std::int32_t c : p_.columns_of.of(r)) give_back(c, weight_[idx(r)]);
        }
        for (const std::int32_t cut : freed) {
            for (const std::int32_t c : cuts_[idx(cut)].columns) {
                give_back(c, cuts_[idx(cut)].weight);
            }
        }
        Root root;
        root.column = outside;
        for (const std::int32_t c : root_.columns) {
            if (place_[idx(c)] >= 0) root.columns.push_back(place_[idx(c)]);
        }
        root.columns.push_back(outside);
        Lines lines(local, root, std::move(cost));
        Relaxation relaxation(lines, outside, false);
        BrokenLines broken(lines);
        Weighing weighing(lines);
        const std::vector<Known> known(idx(local.columns()), Known::free);
        // As it is now.
        std::vector<LineWeight> weights;
        const auto begin_with = [&](ProofLine line, std::int64_t weight) {
            if (weight == 0) return;
            weights.push_back({static_cast<std::int32_t>(relaxation.lines().size()), weight});
            relaxation.add(std::move(line));
        };
        for (std::size_t i = 0; i < rows.size(); ++i) {
            begin_with({LineKind::cover, static_cast<std::int32_t>(i), {}}, weight_[idx(rows[i])]);
        }
        for (const std::int32_t cut : freed) {
            ProofLine line = cuts_[idx(cut)].line;
            if (row_place_[idx(line.of)] < 0) continue;  // then it stays away, at a loss
            line.of = row_place_[idx(line.of)];
            for (std::int32_t& c : line.within) c = place_[idx(c)];
            begin_with(std::move(line), cuts_[idx(cut)].weight);
        }
        const std::int64_t before = value_with(weighing, relaxation.lines(), weights, known, freed);
        std::int64_t best = before;
        double last = -1e300;
        for (int stalled = 0; stalled < 5 && !effort.is_spent();) {
            if (!relaxation.solve(effort)) break;
            std::vector<LineWeight> now = relaxation.weights();
            const std::int64_t value = weighing.value(relaxation.lines(), now, known);
            if (value > best) {
                best = value;
                weights = std::move(now);
            }
            relaxation.purge();
            stalled = relaxation.value() < last + 1e-3 ? stalled + 1 : 0;
            last = std::max(last, relaxation.value());
            std::vector<ProofLine> found = broken.covers(relaxation.at(), covers_at_once);
            if (found.size() < covers_at_once / 4) {
                for (ProofLine& line : broken.nodes(relaxation.at(), cuts_at_once, effort)) {
                    found.push_back(std::move(line));
                }
            }
            if (found.empty()) break;
            for (ProofLine& line : found) relaxation.add(std::move(line));
        }
        gained_ += best - before;
        if (best > before) take(columns, rows, freed, relaxation.lines(), weights);
    }

    // Freed cuts whose row is not of the window weigh as well, though they have no place in it.
    std::int64_t value_with(Weighing& weighing, const std::vector<ProofLine>& lines,
                            const std::vector<LineWeight>& weights, const std::vector<Known>& known,
                            const std::vector<std::int32_t>& freed) const {
        std::int64_t value = weighing.value(lines, weights, known);
        for (const std::int32_t cut : freed) {
            if (row_place_[idx(cuts_[idx(cut)].line.of)] < 0) value += cuts_[idx(cut)].weight;
        }
        return value;
    }

    void take(const std::vector<std::int32_t>& columns, const std::vector<std::int32_t>& rows,
              const std::vector<std::int32_t>& freed, const std::vector<ProofLine>& lines,
              const std::vector<LineWeight>& weights) {
        const auto use = [&](std::span<const std::int32_t> of, std::int64_t weight) {
            for (const std::int32_t c : of) used_[idx(c)] += weight;
        };
        for (const std::int32_t r : rows) {
            use(p_.columns_of.of(r), -weight_[idx(r)]);
            weight_[idx(r)] = 0;
        }
        for (const std::int32_t cut : freed) {
            use(cuts_[idx(cut)].columns, -cuts_[idx(cut)].weight);
            cuts_[idx(cut)].weight = 0;
        }
        for (const auto& [number, weight] : weights) {
            const ProofLine& line = lines[idx(number)];
            const std::int32_t row = rows[idx(line.of)];
            if (line.kind == LineKind::cover) {
                weight_[idx(row)] += weight;
                use(p_.columns_of.of(row), weight);
                continue;
            }
            Cut cut{{LineKind::nodes, row, {}}, {}, weight};
            for (const std::int32_t k : line.within) cut.line.within.push_back(columns[idx(k)]);
            whole_.each(cut.line, [&](std::int32_t c, std::int64_t) { cut.columns.push_back(c); });
            use(cut.columns, weight);
            for (const std::int32_t c : cut.columns) {
                cuts_of_[idx(c)].push_back(static_cast<std::int32_t>(cuts_.size()));
            }
            cuts_.push_back(std::move(cut));
        }
    }

    const Problem& p_;
    const Root& root_;
    Lines whole_;
    std::vector<std::int64_t> weight_;  // by row
    std::vector<std::int64_t> used_;    // by column: what all lines take of it
    std::vector<Cut> cuts_;
    std::vector<std::vector<std::int32_t>> cuts_of_;  // by column
    std::vector<std::int32_t> place_;                 // by column: in the window, or -1
    std::vector<std::uint8_t> centred_;
    std::vector<std::int32_t> row_place_;
    std::int64_t gained_ = 0;  // in this round
    bool backwards_ = false;
};

}  // namespace

Weighed weigh_by_windows(const Problem& problem, const Root& root,
                         const std::vector<std::int64_t>& weight, Effort& effort) {
    Windows windows(problem, root, weight);
    windows.run(effort);
    return windows.result();
}

}  // namespace vfplan
