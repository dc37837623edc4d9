#include "engine/runtime/stop.h"

#include <atomic>
#include <csignal>

namespace vfplan {
namespace {

std::atomic<int> signal_seen{0};

void note_signal(int number) {
    signal_seen = number;
    if (number != SIGUSR1) std::signal(number, SIG_DFL);
}

}  // namespace

void watch_signals() {
    std::signal(SIGTERM, note_signal);
    std::signal(SIGINT, note_signal);
    std::signal(SIGUSR1, note_signal);
}

bool stop_asked() { return signal_seen != 0; }

void stop_if_asked() {
    if (!stop_asked()) return;
    throw Stopped("stopped by a signal; nothing half-written is left, run the same command again");
}

}  // namespace vfplan
