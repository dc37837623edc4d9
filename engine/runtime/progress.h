// What is going on, for people: a bar on a terminal, lines in a log, and the time each stage took.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace vfplan {

// Wall and processor seconds of the process since its start or a moment of it.
struct Moment {
    double wall_s = 0;
    double cpu_s = 0;
    static Moment now();
};

struct StageTime {
    std::string name;
    double wall_s = 0;
    double cpu_s = 0;
    double peak_rss_mb = 0;  // highest resident memory in it, looked at every few milliseconds
};

// Standard error only. advance(), reach() and note() may be called from any thread, the rest from
// one. stage() throws Stopped when a signal asked for an end.
class Progress {
public:
    // `follower`: a rank that leaves the telling to the leader, but for its own warnings.
    explicit Progress(bool quiet, bool follower = false);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Ends the stage before it. `total` 0: a stage without steps.
    void stage(const std::string& name, std::int64_t total = 0);
    // How many steps the stage at hand has, where that is known only later; before the first one.
    void expect(std::int64_t total) { total_ = total; }
    void advance(std::int64_t steps);
    // So many steps are done at least: for steps taken in order, by others too.
    void reach(std::int64_t steps);
    void note(const std::string& text);  // a line of its own
    void warn(const std::string& text);  // the same with "warning:", also when quiet
    void finish();                       // ends the last stage
    const std::vector<StageTime>& times() const { return times_; }
    double peak_rss_mb() const;  // highest resident memory of the process so far
    double wall_s() const { return Moment::now().wall_s - begin_.wall_s; }

private:
    void tell(std::int64_t done);
    void show(std::int64_t done, bool last);

    bool quiet_;
    bool terminal_;
    Moment begin_;
    Moment stage_begin_;
    std::string name_;
    std::int64_t total_ = 0;
    std::atomic<std::int64_t> done_{0};
    std::mutex showing_;
    double shown_at_s_ = 0;
    std::int64_t shown_percent_ = -1;
    std::vector<StageTime> times_;

    void watch_memory(const std::stop_token& stop);
    std::atomic<double> stage_peak_mb_{0};
    std::mutex watching_;
    std::condition_variable_any end_of_watch_;
    std::jthread watcher_;
};

}  // namespace vfplan
