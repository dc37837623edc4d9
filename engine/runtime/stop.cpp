#include "engine/runtime/stop.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "io/aside.h"

namespace vfplan {
namespace {

std::atomic<int> signal_seen{0};
std::atomic<bool> ends_at_once{false};
std::atomic<bool> asked_before{false};  // by another signal than SIGUSR1
static_assert(std::atomic<bool>::is_always_lock_free);

// Only what a signal handler may call.
[[noreturn]] void end_at_once() {
    constexpr char text[] =
        "vfplan: stopped by a signal; nothing half-written is left, run the same command again\n";
    remove_asides();
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    _exit(static_cast<int>(Exit::stopped));
}

void note_signal(int number) {
    if (ends_at_once || number == SIGALRM) end_at_once();
    if (number != SIGUSR1 && asked_before.exchange(true)) end_at_once();
    if (signal_seen == 0) alarm(grace_s);
    signal_seen = number;
}

}  // namespace

void watch_signals() {
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGALRM}) {
        struct sigaction now {};
        if (sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;
        struct sigaction mine {};
        mine.sa_handler = note_signal;
        mine.sa_flags = SA_RESTART;
        sigaction(number, &mine, nullptr);
    }
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
