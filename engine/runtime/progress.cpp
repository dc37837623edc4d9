#include "engine/runtime/progress.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <system_error>

#include "engine/runtime/stop.h"
#include "kernels/printable.h"

namespace vfplan {
namespace {

double seconds(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string span_text(double s) {
    if (s < 60) return fmt::format("{:.1f} s", s);
    return fmt::format("{}:{:02d} min", static_cast<int>(s) / 60, static_cast<int>(s) % 60);
}

// Resident memory now; 0 where the system does not tell (Linux does).
double resident_mb() {
    std::FILE* file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr) return 0;
    long whole = 0;
    long resident = 0;
    const int read = std::fscanf(file, "%ld %ld", &whole, &resident);
    std::fclose(file);
    if (read != 2) return 0;
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1U << 20U);
}

// Without a thread where none can be had: memory is then looked at less often.
template <class Body>
std::jthread started(Body&& body) {
    try {
        return std::jthread(std::forward<Body>(body));
    } catch (const std::system_error&) {
        return {};
    }
}

}  // namespace

Moment Moment::now() { return {seconds(CLOCK_MONOTONIC), seconds(CLOCK_PROCESS_CPUTIME_ID)}; }

Progress::Progress(bool quiet, bool follower)
    : quiet_(quiet || follower),
      terminal_(isatty(STDERR_FILENO) != 0),
      begin_(Moment::now()),
      stage_begin_(begin_),
      watcher_(started([this](const std::stop_token& stop) { watch_memory(stop); })) {}

Progress::~Progress() {
    watcher_.request_stop();
    if (watcher_.joinable()) watcher_.join();
}

void Progress::watch_memory(const std::stop_token& stop) {
    using namespace std::chrono_literals;
    std::unique_lock lock(watching_);
    while (!end_of_watch_.wait_for(lock, stop, 20ms, [&] { return stop.stop_requested(); })) {
        stage_peak_mb_ = std::max(stage_peak_mb_.load(), resident_mb());
    }
}

void Progress::stage(const std::string& name, std::int64_t total) {
    stop_if_asked();
    finish();
    name_ = name;
    total_ = total;
    done_ = 0;
    stage_begin_ = Moment::now();
    shown_at_s_ = stage_begin_.wall_s;
    shown_percent_ = 0;
}

void Progress::advance(std::int64_t steps) { tell(done_ += steps); }

void Progress::reach(std::int64_t steps) {
    std::int64_t done = done_;
    while (done < steps && !done_.compare_exchange_weak(done, steps)) {
    }
    tell(std::max(done, steps));
}

void Progress::tell(std::int64_t done) {
    if (quiet_ || total_ == 0) return;
    const std::unique_lock lock(showing_, std::try_to_lock);
    if (lock.owns_lock()) show(std::min(done, total_), false);
}

// On a terminal ten times a second; in a log a line per 5 % of a stage that takes over two
// seconds, and at least one per 30 s.
void Progress::show(std::int64_t done, bool last) {
    const double now = Moment::now().wall_s;
    const double spent = now - stage_begin_.wall_s;
    const std::int64_t percent = 100 * done / total_;
    if (terminal_) {
        if (!last && now - shown_at_s_ < 0.1) return;
        constexpr int width = 30;
        const int filled = static_cast<int>(width * done / total_);
        const double left =
            done > 0 ? spent * static_cast<double>(total_ - done) / static_cast<double>(done) : 0;
        fmt::print(stderr, "\r{:<15} [{:=<{}}{:{}}] {:3d} %  {} left\033[K", name_, "", filled, "",
                   width - filled, percent, span_text(left));
        std::fflush(stderr);
    } else {
        if (last || spent < 2 || (percent < shown_percent_ + 5 && now - shown_at_s_ < 30)) return;
        const double left = spent * static_cast<double>(total_ - done) / static_cast<double>(done);
        fmt::print(stderr, "{}: {} %, {} left\n", name_, percent, span_text(left));
        shown_percent_ = percent;
    }
    shown_at_s_ = now;
}

void Progress::note(const std::string& text) {
    if (!quiet_) fmt::print(stderr, "{}{}\n", terminal_ ? "\r\033[K" : "", printable(text));
}

void Progress::warn(const std::string& text) {
    fmt::print(stderr, "{}warning: {}\n", terminal_ ? "\r\033[K" : "", printable(text));
}

void Progress::finish() {
    if (name_.empty()) return;
    const Moment now = Moment::now();
    times_.push_back({name_, now.wall_s - stage_begin_.wall_s, now.cpu_s - stage_begin_.cpu_s,
                      std::max(stage_peak_mb_.exchange(0), resident_mb())});
    if (!quiet_ && times_.back().wall_s >= 0.1) {
        note(fmt::format("{:<15} {}", name_, span_text(times_.back().wall_s)));
    }
    name_.clear();
}

double Progress::peak_rss_mb() const {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace vfplan
