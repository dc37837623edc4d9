// How the program ends.
#pragma once

#include <functional>

namespace vfplan {

class Ranks;

// Runs a program on all ranks and gives its exit code. What an exception says is printed once.
int run_to_end(const std::function<int(const Ranks&)>& program);

}  // namespace vfplan
