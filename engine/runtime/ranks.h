// The processes of one job: one, or those that mpirun or srun started. They share loops whose
// turns are long and independent; what the turns write, they write by index into files.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "engine/runtime/parallel.h"

namespace vfplan {

// share(), lead() and wait() are called by all ranks in the same order, from the thread that made
// the object. They return on all ranks or throw on all ranks:
//  (1) they return when the work is done everywhere;
//  (2) an exception of the work ends them everywhere, with the same exit code: on the rank where
//      it happened it is thrown again, on the others an Error with an empty message, because the
//      message has to be printed once only;
//  (3) of several exceptions, that of the lowest task wins, whatever the number of ranks and
//      threads;
//  (4) a signal to any rank (engine/stop.h) ends them everywhere with Stopped, when the tasks in
//      hand are finished; an exception wins over it.
class Ranks {
public:
    // Starts MPI only where mpirun or srun says that there is more than one process. Throws
    // UsageError where several processes were started and cannot know of each other.
    Ranks();
    // This process alone, whoever else was started with it: for work that is no part of the job.
    struct Alone {};
    explicit Ranks(Alone alone);
    ~Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    int rank() const;
    int count() const;
    bool leader() const { return rank() == 0; }

    // Calls work(task) once for each task of [0, n), over all ranks together, on each of them in
    // threads.count() threads at most, `at_once` of them at a time where that is above 0. Tasks are
    // handed out in ascending order to who asks first. Tasks may use `threads` for loops of their
    // own.
    void share(const Threads& threads, std::int64_t n,
               const std::function<void(std::int64_t task)>& work, int at_once = 0) const;

    // Calls work() on the leader; the others wait for it.
    void lead(const std::function<void()>& work) const;

    // Returns when all ranks are here.
    void wait() const;

    // This rank cannot go on, for a reason outside the functions above. Waits for the others to
    // come to one of them or to fail too. True if this rank is the one to tell people; also after
    // an end by (2) or (4), whose message is empty on all ranks but one. Never throws.
    bool fail(int exit_code) const noexcept;

    // "Open MPI 4.1.4", "without MPI".
    static std::string built_with();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vfplan
