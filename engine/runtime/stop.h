// Polite ends: SIGTERM, SIGINT, SIGHUP and SIGUSR1 are noted, and the work stops where it can be
// taken up again; where that takes longer than some seconds, the program ends all the same, without
// the task at hand. Either way with exit code 75.
#pragma once

#include "kernels/error.h"

namespace vfplan {

// Thrown where work stops; the program ends with exit code 75.
struct Stopped : Error {
    explicit Stopped(const std::string& m) : Error(Exit::stopped, m) {}
};

// Seconds from a signal to the end at the latest.
inline constexpr unsigned grace_s = 6;

// From now on the signals set a mark. A second SIGTERM, SIGINT or SIGHUP ends the program at once;
// SIGUSR1 does not: mpirun forwards it as it comes, where it makes a kill of SIGTERM, and a batch
// script can send it beside the SIGTERM that Slurm sends. A signal that was ignored before (nohup)
// stays so. What is in the making when the program ends at once is removed.
void watch_signals();

// True when a signal has come. Thread-safe.
bool stop_asked();

// Throws Stopped when a signal has come. Thread-safe.
void stop_if_asked();

// While it lives, a signal ends the program at once, with the same exit code: for work that leaves
// nothing behind and asks nobody whether to go on. Throws Stopped when a signal has come already.
class SignalsEnd {
public:
    SignalsEnd();
    ~SignalsEnd();
    SignalsEnd(const SignalsEnd&) = delete;
    SignalsEnd& operator=(const SignalsEnd&) = delete;
};

}  // namespace vfplan
