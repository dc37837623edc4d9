// How much memory there is, and how much of it may be used.
#pragma once

#include <string>

namespace vfplan {

struct MemoryLimit {
    double bytes = 0;
    std::string whose;  // "this machine has", "the control group grants", "--memory grants"
};

// What this process can have at most: the machine's memory and swap space, less where its control
// group, its own limits or limit_memory() grant less.
MemoryLimit memory_limit();

// From now on the process takes no more than so much: memory_limit() says so, and what is asked for
// beyond (and beyond the stacks of so many threads) is refused, which ends it as limits.h has it.
void limit_memory(double bytes, int threads);

// What is left of the limit now, where the processes of the job on this machine share it evenly.
double memory_left();

// How many tasks that take so much memory each may be worked on at once: at least one, at most
// `threads`.
int tasks_at_once(double task_bytes, int threads);

}  // namespace vfplan
