// What the leader works out between rounds while networks are joined.
#pragma once

#include <memory>
#include <vector>

#include "engine/joining/chains.h"
#include "engine/joining/knowledge.h"
#include "engine/joining/meetings.h"
#include "engine/joining/row_store.h"
#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/join_shards.h"
#include "io/tables/path_shards.h"
#include "io/tables/site_store.h"

namespace vfplan {

// The shards of a round of phase "disputed".
ShardNames shards_of_round(const TableJob& job, int round);

// Works when it is asked to, from the cells that the rounds before have found. Memory: the rows of
// those cells and of the candidates that share a piece with them, and some bytes for each piece of
// the site. Refers to what it is made of; one thread at a time, but it works on all of the job's.
class Leader {
public:
    // `components`: of the candidates.
    Leader(const TableJob& job, const SiteStore& site, const CandidateList& candidates,
           const Components& components, const OverlapRule& rule)
        : job_(job), site_(site), candidates_(candidates), components_(components), rule_(rule) {}

    // Where round `number` begins.
    DisputeRound round(int number);
    // After so many rounds: the list of all candidates, and how many components they make.
    std::vector<Candidate> all_candidates(int rounds, std::int64_t& count);
    // How far they are apart. `list`: of all candidates, by whose numbers components are named.
    Apart apart(int rounds, const CandidateList& list);

private:
    static constexpr std::int32_t nobody = sees_nothing;
    static constexpr std::int32_t several = sees_several;

    // What follows from the cells that are known to be disputed.
    struct State {
        std::vector<std::int64_t> cells;
        std::vector<std::int64_t> twins;      // left out for their equals, ascending
        std::vector<std::int32_t> component;  // of the candidates whose rows come first
        LocalRows local;
        std::int32_t first_piece = 0;  // of the site, is 0 in the local rows
        Joined joined;
    };

    void know();
    void know_spaces();
    // Whether one component covers all that any does, and no other has points of the user.
    bool one_sees_all() const;
    JoinProblem problem(const State& s) const {
        return {s.local, s.component, components_.count(), rule_};
    }
    // With the cells of all rounds before.
    const State& state(int round);
    bool by_angle() const { return formula(rule_.ratio).by_angle; }
    // Appends a row, without its angles where overlap goes by length; notes the lengths of its
    // pieces.
    void add(const OverlapRow& row, PackedRows& rows, std::vector<double>& length_m) const;
    // What is known of cells from a state of fewer rounds, or nothing.
    struct Known {
        std::vector<std::int64_t> cells;
        std::vector<std::int64_t> twins;
        PackedRows rows;  // of the cells
    };
    // Notes the lengths of pieces.
    Known known_of(std::unique_ptr<State> before, std::vector<double>& length_m) const;
    // Of the state's cells, in the site's numbering, without angles where overlap goes by length;
    // of cells with equal rows the first stays then. Notes the lengths of pieces. What is known
    // before is not looked at again.
    PackedRows rows_of_cells(State& s, std::vector<double>& length_m, Known before) const;
    // For each piece the set that sees it, or several or nobody.
    std::vector<std::int32_t> seen_by_sets(const State& s) const;
    // For each space the set that sees most of its pieces; -1 where nothing is to be joined: nobody
    // sees anything, or one set sees all that is seen there and has all points of the user.
    // `spaces`: where anything is seen.
    std::vector<std::int32_t> largest_of_spaces(const State& s, std::int64_t& spaces) const;
    // Of each component the number of its first candidate in another list.
    std::vector<std::int32_t> names_in(const CandidateList& list) const;

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

}  // namespace vfplan
