#include "engine/joining/joins.h"

#include "engine/joining/components.h"
#include "engine/joining/disputes.h"
#include "engine/joining/leader.h"

namespace vfplan {

Joins make_joins(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                 const CandidateList& candidates, const std::vector<Candidate>& of_user,
                 const OverlapRule& rule) {
    if (candidates.counts().components < 2) return {candidates, {}};
    const Components components = make_components(job, candidates, rule, "-joined");
    Leader leader(job, site, candidates, components, rule);
    int round = 0;
    std::vector<ShardNames> rounds;
    for (;; ++round) {
        const ShardNames& names = rounds.emplace_back(shards_of_round(job, round));
        make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
            write_dispute_round(path, job.key, leader.round(round));
        });
        const DisputeRound begin = read_dispute_round(names.whole());
        if (!begin.open && round == 0 && begin.spaces < 2) return {candidates, {}};
        if (!begin.open) break;
        make_disputed(job, rounds, site, field, begin, rule);
    }
    const ShardNames names = job.passing("joins");
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        std::int64_t count = 0;
        std::vector<Candidate> all = leader.all_candidates(round, count);
        write_candidate_list(path, job.key, job.layout(), std::move(all), {count});
    });
    CandidateList list{names.whole(), job.layout(), of_user};
    const std::filesystem::path apart = names.whole().parent_path() / "apart.h5";
    make_one(job, names.phase(), apart, [&](const std::filesystem::path& path) {
        write_apart(path, job.key, leader.apart(round, list));
    });
    return {list, read_apart(apart)};
}

}  // namespace vfplan
