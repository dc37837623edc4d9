#include "engine/runtime/stop.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace vfplan {
namespace {

std::atomic<int> signal_seen{0};
std::atomic<bool> ends_at_once{false};
static_assert(std::atomic<bool>::is_always_lock_free);

// Only what a signal handler may call.
[[noreturn]] void end_at_once() {
    constexpr char text[] = "vfplan: stopped by a signal; nothing half-written is left\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    _exit(static_cast<int>(Exit::stopped));
}

void note_signal(int number) {
    if (ends_at_once) end_at_once();
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

SignalsEnd::SignalsEnd() {
    ends_at_once = true;
    if (stop_asked()) ends_at_once = false;
    stop_if_asked();
}

SignalsEnd::~SignalsEnd() { ends_at_once = false; }

}  // namespace vfplan
