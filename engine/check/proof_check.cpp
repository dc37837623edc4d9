#include "engine/check/proof_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace vfplan {
namespace {

constexpr std::int64_t impossible = std::numeric_limits<std::int64_t>::max() / 4;

void need(bool good, const char* what) {
    if (!good) throw std::invalid_argument(what);
}

std::int64_t sum(std::int64_t a, std::int64_t b) {
    std::int64_t out = 0;
    need(!__builtin_add_overflow(a, b, &out), "weights are too large");
    return out;
}

}  // namespace

ProofCheck::ProofCheck(const CheckTables& t)
    : t_(t),
      there_(t.near.size(), 0),
      kept_(t.owner.size(), 0),
      covered_by_(t.owner.size()),
      in_root_(there_.size(), 0),
      known_(there_.size(), 0),
      x_(there_.size(), 0),
      r_(there_.size(), 0),
      y_(there_.size()),
      mark_(there_.size(), 0) {}

bool ProofCheck::is_piece(std::int32_t p) const {
    return p >= 0 && idx(p) < t_.owner.size() && t_.owner[idx(p)] == number_;
}

bool ProofCheck::is_candidate(std::int32_t c) const {
    return c >= 0 && idx(c) < there_.size() && there_[idx(c)] != 0;
}

std::string ProofCheck::wrong(std::int32_t number, std::span<const std::int32_t> members,
                              const NetworkProof& proof) {
    number_ = number;
    members_ = members;
    root_.clear();
    std::vector<std::int32_t> pieces;
    const auto keep = [&](std::int32_t p) {
        need(is_piece(p), "a piece is not the network's");
        if (kept_[idx(p)] == 0) pieces.push_back(p);
        kept_[idx(p)] = 1;
    };
    std::string out;
    try {
        for (const std::int32_t c : members) there_[idx(c)] = 1;
        for (const ProofLine& line : proof.lines) {
            if (is_of_piece(line.kind)) keep(line.of);
        }
        if (proof.root_piece >= 0) keep(proof.root_piece);
        remove_gone(proof);
        for (const std::int32_t c : members) {
            if (there_[idx(c)] == 0) continue;
            for (const std::int32_t p : t_.rows.row(c)) {
                if (kept_[idx(p)] != 0) covered_by_[idx(p)].push_back(c);
            }
            y_[idx(c)].assign(t_.near[idx(c)].size(), 0);
        }
        if (proof.root_piece >= 0) {
            need(proof.root_station < 0, "there are two roots");
            root_ = covered_by_[idx(proof.root_piece)];
        } else {
            need(is_candidate(proof.root_station) && t_.standing[idx(proof.root_station)] != 0,
                 "the root need not stand");
            root_ = {proof.root_station};
        }
        for (const std::int32_t c : root_) in_root_[idx(c)] = 1;
        for (const ProofLine& line : proof.lines) check_line(line);
        std::size_t next = 0;
        const std::int64_t value = value_of_cases(proof, next);
        need(next == proof.cases.size(), "there are cases too many");
        const std::int64_t bound = value <= 0 ? 0 : (value - 1) / proof_scale + 1;
        if (bound < proof.bound) out = fmt::format("it proves {} only", bound);
    } catch (const std::invalid_argument& e) {
        out = e.what();
    }
    for (const std::int32_t c : members) {
        there_[idx(c)] = mark_[idx(c)] = in_root_[idx(c)] = 0;
        known_[idx(c)] = 0;
        y_[idx(c)] = {};
    }
    for (const std::int32_t p : pieces) {
        kept_[idx(p)] = 0;
        covered_by_[idx(p)] = {};
    }
    return out;
}

// In a plan with `gone` it could be replaced by `by`.
void ProofCheck::remove_gone(const NetworkProof& proof) {
    for (const auto& [gone, by] : proof.gone) {
        need(is_candidate(gone) && is_candidate(by) && gone != by,
             "a candidate that went, or what it went by, is not there");
        need(t_.standing[idx(gone)] == 0, "a candidate went that must stand");
        const auto row = t_.rows.row(by);
        for (const std::int32_t p : t_.rows.row(gone)) {
            need(kept_[idx(p)] == 0 || std::binary_search(row.begin(), row.end(), p),
                 "a candidate went that covers more");
        }
        const auto& near = t_.near[idx(by)];
        for (const std::int32_t n : t_.near[idx(gone)]) {
            need(n == by || there_[idx(n)] == 0 || std::binary_search(near.begin(), near.end(), n),
                 "a candidate went that joins more");
        }
        there_[idx(gone)] = 0;
    }
}

void ProofCheck::check_line(const ProofLine& line) {
    const auto& w = line.within;
    for (std::size_t i = 0; i < w.size(); ++i) {
        need(is_candidate(w[i]) && (i == 0 || w[i - 1] < w[i]), "a line's set is none");
    }
    switch (line.kind) {
        case LineKind::cover:
        case LineKind::nodes:
        case LineKind::arcs:
        case LineKind::root:
            return;
        case LineKind::first:
            need(is_candidate(line.of) && in_root_[idx(line.of)] != 0, "a first one is no root");
            return;
        case LineKind::pair:
            need(is_candidate(line.of) && w.size() == 1, "a pair is none");
            need(std::binary_search(t_.near[idx(line.of)].begin(), t_.near[idx(line.of)].end(),
                                    w.front()),
                 "a pair is not near");
            return;
        case LineKind::nodes_of:
        case LineKind::arcs_of:
            need(std::binary_search(w.begin(), w.end(), line.of), "a line is not of its set");
            return;
    }
}

std::int64_t ProofCheck::value_of_cases(const NetworkProof& proof, std::size_t& next) {
    // Candidates that cases on the way down are divided by, each with what is known of it now.
    std::vector<std::int32_t> way_down;
    std::int64_t least = impossible;
    while (true) {
        need(next < proof.cases.size(), "a case is missing");
        const ProofCase& here = proof.cases[next++];
        if (here.branch >= 0) {
            need(is_candidate(here.branch) && known_[idx(here.branch)] == 0,
                 "a case is divided by nothing");
            need(here.weights.empty(), "a divided case has weights");
            known_[idx(here.branch)] = -1;
            way_down.push_back(here.branch);
            continue;
        }
        least = std::min(least, value_of_leaf(proof, here));
        while (!way_down.empty() && known_[idx(way_down.back())] == 1) {
            known_[idx(way_down.back())] = 0;
            way_down.pop_back();
        }
        if (way_down.empty()) return least;
        known_[idx(way_down.back())] = 1;
    }
}

std::int64_t& ProofCheck::way(std::int32_t from, std::int32_t to) {
    const auto& near = t_.near[idx(to)];
    return y_[idx(to)][idx(std::lower_bound(near.begin(), near.end(), from) - near.begin())];
}

void ProofCheck::add(const ProofLine& line, std::int64_t weight) {
    const auto give = [&](std::int64_t& to, std::int64_t w) { to = sum(to, w); };
    for (const std::int32_t c : line.within) mark_[idx(c)] = 1;
    std::vector<std::int32_t> around;
    if (is_of_piece(line.kind)) {
        for (const std::int32_t c : covered_by_[idx(line.of)]) {
            if (mark_[idx(c)] == 0) around.push_back(c);
        }
    }
    if (line.kind == LineKind::nodes || line.kind == LineKind::nodes_of) {
        for (const std::int32_t c : line.within) {
            if (in_root_[idx(c)] != 0) around.push_back(c);
            for (const std::int32_t n : t_.near[idx(c)]) {
                if (there_[idx(n)] != 0 && mark_[idx(n)] == 0) around.push_back(n);
            }
        }
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
    }
    for (const std::int32_t c : around) give(x_[idx(c)], weight);
    if (line.kind == LineKind::arcs || line.kind == LineKind::arcs_of) {
        for (const std::int32_t c : line.within) {
            if (in_root_[idx(c)] != 0) give(r_[idx(c)], weight);
            const auto& near = t_.near[idx(c)];
            for (std::size_t k = 0; k < near.size(); ++k) {
                if (mark_[idx(near[k])] == 0) give(y_[idx(c)][k], weight);
            }
        }
    }
    if (line.kind == LineKind::root || line.kind == LineKind::first) {
        for (const std::int32_t c : root_) {
            if (line.kind == LineKind::root || c <= line.of) give(r_[idx(c)], weight);
        }
    }
    if (line.kind == LineKind::pair) {
        give(x_[idx(line.of)], weight);
        give(way(line.of, line.within.front()), -weight);
        give(way(line.within.front(), line.of), -weight);
    } else if (line.kind == LineKind::nodes_of || line.kind == LineKind::arcs_of ||
               line.kind == LineKind::first) {
        give(x_[idx(line.of)], -weight);
    }
    for (const std::int32_t c : line.within) mark_[idx(c)] = 0;
}

std::int64_t ProofCheck::value_of_leaf(const NetworkProof& proof, const ProofCase& leaf) {
    constexpr std::int64_t largest = std::int64_t{1} << 46;
    std::int64_t value = 0;
    for (const std::int32_t c : members_) {
        x_[idx(c)] = r_[idx(c)] = 0;
        std::fill(y_[idx(c)].begin(), y_[idx(c)].end(), 0);
    }
    for (const auto& [number, weight] : leaf.weights) {
        need(number >= 0 && idx(number) < proof.lines.size(), "a weight is of no line");
        const ProofLine& line = proof.lines[idx(number)];
        need(weight <= largest && weight >= -largest, "a weight is too large");
        need(weight >= 0 || line.kind == LineKind::root, "a weight is negative");
        if (is_of_piece(line.kind) || line.kind == LineKind::root) value = sum(value, weight);
        add(line, weight);
    }
    // Stations less weighted lines: a sum over candidates. A station is the root or has one way
    // into it; one that has to stand counts in any case, any other where that is less.
    bool has_plans = true;
    for (const std::int32_t c : members_) {
        if (there_[idx(c)] == 0) continue;
        bool reached = in_root_[idx(c)] != 0;
        std::int64_t most = r_[idx(c)];
        const auto& near = t_.near[idx(c)];
        for (std::size_t k = 0; k < near.size(); ++k) {
            if (there_[idx(near[k])] == 0 || known_[idx(near[k])] < 0) continue;
            most = reached ? std::max(most, y_[idx(c)][k]) : y_[idx(c)][k];
            reached = true;
        }
        const bool must = t_.standing[idx(c)] != 0 || known_[idx(c)] > 0;
        if (known_[idx(c)] < 0 || !reached) {
            has_plans = has_plans && !must;
            continue;
        }
        const std::int64_t cost = sum(proof_scale, -sum(x_[idx(c)], most));
        if (must || cost < 0) value = sum(value, cost);
    }
    return has_plans ? value : impossible;
}

}  // namespace vfplan
