#include "engine/joining/leader.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "engine/joining/disputes.h"
#include "engine/joining/takers.h"
#include "kernels/index.h"

namespace vfplan {

ShardNames shards_of_round(const TableJob& job, int round) {
    return job.passing("disputed", fmt::format("-{}", round));
}

DisputeRound Leader::round(int number) {
    know();
    DisputeRound out;
    if (one_sees_all()) {
        out.spaces = 1;
        return out;
    }
    know_spaces();
    const State& s = state(number);
    const std::vector<std::int32_t> seen_by = seen_by_sets(s);
    out.role.assign(seen_by.size(), PieceRole::settled);
    out.set.assign(seen_by.size(), -1);
    DisputeRound before;
    if (number > 0) before = read_dispute_round(shards_of_round(job_, number - 1).whole());
    const std::vector<std::int32_t> largest = largest_of_spaces(s, out.spaces);
    for (std::size_t p = 0; p < seen_by.size(); ++p) {
        const std::int32_t of_space = largest[idx(space_[p])];
        if (of_space < 0) continue;
        const PieceRole was = number > 0 ? before.role[p] : PieceRole::lesser;
        const bool looked = was == PieceRole::look || was == PieceRole::shared;
        const std::int32_t set = seen_by[p];
        if (set == several) {
            out.role[p] = looked ? PieceRole::shared : PieceRole::look;
        } else if (set == nobody) {
            out.role[p] = PieceRole::unseen;
            out.set[p] = of_space;
        } else {
            out.set[p] = set;
            out.role[p] = was == PieceRole::unseen ? PieceRole::look
                          : set == of_space        ? PieceRole::largest
                                                   : PieceRole::lesser;
        }
        out.open = out.open || number == 0 || out.role[p] == PieceRole::look;
    }
    return out;
}

std::vector<Candidate> Leader::all_candidates(int rounds, std::int64_t& count) {
    know();
    know_spaces();
    const State& s = state(rounds);
    std::vector<std::int32_t> sets = s.joined.set_of_component;
    std::sort(sets.begin(), sets.end());
    count = std::unique(sets.begin(), sets.end()) - sets.begin();
    std::vector<Candidate> all = candidates_.read(0, candidates_.listed());
    std::vector<std::int32_t> chosen = s.joined.connectors;
    if (count > 1) {
        const std::vector<std::int32_t> takers =
            find_takers({s.local, s.first_piece, static_cast<std::int32_t>(s.component.size()),
                         s.joined, seen_, pieces_});
        chosen.insert(chosen.end(), takers.begin(), takers.end());
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const std::int32_t c : chosen) {
        const std::int64_t cell = s.cells[idx(c)];
        all.push_back({job_.layout().grid.centre(cell), cell, CandidateKind::connector, 0});
    }
    return all;
}

Apart Leader::apart(int rounds, const CandidateList& list) {
    know();
    know_spaces();
    const State& s = state(rounds);
    Apart out;
    if (s.joined.complete) out.free_cells = site_.facts().free_cells;
    out.disputed_cells = static_cast<std::int64_t>(s.cells.size());
    out.rule = rule_;
    out.pairs = largest_overlaps(job_.threads, problem(s), s.joined);
    const std::vector<std::int32_t> names = names_in(list);
    std::unordered_map<std::int32_t, std::int32_t> without;  // sets of cells alone
    for (SetPair& pair : out.pairs) {
        for (std::int32_t* set : {&pair.a, &pair.b}) {
            if (*set < components_.count()) {
                *set = names[idx(*set)];
            } else {
                const auto next = static_cast<std::int32_t>(list.size()) +
                                  static_cast<std::int32_t>(without.size());
                *set = without.emplace(*set, next).first->second;
            }
        }
    }
    return out;
}

void Leader::know() {
    if (known_) return;
    known_ = true;
    std::vector<std::int32_t> all(idx(candidates_.size()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
    component_ = components_.of(all);
    seen_ = pieces_of_components(job_, candidates_, component_);
}

void Leader::know_spaces() {
    if (!space_.empty()) return;
    pieces_ = site_.all_pieces(site_.all_walls());
    space_ = spaces_of_pieces(job_, site_, pieces_);
}

bool Leader::one_sees_all() const {
    std::vector<std::int64_t> count(idx(components_.count()), 0);
    std::int64_t all = 0;
    for (std::size_t i = 0; i < seen_.size(); ++i) {
        ++count[idx(seen_[i].second)];
        if (i == 0 || seen_[i].first != seen_[i - 1].first) ++all;
    }
    const auto most = std::max_element(count.begin(), count.end());
    const auto best = static_cast<std::int32_t>(most - count.begin());
    return *most == all && std::all_of(component_.begin() + candidates_.listed(), component_.end(),
                                       [&](std::int32_t c) { return c == best; });
}

const Leader::State& Leader::state(int round) {
    if (state_ && state_of_ == round) return *state_;
    std::unique_ptr<State> before = std::move(state_);
    if (state_of_ > round) before.reset();
    state_ = std::make_unique<State>();
    state_of_ = round;
    State& s = *state_;
    for (int r = 0; r < round; ++r) {
        for (std::int64_t block = 0; block < dispute_blocks(job_).tiles(); ++block) {
            const auto some = read_disputed_cells(shards_of_round(job_, r).one(block));
            s.cells.insert(s.cells.end(), some.begin(), some.end());
        }
    }
    std::sort(s.cells.begin(), s.cells.end());
    s.cells.erase(std::unique(s.cells.begin(), s.cells.end()), s.cells.end());
    std::vector<double> length_m(idx(pieces_.size()), 0);
    // Packed until the rows of candidates, which stand before them, are known: these are few.
    const PackedRows of_cells = rows_of_cells(s, length_m, known_of(std::move(before), length_m));
    OverlapRows& rows = s.local.rows;
    if (!s.cells.empty()) {
        std::vector<bool> wanted(idx(pieces_.size()), false);
        for (std::size_t c = 0; c < of_cells.size(); ++c) {
            for (const PieceRun& run : of_cells.runs(c)) {
                std::fill_n(wanted.begin() + run.first, run.count, true);
            }
        }
        PackedRows of_candidates;
        {
            const CandidateRows some = candidates_covering(job_, candidates_, wanted);
            for (const std::int32_t c : some.number) s.component.push_back(component_[idx(c)]);
            for (const OverlapRow& row : some.rows) add(row, of_candidates, length_m);
        }
        rows.piece.reserve(idx(of_candidates.entries() + of_cells.entries()));
        rows.begin.reserve(of_candidates.size() + of_cells.size() + 1);
        for (const PackedRows* part : {&std::as_const(of_candidates), &of_cells}) {
            for (std::size_t r = 0; r < part->size(); ++r) part->unpack(r, rows);
        }
    }
    if (!rows.piece.empty()) {
        const auto [least, most] = std::minmax_element(rows.piece.begin(), rows.piece.end());
        s.first_piece = *least;
        s.local.piece_length_m.assign(length_m.begin() + *least, length_m.begin() + *most + 1);
    }
    for (std::int32_t& p : rows.piece) p -= s.first_piece;
    s.joined = join(job_.threads, problem(s));
    return s;
}

Leader::Known Leader::known_of(std::unique_ptr<State> before, std::vector<double>& length_m) const {
    Known out;
    if (!before) return out;
    out.cells = std::move(before->cells);
    out.twins = std::move(before->twins);
    const OverlapRows& rows = before->local.rows;
    for (auto r = static_cast<std::int32_t>(before->component.size()); r < rows.size(); ++r) {
        out.rows.add(rows.row(r), rows.seen(r, {}).angle_rad, before->first_piece);
    }
    std::copy(before->local.piece_length_m.begin(), before->local.piece_length_m.end(),
              length_m.begin() + before->first_piece);
    return out;
}

void Leader::add(const OverlapRow& row, PackedRows& rows, std::vector<double>& length_m) const {
    const SeenRow seen = row.seen();
    rows.add(seen.piece, by_angle() ? seen.angle_rad : std::span<const float>());
    for (std::size_t i = 0; i < seen.piece.size(); ++i) {
        length_m[idx(seen.piece[i])] = seen.length_of(i);
    }
}

PackedRows Leader::rows_of_cells(State& s, std::vector<double>& length_m, Known before) const {
    constexpr std::size_t at_once = 4096;
    std::vector<std::int64_t>& cells = s.cells;
    s.twins = std::move(before.twins);
    std::erase_if(cells, [&](std::int64_t c) {
        return std::binary_search(s.twins.begin(), s.twins.end(), c);
    });
    const auto known = [&](std::int64_t cell) {
        const auto at = std::lower_bound(before.cells.begin(), before.cells.end(), cell);
        return at != before.cells.end() && *at == cell ? at - before.cells.begin() : nobody;
    };
    PackedRows all;
    for (std::size_t from = 0; from < cells.size(); from += at_once) {
        const std::size_t to = std::min(cells.size(), from + at_once);
        std::vector<Vec2d> eyes;
        for (std::size_t i = from; i < to; ++i) {
            if (known(cells[i]) < 0) eyes.push_back(job_.layout().grid.centre(cells[i]));
        }
        const std::vector<OverlapRow> looked = job_.scenes.overlap_rows(job_.threads, eyes);
        for (std::size_t i = from, k = 0; i < to; ++i) {
            const std::ptrdiff_t row = known(cells[i]);
            if (row < 0) {
                add(looked[k++], all, length_m);
            } else {
                all.add(before.rows, idx(row));
            }
        }
    }
    before = {};
    if (by_angle()) return all;
    // Equal rows next to each other, the first one first.
    std::vector<std::size_t> order(cells.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const auto order_of_rows = std::lexicographical_compare_three_way(
            all.runs(a).begin(), all.runs(a).end(), all.runs(b).begin(), all.runs(b).end());
        return order_of_rows != 0 ? order_of_rows < 0 : a < b;
    });
    std::vector<bool> kept(cells.size(), true);
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (std::ranges::equal(all.runs(order[i - 1]), all.runs(order[i]))) kept[order[i]] = false;
    }
    std::size_t count = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (kept[c]) {
            cells[count++] = cells[c];
        } else {
            s.twins.push_back(cells[c]);
        }
    }
    cells.resize(count);
    all.keep(kept);
    std::sort(s.twins.begin(), s.twins.end());
    return all;
}

std::vector<std::int32_t> Leader::seen_by_sets(const State& s) const {
    std::vector<std::int32_t> out(idx(pieces_.size()), nobody);
    const auto see = [&](std::int32_t piece, std::int32_t set) {
        std::int32_t& by = out[idx(piece)];
        by = seen_together(by, set);
    };
    for (const auto& [piece, component] : seen_) {
        see(piece, s.joined.set_of_component[idx(component)]);
    }
    const auto first = static_cast<std::int32_t>(s.component.size());
    for (std::size_t c = 0; c < s.cells.size(); ++c) {
        if (s.joined.set_of_cell[c] == left_out) continue;
        for (const std::int32_t p : s.local.rows.row(first + static_cast<std::int32_t>(c))) {
            see(p + s.first_piece, s.joined.set_of_cell[c]);
        }
    }
    return out;
}

std::vector<std::int32_t> Leader::largest_of_spaces(const State& s, std::int64_t& spaces) const {
    std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t>> seen;  // space, set, piece
    std::vector<std::pair<std::int32_t, std::int32_t>> once;                 // space, piece
    for (const auto& [piece, component] : seen_) {
        const std::int32_t space = space_[idx(piece)];
        seen.emplace_back(space, s.joined.set_of_component[idx(component)], piece);
        once.emplace_back(space, piece);
    }
    sort_once(seen);
    sort_once(once);
    std::vector<bool> of_user(idx(components_.count()), false);
    for (std::size_t c = idx(candidates_.listed()); c < component_.size(); ++c) {
        of_user[idx(s.joined.set_of_component[idx(component_[c])])] = true;
    }
    std::int32_t all = 0;
    for (const std::int32_t space : space_) all = std::max(all, space + 1);
    std::vector<std::int32_t> out(idx(all), -1);
    spaces = 0;
    std::size_t i = 0;
    for (std::size_t first = 0, end = 0; first < once.size(); first = end) {
        const std::int32_t space = once[first].first;
        while (end < once.size() && once[end].first == space) ++end;
        std::size_t most = 0;
        std::int32_t best = -1;
        int user = 0;  // sets with points of the user, besides the largest one
        while (i < seen.size() && std::get<0>(seen[i]) == space) {
            const std::int32_t set = std::get<1>(seen[i]);
            const std::size_t begin = i;
            while (i < seen.size() && std::get<0>(seen[i]) == space &&
                   std::get<1>(seen[i]) == set) {
                ++i;
            }
            user += of_user[idx(set)] ? 1 : 0;
            if (i - begin <= most) continue;
            most = i - begin;
            best = set;
        }
        if (of_user[idx(best)]) --user;
        if (most < end - first || user > 0) out[idx(space)] = best;
        ++spaces;
    }
    return out;
}

std::vector<std::int32_t> Leader::names_in(const CandidateList& list) const {
    std::vector<std::int32_t> first(idx(components_.count()), -1);
    for (std::size_t c = component_.size(); c-- > 0;) {
        first[idx(component_[c])] = static_cast<std::int32_t>(c);
    }
    // Both lists have the same order, and the user's points behind it.
    const std::vector<Candidate> old = candidates_.read(0, candidates_.size());
    const std::vector<Candidate> now = list.read(0, list.size());
    std::vector<std::int32_t> number(old.size());
    for (std::size_t i = 0, k = 0; i < old.size(); ++i, ++k) {
        while (now[k].at != old[i].at) ++k;
        number[i] = static_cast<std::int32_t>(k);
    }
    for (std::int32_t& f : first) f = number[idx(f)];
    return first;
}

}  // namespace vfplan
