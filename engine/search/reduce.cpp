#include "engine/search/reduce.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace vfplan {
namespace {

using Lists = std::vector<std::vector<std::int32_t>>;
using Flags = std::vector<std::uint8_t>;

// A bit for each number of a list, shared by many: no subset where a bit is missing.
std::uint64_t bits_of(std::span<const std::int32_t> list, const Flags& there) {
    std::uint64_t bits = 0;
    for (const std::int32_t n : list) {
        if (there[idx(n)] != 0) bits |= std::uint64_t{1} << (static_cast<std::uint32_t>(n) % 64);
    }
    return bits;
}

// Among what is there: is each of `part`, but for `except`, in `whole`? Both ascend.
bool within(std::span<const std::int32_t> part, std::span<const std::int32_t> whole,
            const Flags& there, std::int32_t except) {
    auto at = whole.begin();
    for (const std::int32_t n : part) {
        if (there[idx(n)] == 0 || n == except) continue;
        while (at != whole.end() && *at < n) ++at;
        if (at == whole.end() || *at != n) return false;
    }
    return true;
}

class Reducer {
public:
    explicit Reducer(const Problem& problem)
        : p_(problem), row_(idx(p_.rows()), 1), column_(idx(p_.columns()), 1) {}

    void rows() {
        count(p_.columns_of, column_, row_size_);
        count(p_.rows_of, row_, column_size_);
        std::vector<std::uint64_t> bits(row_.size(), 0);
        std::vector<std::int32_t> order;
        for (std::int32_t r = 0; r < p_.rows(); ++r) {
            if (row_[idx(r)] == 0) continue;
            bits[idx(r)] = bits_of(p_.columns_of.of(r), column_);
            order.push_back(r);
        }
        std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
            return row_size_[idx(a)] < row_size_[idx(b)];
        });
        for (const std::int32_t r : order) {
            if (row_[idx(r)] == 0) continue;
            const std::int32_t c = rarest(p_.columns_of.of(r), column_, column_size_);
            for (const std::int32_t other : p_.rows_of.of(c)) {
                if (other == r || row_[idx(other)] == 0 ||
                    row_size_[idx(other)] < row_size_[idx(r)] ||
                    (bits[idx(r)] & ~bits[idx(other)]) != 0 ||
                    !within(p_.columns_of.of(r), p_.columns_of.of(other), column_, -1)) {
                    continue;
                }
                row_[idx(other)] = 0;
            }
        }
    }

    // Returns whether any went.
    bool columns(std::vector<GoneColumn>& gone) {
        count(p_.columns_of, column_, row_size_);
        count(p_.near, column_, degree_);
        std::vector<std::uint64_t> rows(column_.size(), 0);
        std::vector<std::uint64_t> near(column_.size(), 0);
        for (std::int32_t c = 0; c < p_.columns(); ++c) {
            rows[idx(c)] = bits_of(p_.rows_of.of(c), row_);
            near[idx(c)] = bits_of(p_.near.of(c), column_);
        }
        const auto stands_for = [&](std::int32_t by, std::int32_t c) {
            const std::uint64_t own = std::uint64_t{1} << (static_cast<std::uint32_t>(by) % 64);
            return by != c && column_[idx(by)] != 0 && (rows[idx(c)] & ~rows[idx(by)]) == 0 &&
                   (near[idx(c)] & ~near[idx(by)] & ~own) == 0 &&
                   within(p_.rows_of.of(c), p_.rows_of.of(by), row_, -1) &&
                   within(p_.near.of(c), p_.near.of(by), column_, by);
        };
        bool any = false;
        for (std::int32_t c = 0; c < p_.columns(); ++c) {
            if (column_[idx(c)] == 0 || p_.fixed[idx(c)] != 0) continue;
            const std::int32_t by = first_for(c, stands_for);
            if (by < 0) continue;
            column_[idx(c)] = 0;
            gone.push_back({c, by});
            any = true;
        }
        return any;
    }

    std::vector<std::int32_t> kept_rows() const {
        std::vector<std::int32_t> out;
        numbered(row_, out);
        return out;
    }

    Reduced result(std::vector<GoneColumn> gone) const {
        Reduced out;
        const std::vector<std::int32_t> column = numbered(column_, out.column);
        const std::vector<std::int32_t> row = numbered(row_, out.row);
        Problem& q = out.problem;
        for (const std::int32_t c : out.column) {
            append(p_.rows_of.of(c), row, q.rows_of);
            append(p_.near.of(c), column, q.near);
            q.fixed.push_back(p_.fixed[idx(c)]);
            if (p_.beside.size() > 0) append(p_.beside.of(c), column, q.beside);
        }
        q.columns_of = transposed(q.rows_of, static_cast<std::int32_t>(out.row.size()));
        out.gone = std::move(gone);
        return out;
    }

private:
    template <class StandsFor>
    std::int32_t first_for(std::int32_t c, const StandsFor& stands_for) const {
        if (const std::int32_t r = rarest(p_.rows_of.of(c), row_, row_size_); r >= 0) {
            for (const std::int32_t by : p_.columns_of.of(r)) {
                if (stands_for(by, c)) return by;
            }
            return -1;
        }
        const std::int32_t n = rarest(p_.near.of(c), column_, degree_);
        if (n < 0) return -1;
        if (stands_for(n, c)) return n;
        for (const std::int32_t by : p_.near.of(n)) {
            if (stands_for(by, c)) return by;
        }
        return -1;
    }

    static void count(const Sparse& lists, const Flags& there, std::vector<std::int32_t>& size) {
        size.assign(idx(lists.size()), 0);
        for (std::int32_t i = 0; i < lists.size(); ++i) {
            for (const std::int32_t n : lists.of(i)) size[idx(i)] += there[idx(n)];
        }
    }

    // Of what is there in a list, the one with the smallest list of its own; -1 where none is.
    static std::int32_t rarest(std::span<const std::int32_t> list, const Flags& there,
                               const std::vector<std::int32_t>& size) {
        std::int32_t best = -1;
        for (const std::int32_t n : list) {
            if (there[idx(n)] != 0 && (best < 0 || size[idx(n)] < size[idx(best)])) best = n;
        }
        return best;
    }

    static std::vector<std::int32_t> numbered(const Flags& there, std::vector<std::int32_t>& kept) {
        std::vector<std::int32_t> number(there.size(), -1);
        for (std::size_t i = 0; i < there.size(); ++i) {
            if (there[i] == 0) continue;
            number[i] = static_cast<std::int32_t>(kept.size());
            kept.push_back(static_cast<std::int32_t>(i));
        }
        return number;
    }

    static void append(std::span<const std::int32_t> list, const std::vector<std::int32_t>& number,
                       Sparse& out) {
        for (const std::int32_t n : list) {
            if (number[idx(n)] >= 0) out.to.push_back(number[idx(n)]);
        }
        out.end_list();
    }

    const Problem& p_;
    Flags row_;     // 1: still there
    Flags column_;  // likewise
    std::vector<std::int32_t> row_size_;
    std::vector<std::int32_t> column_size_;
    std::vector<std::int32_t> degree_;
};

}  // namespace

Reduced reduce(const Problem& problem) {
    Reducer reducer(problem);
    std::vector<GoneColumn> gone;
    reducer.rows();
    while (reducer.columns(gone)) reducer.rows();
    return reducer.result(std::move(gone));
}

std::vector<std::int32_t> needed_rows(const Problem& problem) {
    Reducer reducer(problem);
    reducer.rows();
    return reducer.kept_rows();
}

Choice reduced_choice(const Reduced& reduced, std::int32_t columns, const Choice& whole) {
    std::vector<std::int32_t> by(idx(columns));
    for (std::int32_t c = 0; c < columns; ++c) by[idx(c)] = c;
    for (auto g = reduced.gone.rbegin(); g != reduced.gone.rend(); ++g) {
        by[idx(g->gone)] = by[idx(g->by)];
    }
    std::vector<std::int32_t> number(idx(columns), -1);
    for (std::size_t i = 0; i < reduced.column.size(); ++i) {
        number[idx(reduced.column[i])] = static_cast<std::int32_t>(i);
    }
    Choice out;
    for (const std::int32_t c : whole) out.push_back(number[idx(by[idx(c)])]);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

}  // namespace vfplan
