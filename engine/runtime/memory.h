// How much memory there is.
#pragma once

#include <string>

namespace vfplan {

struct MemoryLimit {
    double bytes = 0;
    std::string whose;  // "this machine has", "the control group grants", "ulimit -v grants"
};

// What this process can have at most: the machine's memory and swap space, less where its control
// group or its own limits grant less.
MemoryLimit memory_limit();

}  // namespace vfplan
