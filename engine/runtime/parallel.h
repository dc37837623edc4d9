// The door to TBB: loops over indices, on as many threads as the job has.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace vfplan {

// A set of threads. Results must be written by index, so that their number changes nothing.
class Threads {
public:
    // 0: SLURM_CPUS_PER_TASK, at most the processors that this process may use; else these, capped
    // by the control group's quota (which TBB does not look at). Throws IoError when so many cannot
    // be started.
    explicit Threads(int count = 0) : Threads(count, {}) {}
    // `may_go_on` is called before every part of every loop, which are then no longer than the
    // grain, from any thread; what it throws ends the loop.
    Threads(int count, std::function<void()> may_go_on);
    ~Threads();
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    int count() const { return count_; }

    // Calls body(from, to) for disjoint parts of [0, n) of at least grain / 2 indices each (n, if
    // that is less). The first exception of a body is thrown again here.
    void for_each(std::int64_t n, std::int64_t grain,
                  const std::function<void(std::int64_t from, std::int64_t to)>& body) const;

    // Runs inside the threads' arena, for libraries that use TBB themselves.
    void run(const std::function<void()>& body) const;

    // Runs body so that its thread, while it waits in a loop of the body, takes up parts of that
    // loop only: not a part of the loop around, which may be long.
    static void apart(const std::function<void()>& body);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::function<void()> may_go_on_;
    int count_ = 1;
};

}  // namespace vfplan
