// The planning of one network as a problem of its own (docs/planning.md).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/workspace.h"
#include "engine/runtime/parallel.h"
#include "engine/search/problem.h"

namespace vfplan {

struct Network {
    std::vector<std::int32_t> members;  // a component of the graph, ascending
    Chosen chosen;
    Chosen connected;  // the best plan before loops count
};

// What the rows of a problem are.
enum class ProblemRows : std::uint8_t {
    all,     // what the same candidates cover is one
    needed,  // and of those, what is not covered with another one anyhow (reduce.h)
};

// Room for all networks of a job, so that a small one costs what it holds; 4 bytes for each
// candidate and each piece. Rows that are not needed are never held all at once: beyond what is
// returned, memory is about 24 bytes for each of `most_entries` entries of the coverage table.
class NetworkProblems {
public:
    explicit NetworkProblems(const PlanInput& input, std::int64_t most_entries = 1 << 23)
        : in_(input),
          most_entries_(most_entries),
          column_(input.candidates.size(), -1),
          class_(input.piece_length_m.size(), unmet) {}

    // Columns: `members`, a component, ascending. Rows: pieces with owner[piece] == network, in the
    // order in which they are met. Fixed: fixed[candidate].
    Problem of(const std::vector<std::int32_t>& members, const std::vector<std::int32_t>& owner,
               std::int32_t network, const std::vector<std::uint8_t>& fixed, ProblemRows rows);
    // A piece of each row of the last problem.
    const std::vector<std::int32_t>& pieces() const { return piece_; }

private:
    static constexpr std::int32_t unmet = -1;
    static constexpr std::int32_t done = -2;

    using Members = std::vector<std::int32_t>;
    template <class F>
    void each_piece(std::int32_t member, F&& f) const {
        for (const std::int32_t p : in_.rows.row(member)) {
            if ((*owner_)[idx(p)] == network_) f(p);
        }
    }
    std::vector<std::size_t> parts(const Members& members);
    void add_part(const Members& members, std::size_t from, std::size_t to, ProblemRows rows,
                  Sparse& columns_of);

    const PlanInput& in_;
    std::int64_t most_entries_;
    const std::vector<std::int32_t>* owner_ = nullptr;
    std::int32_t network_ = 0;
    std::vector<std::int32_t> column_;  // of candidates
    std::vector<std::int32_t> class_;   // of pieces; `done` where their part was added
    std::vector<std::int32_t> piece_;   // of rows
};

// Calls f(problems, n) for each of so many networks, from any thread, with room that is its own.
template <class F>
void each_network(const Threads& threads, const PlanInput& input, std::size_t networks, F&& f) {
    threads.for_each(static_cast<std::int64_t>(networks), 1,
                     [&](std::int64_t from, std::int64_t to) {
                         NetworkProblems problems(input);
                         for (std::int64_t n = from; n < to; ++n) f(problems, n);
                     });
}

// The columns of chosen candidates. REQUIRES: they are among the members.
Choice columns_of(const std::vector<std::int32_t>& members, const Chosen& chosen);

}  // namespace vfplan
