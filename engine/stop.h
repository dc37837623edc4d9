// Polite ends: SIGTERM and SIGINT are noted, and the work stops where it can be taken up again.
#pragma once

#include "kernels/error.h"

namespace vfplan {

// Thrown where work stops; the program ends with exit code 75.
struct Stopped : Error {
    explicit Stopped(const std::string& m) : Error(Exit::stopped, m) {}
};

// From now on the two signals set a mark; a second one of them ends the program at once.
void watch_signals();

// Throws Stopped when a signal has come. Thread-safe.
void stop_if_asked();

}  // namespace vfplan
