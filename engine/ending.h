// How a program ends: its exit code, and what it prints for an exception.
#pragma once

#include <exception>
#include <functional>
#include <string>

namespace vfplan {

class Ranks;

struct Ending {
    int code = 0;
    std::string message;  // without "vfplan: "; empty: another rank prints it
};

Ending ending_of(const std::exception_ptr& error);

// Runs a program on all ranks and gives its exit code. What an exception says is printed once.
int run_to_end(const std::function<int(const Ranks&)>& program);

}  // namespace vfplan
