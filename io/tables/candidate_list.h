// work/.../rescues.h5 and connectors.h5: all candidates that there are by then.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/tables/shard.h"
#include "kernels/candidate.h"
#include "kernels/layout.h"

namespace vfplan {

// What is known of a list beside its candidates.
struct ListCounts {
    std::int64_t components = 0;      // of their overlap graph
    std::int64_t rescued_pieces = 0;  // that rescues cover and nothing before
};

// Puts candidates in order, by patch, then row, then column, each point once (of equal ones the
// kind that comes first). Their VF is not kept.
void write_candidate_list(const std::filesystem::path& path, const std::string& key,
                          const Layout& layout, std::vector<Candidate> candidates,
                          const ListCounts& counts = {});

// A list, and behind it the user's points in the order of the job, all numbered from 0 on.
// Thread-safe. Throws IoError.
class CandidateList {
public:
    CandidateList(std::filesystem::path file, Layout layout, std::vector<Candidate> of_user);

    std::int64_t listed() const { return listed_; }  // without the user's points
    std::int64_t size() const { return listed_ + static_cast<std::int64_t>(of_user_.size()); }
    ListCounts counts() const;
    // Numbers [from, to).
    std::vector<Candidate> read(std::int64_t from, std::int64_t to) const;
    // Those in the patches that a window touches, with their numbers, ascending.
    struct Part {
        std::vector<std::int32_t> number;
        std::vector<Candidate> candidates;
    };
    Part in(const Window& window) const;

private:
    std::filesystem::path file_;
    Layout layout_;
    std::vector<Candidate> of_user_;
    std::int64_t listed_ = 0;
};

}  // namespace vfplan
