// One call of Ranks::share() and its like on one rank: who does which task, and how it ends for
// all.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <vector>

#include "engine/runtime/mpi.h"

namespace vfplan {

// How one rank ended.
struct End {
    int code = 0;
    // The task to blame. A failure outside the tasks comes before all of them, a stop behind.
    static constexpr std::int64_t before_all = -1;
    static constexpr std::int64_t behind_all = std::numeric_limits<std::int64_t>::max();
    std::int64_t task = behind_all;
    bool before(const End& other) const {
        if ((code == 0) != (other.code == 0)) return code != 0;
        return task < other.task;
    }
};

struct Verdict {
    int code = 0;
    int rank = 0;
};

// Lanes are the threads that work; beside them, where there are other ranks, one thread talks to
// these: it alone touches MPI while it runs.
class Round {
public:
    // `mpi`: null for one rank. Tasks are 0..n-1.
    Round(Mpi* mpi, std::int64_t n);

    // Runs `work` on this rank, with a thread that talks beside it where there are other ranks,
    // until the leader has told how the round ended. What `work` throws is noted as a failure
    // outside the tasks. To be called once.
    Verdict run(const std::function<void()>& work);

    // The same where there is nothing to do, without a thread.
    Verdict conclude();

    // Works until nothing is left. Thread-safe.
    void lane(const std::function<void(std::int64_t)>& work);
    // Notes an end. Thread-safe.
    void fail(End how, std::exception_ptr error = nullptr);
    // Of the task to blame, on the rank where it happened; null for a stop.
    std::exception_ptr error() const { return error_; }

private:
    void fail_at(std::int64_t task, std::exception_ptr error);
    void stop() { fail_at(End::behind_all, nullptr); }
    void stop_once();
    void lanes_ended();
    Verdict talk();
    bool leads() const { return mpi_ == nullptr || mpi_->rank() == 0; }
    std::int64_t take();
    std::int64_t next();
    bool has_to_tell() const;
    bool follow();
    bool lead();
    void tell_all(const Note& note);
    void blame(const End& how, int rank);

    Mpi* const mpi_;
    const std::int64_t n_;
    mutable std::mutex mutex_;
    std::condition_variable for_talker_;
    std::condition_variable for_lanes_;
    // Guarded by the mutex.
    std::int64_t next_ = 0;            // leader: the first task that nobody has
    std::int64_t wanted_ = 0;          // others: tasks that lanes wait for, not yet asked for
    std::vector<std::int64_t> given_;  // others: answers not yet taken by a lane
    bool exhausted_ = false;
    bool halted_ = false;
    bool lanes_ended_ = false;
    bool halt_told_ = false;
    bool end_told_ = false;
    int running_ = 0;  // leader: ranks whose end has not come
    End end_;          // of this rank
    std::exception_ptr error_;
    // The talker's own.
    End worst_;
    Verdict verdict_;
    bool told_ = false;
};

}  // namespace vfplan
