#include "engine/proofs/lp.h"

#include <glpk.h>

#include <algorithm>

namespace vfplan {
namespace {

// GLPK keeps what it shares among its problems by thread.
thread_local int problems_here = 0;

}  // namespace

struct Lp::Impl {
    glp_prob* lp = nullptr;
    std::vector<int> at;  // GLPK numbers from 1 and does not look at place 0
    std::vector<double> value;

    void fill(std::span<const LpEntry> entries) {
        at.assign(1, 0);
        value.assign(1, 0);
        for (const LpEntry& e : entries) {
            at.push_back(e.at + 1);
            value.push_back(e.value);
        }
    }
};

Lp::Lp() : impl_(std::make_unique<Impl>()) {
    ++problems_here;
    glp_term_out(GLP_OFF);
    impl_->lp = glp_create_prob();
    glp_set_obj_dir(impl_->lp, GLP_MIN);
}

Lp::~Lp() {
    glp_delete_prob(impl_->lp);
    if (--problems_here == 0) glp_free_env();
}

std::int32_t Lp::rows() const { return glp_get_num_rows(impl_->lp); }
std::int32_t Lp::columns() const { return glp_get_num_cols(impl_->lp); }

void Lp::add_column(double cost, double most, std::span<const LpEntry> entries) {
    const int j = glp_add_cols(impl_->lp, 1);
    glp_set_obj_coef(impl_->lp, j, cost);
    set_bounds(j - 1, 0, most);
    if (entries.empty()) return;
    impl_->fill(entries);
    glp_set_mat_col(impl_->lp, j, static_cast<int>(entries.size()), impl_->at.data(),
                    impl_->value.data());
}

void Lp::add_row(std::span<const LpEntry> entries, double least, bool equation) {
    const int i = glp_add_rows(impl_->lp, 1);
    glp_set_row_bnds(impl_->lp, i, equation ? GLP_FX : GLP_LO, least, least);
    impl_->fill(entries);
    glp_set_mat_row(impl_->lp, i, static_cast<int>(entries.size()), impl_->at.data(),
                    impl_->value.data());
}

void Lp::delete_rows(const std::vector<std::int32_t>& rows) {
    if (rows.empty()) return;
    std::vector<int> list = {0};
    for (const std::int32_t r : rows) list.push_back(r + 1);
    glp_del_rows(impl_->lp, static_cast<int>(rows.size()), list.data());
}

void Lp::set_bounds(std::int32_t column, double least, double most) {
    const int j = column + 1;
    glp_set_col_bnds(impl_->lp, j, least == most ? GLP_FX : GLP_DB, least, most);
    // A column out of the basis stands at one of its bounds.
    const int where = glp_get_col_stat(impl_->lp, j);
    if (where == GLP_BS) return;
    if (least == most) {
        glp_set_col_stat(impl_->lp, j, GLP_NS);
    } else if (where == GLP_NS || where == GLP_NF || where == GLP_NL) {
        glp_set_col_stat(impl_->lp, j, GLP_NL);
    }
}

LpEnd Lp::solve(std::int64_t iterations, double limit, bool primal) {
    glp_smcp how;
    glp_init_smcp(&how);
    how.msg_lev = GLP_MSG_OFF;
    how.meth = primal ? GLP_PRIMAL : GLP_DUALP;
    how.obj_ul = limit;
    how.it_lim = static_cast<int>(std::min<std::int64_t>(iterations, 1 << 30));
    const int before = glp_get_it_cnt(impl_->lp);
    int code = glp_simplex(impl_->lp, &how);
    if (code != 0 && code != GLP_EITLIM && code != GLP_EOBJUL) {
        glp_adv_basis(impl_->lp, 0);
        code = glp_simplex(impl_->lp, &how);
    }
    iterations_ += glp_get_it_cnt(impl_->lp) - before;
    if (code == GLP_EOBJUL) return LpEnd::cut_off;
    return code == 0 && glp_get_status(impl_->lp) == GLP_OPT ? LpEnd::solved : LpEnd::stopped;
}

double Lp::value() const { return glp_get_obj_val(impl_->lp); }
double Lp::of_column(std::int32_t column) const { return glp_get_col_prim(impl_->lp, column + 1); }
double Lp::weight_of_row(std::int32_t row) const { return glp_get_row_dual(impl_->lp, row + 1); }
bool Lp::is_slack(std::int32_t row) const { return glp_get_row_stat(impl_->lp, row + 1) == GLP_BS; }

}  // namespace vfplan
