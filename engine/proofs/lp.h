// The door to GLPK: one linear program that grows and is solved again and again.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace vfplan {

struct LpEntry {
    std::int32_t at = 0;  // column or row
    double value = 0;
};

enum class LpEnd : std::uint8_t {
    solved,
    cut_off,  // the value reached the limit, and the weights show it
    stopped,  // out of iterations, or the numbers gave way: weights mean nothing
};

// Minimises cost * x. Rows and columns are numbered from 0 as they come; when rows are deleted,
// those behind move up. Belongs to one thread. The same calls give the same bits.
class Lp {
public:
    Lp();
    ~Lp();
    Lp(const Lp&) = delete;
    Lp& operator=(const Lp&) = delete;

    // Entries are by row.
    void add_column(double cost, double most, std::span<const LpEntry> entries = {});
    // entries * x >= least, or = least.
    void add_row(std::span<const LpEntry> entries, double least, bool equation);
    void delete_rows(const std::vector<std::int32_t>& rows);
    void set_bounds(std::int32_t column, double least, double most);
    std::int32_t rows() const;
    std::int32_t columns() const;

    // Goes on from where it ended before: with rows that were added first by the dual simplex, with
    // columns by the primal one.
    LpEnd solve(std::int64_t iterations, double limit, bool primal = false);
    std::int64_t iterations() const { return iterations_; }  // all so far
    double value() const;
    double of_column(std::int32_t column) const;
    double weight_of_row(std::int32_t row) const;
    bool is_slack(std::int32_t row) const;  // its slack is in the basis

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::int64_t iterations_ = 0;
};

}  // namespace vfplan
