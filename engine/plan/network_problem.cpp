#include "engine/plan/network_problem.h"

#include <algorithm>

#include "engine/search/reduce.h"

namespace vfplan {
namespace {

// Sets of pieces that the same candidates cover, divided further by one candidate after the other.
class Classes {
public:
    explicit Classes(std::vector<std::int32_t>& class_of) : class_of_(class_of) { make(); }

    template <class Pieces, class Wanted>
    void divide(const Pieces& row, const Wanted& wanted) {
        touched_.clear();
        for (const std::int32_t p : row) {
            if (!wanted(p)) continue;
            std::int32_t& mine = class_of_[idx(p)];
            if (mine < 0) {
                mine = 0;
                ++size_.front();
            }
            if (split_[idx(mine)] < 0) {
                touched_.push_back(mine);
                const std::int32_t fresh = make();
                split_[idx(mine)] = fresh;
            }
            --size_[idx(mine)];
            mine = split_[idx(mine)];
            ++size_[idx(mine)];
        }
        for (const std::int32_t c : touched_) {
            split_[idx(c)] = -1;
            if (c > 0 && size_[idx(c)] == 0) free_.push_back(c);
        }
    }

private:
    // Class 0 is that of pieces which no candidate met yet.
    std::int32_t make() {
        if (!free_.empty()) {
            const std::int32_t c = free_.back();
            free_.pop_back();
            return c;
        }
        size_.push_back(0);
        split_.push_back(-1);
        return static_cast<std::int32_t>(size_.size()) - 1;
    }

    std::vector<std::int32_t>& class_of_;
    std::vector<std::int32_t> size_;
    std::vector<std::int32_t> split_;  // where those go that the candidate at hand covers
    std::vector<std::int32_t> free_;
    std::vector<std::int32_t> touched_;
};

// Keeps the lists with these numbers, which ascend.
void keep(const std::vector<std::int32_t>& numbers, Sparse& lists) {
    Sparse out;
    for (const std::int32_t i : numbers) out.add_list(lists.of(i));
    lists = std::move(out);
}

}  // namespace

// Where parts begin and end: a piece belongs to the part with the first member that covers it.
std::vector<std::size_t> NetworkProblems::parts(const Members& members) {
    std::vector<std::int64_t> entries(members.size(), 0);  // of pieces first covered by each
    for (std::size_t i = 0; i < members.size(); ++i) {
        each_piece(members[i], [&](std::int32_t p) {
            if (class_[idx(p)] == unmet) class_[idx(p)] = static_cast<std::int32_t>(i);
            ++entries[idx(class_[idx(p)])];
        });
    }
    std::vector<std::size_t> out = {0};
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
        each_piece(members[i], [&](std::int32_t p) { class_[idx(p)] = unmet; });
        if (sum > 0 && sum + entries[i] > most_entries_) {
            out.push_back(i);
            sum = 0;
        }
        sum += entries[i];
    }
    out.push_back(members.size());
    return out;
}

void NetworkProblems::add_part(const Members& members, std::size_t from, std::size_t to,
                               ProblemRows rows, Sparse& columns_of) {
    Classes classes(class_);
    for (std::size_t i = from; i < members.size(); ++i) {
        classes.divide(in_.rows.row(members[i]), [&](std::int32_t p) {
            const std::int32_t known = class_[idx(p)];
            return (known == unmet && i < to && (*owner_)[idx(p)] == network_) || known >= 0;
        });
    }
    std::vector<std::int32_t> row;    // of classes
    std::vector<std::int32_t> first;  // piece of each row
    Problem part;
    part.rows_of.begin.assign(from + 1, 0);
    for (std::size_t i = from; i < members.size(); ++i) {
        for (const std::int32_t p : in_.rows.row(members[i])) {
            const std::int32_t known = class_[idx(p)];
            if (known < 0) continue;
            if (idx(known) >= row.size()) row.resize(idx(known) + 1, -1);
            std::int32_t& mine = row[idx(known)];
            if (mine < 0) {
                mine = static_cast<std::int32_t>(first.size());
                first.push_back(p);
            }
            if (first[idx(mine)] == p) part.rows_of.to.push_back(mine);
        }
        part.rows_of.end_list();
    }
    for (std::size_t i = from; i < to; ++i) {
        for (const std::int32_t p : in_.rows.row(members[i])) {
            if (class_[idx(p)] >= 0) class_[idx(p)] = done;
        }
    }
    part.columns_of = transposed(part.rows_of, static_cast<std::int32_t>(first.size()));
    const auto add = [&](std::int32_t r) {
        columns_of.add_list(part.columns_of.of(r));
        piece_.push_back(first[idx(r)]);
    };
    if (rows == ProblemRows::needed) {
        for (const std::int32_t r : needed_rows(part)) add(r);
    } else {
        for (std::int32_t r = 0; r < part.rows(); ++r) add(r);
    }
}

Problem NetworkProblems::of(const Members& members, const std::vector<std::int32_t>& owner,
                            std::int32_t network, const std::vector<std::uint8_t>& fixed,
                            ProblemRows rows) {
    owner_ = &owner;
    network_ = network;
    piece_.clear();
    Problem out;
    const std::vector<std::size_t> part = parts(members);
    for (std::size_t k = 1; k < part.size(); ++k) {
        add_part(members, part[k - 1], part[k], rows, out.columns_of);
    }
    const auto columns = static_cast<std::int32_t>(members.size());
    out.rows_of = transposed(out.columns_of, columns);
    if (rows == ProblemRows::needed && part.size() > 2) {
        const std::vector<std::int32_t> needed = needed_rows(out);
        for (std::size_t r = 0; r < needed.size(); ++r) piece_[r] = piece_[idx(needed[r])];
        piece_.resize(needed.size());
        keep(needed, out.columns_of);
        out.rows_of = transposed(out.columns_of, columns);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        column_[idx(members[i])] = static_cast<std::int32_t>(i);
    }
    for (const std::int32_t c : members) {
        in_.graph.each(c, [&](std::int32_t n, double) {
            if (column_[idx(n)] >= 0) out.near.to.push_back(column_[idx(n)]);
        });
        out.near.end_list();
        out.fixed.push_back(fixed[idx(c)]);
    }
    for (const std::int32_t c : members) {
        column_[idx(c)] = -1;
        each_piece(c, [&](std::int32_t p) { class_[idx(p)] = unmet; });
    }
    return out;
}

Choice columns_of(const std::vector<std::int32_t>& members, const Chosen& chosen) {
    Choice out;
    for (const std::int32_t c : chosen) {
        out.push_back(static_cast<std::int32_t>(
            std::lower_bound(members.begin(), members.end(), c) - members.begin()));
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace vfplan
