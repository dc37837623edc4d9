#include "engine/joining/joins.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <tuple>
#include <unordered_map>

#include "engine/joining/chains.h"
#include "engine/joining/components.h"
#include "engine/joining/disputes.h"
#include "engine/joining/knowledge.h"
#include "engine/joining/takers.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

ShardNames shards_of(const TableJob& job, int round) {
    return job.passing("disputed", fmt::format("-{}", round));
}

// What follows from the cells that are known to be disputed.
struct State {
    std::vector<std::int64_t> cells;
    std::vector<std::int32_t> component;  // of the candidates whose rows come first
    LocalRows local;
    std::int32_t first_piece = 0;  // of the site, is 0 in the local rows
    Joined joined;
};

// Works on the leader, when it is asked to.
class Leader {
public:
    Leader(const TableJob& job, const SiteStore& site, const CandidateList& candidates,
           const Components& components, const OverlapRule& rule)
        : job_(job), site_(site), candidates_(candidates), components_(components), rule_(rule) {}

    DisputeRound round(int number) {
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
        if (number > 0) before = read_dispute_round(shards_of(job_, number - 1).whole());
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

    // The list of all candidates, and how many components they make.
    std::vector<Candidate> all_candidates(int rounds, std::int64_t& count) {
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

    // `list`: of all candidates, by whose numbers components are named.
    Apart apart(int rounds, const CandidateList& list) {
        know();
        know_spaces();
        const State& s = state(rounds);
        Apart out;
        out.free_cells = site_.facts().free_cells;
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

private:
    static constexpr std::int32_t nobody = -1;
    static constexpr std::int32_t several = -2;

    void know() {
        if (known_) return;
        known_ = true;
        std::vector<std::int32_t> all(idx(candidates_.size()));
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
        component_ = components_.of(all);
        seen_ = pieces_of_components(job_, candidates_, component_);
    }

    void know_spaces() {
        if (!space_.empty()) return;
        pieces_ = site_.all_pieces(site_.all_walls());
        space_ = spaces_of_pieces(job_, site_, pieces_);
    }

    // Whether one component covers all that any does, and no other has points of the user.
    bool one_sees_all() const {
        std::vector<std::int64_t> count(idx(components_.count()), 0);
        std::int64_t all = 0;
        for (std::size_t i = 0; i < seen_.size(); ++i) {
            ++count[idx(seen_[i].second)];
            if (i == 0 || seen_[i].first != seen_[i - 1].first) ++all;
        }
        const auto most = std::max_element(count.begin(), count.end());
        const auto best = static_cast<std::int32_t>(most - count.begin());
        return *most == all &&
               std::all_of(component_.begin() + candidates_.listed(), component_.end(),
                           [&](std::int32_t c) { return c == best; });
    }

    JoinProblem problem(const State& s) const {
        return {s.local, s.component, components_.count(), rule_};
    }

    // With the cells of all rounds before.
    const State& state(int round) {
        if (state_ && state_of_ == round) return *state_;
        state_ = std::make_unique<State>();
        state_of_ = round;
        State& s = *state_;
        for (int r = 0; r < round; ++r) {
            for (std::int64_t tile = 0; tile < job_.layout().tiles(); ++tile) {
                const auto some = read_disputed_cells(shards_of(job_, r).one(tile));
                s.cells.insert(s.cells.end(), some.begin(), some.end());
            }
        }
        std::sort(s.cells.begin(), s.cells.end());
        s.cells.erase(std::unique(s.cells.begin(), s.cells.end()), s.cells.end());
        std::vector<OverlapRow> of_cells = rows_of_cells(s.cells);
        std::vector<bool> wanted(idx(pieces_.size()), false);
        for (const OverlapRow& row : of_cells) {
            for (const std::int32_t p : row.seen().piece) wanted[idx(p)] = true;
        }
        CandidateRows some;
        if (!of_cells.empty()) some = candidates_covering(job_, candidates_, wanted);
        for (const std::int32_t c : some.number) s.component.push_back(component_[idx(c)]);
        std::vector<OverlapRow> rows = std::move(some.rows);
        for (OverlapRow& row : of_cells) rows.push_back(std::move(row));
        s.first_piece = 0;
        for (const OverlapRow& row : rows) {
            const std::int32_t first = row.seen().piece.front();
            s.first_piece = &row == rows.data() ? first : std::min(s.first_piece, first);
        }
        s.local = local_rows(rows);
        s.joined = join(job_.threads, problem(s));
        return s;
    }

    // Of cells with equal rows the first stays, where overlap goes by length.
    std::vector<OverlapRow> rows_of_cells(std::vector<std::int64_t>& cells) const {
        std::vector<Vec2d> eyes;
        for (const std::int64_t c : cells) eyes.push_back(job_.layout().grid.centre(c));
        std::vector<OverlapRow> rows = job_.scenes.overlap_rows(job_.threads, eyes);
        if (formula(rule_.ratio).by_angle) return rows;
        std::vector<std::size_t> order(rows.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        const auto pieces = [&](std::size_t i) { return rows[i].seen().piece; };
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const auto x = pieces(a);
            const auto y = pieces(b);
            if (std::lexicographical_compare(x.begin(), x.end(), y.begin(), y.end())) return true;
            return std::equal(x.begin(), x.end(), y.begin(), y.end()) && a < b;
        });
        std::vector<std::size_t> kept;
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (i > 0) {
                const auto x = pieces(order[i - 1]);
                const auto y = pieces(order[i]);
                if (std::equal(x.begin(), x.end(), y.begin(), y.end())) continue;
            }
            kept.push_back(order[i]);
        }
        std::sort(kept.begin(), kept.end());
        std::vector<std::int64_t> cells_kept;
        std::vector<OverlapRow> rows_kept;
        for (const std::size_t i : kept) {
            cells_kept.push_back(cells[i]);
            rows_kept.push_back(std::move(rows[i]));
        }
        cells = std::move(cells_kept);
        return rows_kept;
    }

    // For each piece the set that sees it, or several or nobody.
    std::vector<std::int32_t> seen_by_sets(const State& s) const {
        std::vector<std::int32_t> out(idx(pieces_.size()), nobody);
        const auto see = [&](std::int32_t piece, std::int32_t set) {
            std::int32_t& by = out[idx(piece)];
            by = by == nobody || by == set ? set : several;
        };
        for (const auto& [piece, component] : seen_) {
            see(piece, s.joined.set_of_component[idx(component)]);
        }
        const auto first = static_cast<std::int32_t>(s.component.size());
        for (std::size_t c = 0; c < s.cells.size(); ++c) {
            for (const std::int32_t p : s.local.rows.row(first + static_cast<std::int32_t>(c))) {
                see(p + s.first_piece, s.joined.set_of_cell[c]);
            }
        }
        return out;
    }

    // For each space the set that sees most of its pieces; -1 where nothing is to be joined: nobody
    // sees anything, or one set sees all that is seen there and has all points of the user.
    // `spaces`: where anything is seen.
    std::vector<std::int32_t> largest_of_spaces(const State& s, std::int64_t& spaces) const {
        std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t>>
            seen;                                                 // space, set, piece
        std::vector<std::pair<std::int32_t, std::int32_t>> once;  // space, piece
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

    // Of each component the number of its first candidate in another list.
    std::vector<std::int32_t> names_in(const CandidateList& list) const {
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

    const TableJob& job_;
    const SiteStore& site_;
    const CandidateList& candidates_;
    const Components& components_;
    const OverlapRule& rule_;
    bool known_ = false;
    std::vector<std::int32_t> component_;  // of each candidate
    std::vector<PieceComponent> seen_;
    Pieces pieces_;
    std::vector<std::int32_t> space_;  // of each piece
    int state_of_ = -1;
    std::unique_ptr<State> state_;
};

}  // namespace

Joins make_joins(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                 const CandidateList& candidates, const std::vector<Candidate>& of_user,
                 const OverlapRule& rule) {
    if (candidates.components() < 2) return {candidates, {}};
    const Components components = make_components(job, candidates, rule, "-joined");
    Leader leader(job, site, candidates, components, rule);
    int round = 0;
    for (;; ++round) {
        const ShardNames names = shards_of(job, round);
        make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
            write_dispute_round(path, job.key, leader.round(round));
        });
        const DisputeRound begin = read_dispute_round(names.whole());
        if (!begin.open && round == 0 && begin.spaces < 2) return {candidates, {}};
        if (!begin.open) break;
        make_disputed(job, names, site, field, begin, round == 0, rule);
    }
    const ShardNames names = job.passing("joins");
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        std::int64_t count = 0;
        std::vector<Candidate> all = leader.all_candidates(round, count);
        write_candidate_list(path, job.key, job.layout(), std::move(all), count);
    });
    CandidateList list{names.whole(), job.layout(), of_user};
    const std::filesystem::path apart = names.whole().parent_path() / "apart.h5";
    make_one(job, names.phase(), apart, [&](const std::filesystem::path& path) {
        write_apart(path, job.key, leader.apart(round, list));
    });
    return {list, read_apart(apart)};
}

}  // namespace vfplan
