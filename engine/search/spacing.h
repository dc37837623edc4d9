// Which places stand nearer to each other than they should.
#pragma once

#include <span>

#include "engine/graphs/sparse.h"
#include "kernels/vec.h"

namespace vfplan {

// Of each place the others that are nearer to it than `spacing_m`, ascending. Takes time with the
// places that are as near in x. Thread-safe.
Sparse nearer_than(std::span<const Vec2d> places, double spacing_m);

}  // namespace vfplan
