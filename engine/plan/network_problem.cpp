#include "engine/plan/network_problem.h"

#include <algorithm>

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

}  // namespace

Problem NetworkProblems::of(const std::vector<std::int32_t>& members,
                            const std::vector<std::int32_t>& owner, std::int32_t network,
                            const std::vector<std::uint8_t>& fixed) {
    const auto is_wanted = [&](std::int32_t p) { return owner[idx(p)] == network; };
    Classes classes(class_);
    for (const std::int32_t c : members) classes.divide(in_.rows.row(c), is_wanted);

    Problem out;
    std::vector<std::int32_t> row;  // of classes
    std::vector<std::int32_t>& first = piece_;
    first.clear();
    for (std::size_t i = 0; i < members.size(); ++i) {
        column_[idx(members[i])] = static_cast<std::int32_t>(i);
    }
    for (const std::int32_t c : members) {
        for (const std::int32_t p : in_.rows.row(c)) {
            if (!is_wanted(p)) continue;
            const auto mine = idx(class_[idx(p)]);
            if (mine >= row.size()) row.resize(mine + 1, -1);
            if (row[mine] < 0) {
                row[mine] = static_cast<std::int32_t>(first.size());
                first.push_back(p);
            }
            if (first[idx(row[mine])] == p) out.rows_of.to.push_back(row[mine]);
        }
        out.rows_of.end_list();
        in_.graph.each(c, [&](std::int32_t n, double) {
            if (column_[idx(n)] >= 0) out.near.to.push_back(column_[idx(n)]);
        });
        out.near.end_list();
        out.fixed.push_back(fixed[idx(c)]);
    }
    for (std::int32_t c = 0; c < out.rows_of.size(); ++c) {
        std::sort(out.rows_of.to.begin() + out.rows_of.begin[idx(c)],
                  out.rows_of.to.begin() + out.rows_of.begin[idx(c) + 1]);
    }
    out.columns_of = transposed(out.rows_of, static_cast<std::int32_t>(first.size()));
    for (const std::int32_t c : members) {
        column_[idx(c)] = -1;
        for (const std::int32_t p : in_.rows.row(c)) class_[idx(p)] = -1;
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
