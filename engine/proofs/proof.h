// Proofs that a network needs a number of stations (docs/planning.md, "Bounds and certificates").
#pragma once

#include <cstdint>

#include "engine/search/problem.h"
#include "kernels/certificate.h"

namespace vfplan {

// Turns numbers of columns and rows into others, all but those of `gone`.
void renumber(const std::vector<std::int32_t>& column, const std::vector<std::int32_t>& row,
              NetworkProof& proof);

// In all of these pieces and candidates are rows and columns of the problem. `plan` is one of its
// plans. All follow from their arguments alone and are thread-safe.

// By what rows weigh, each by itself: fast.
NetworkProof weighed_proof(const Problem& problem, const Choice& plan);

struct Proven {
    NetworkProof proof;
    Choice plan;  // never worse than the one that was given
};
// By linear programs and cases, until no better plan is left or the effort is spent; never weaker
// than the fast one. `effort` is in millions of numbers looked at, about 5 ms each.
Proven prove(const Problem& problem, const Choice& plan, std::int64_t effort);

}  // namespace vfplan
