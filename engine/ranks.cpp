#include "engine/ranks.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "engine/ending.h"
#include "engine/mpi.h"
#include "engine/stop.h"

namespace vfplan {
namespace {

constexpr std::int64_t none = -1;
// The task under which an end is reported that no task is to blame for: a failure outside the
// tasks comes before all of them, a stop behind.
constexpr std::int64_t before_all = -1;
constexpr std::int64_t behind_all = std::numeric_limits<std::int64_t>::max();
constexpr int stopped = static_cast<int>(Exit::stopped);

int number_in(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr || *text == '\0' ? otherwise : std::atoi(text);
}

constexpr int unknown = 0;

// What the launcher says in the environment. Slurm's variables count inside srun only, which sets
// SLURM_STEP_NUM_TASKS; batch scripts have the job's numbers too.
struct Launch {
    int count = 1;  // or unknown
    int rank = 0;
    bool common = false;  // the processes were told how to find each other
};

Launch launch() {
    Launch l;
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) {
        return {number_in("OMPI_COMM_WORLD_SIZE", 1), number_in("OMPI_COMM_WORLD_RANK", 0), true};
    }
    if (std::getenv("PMI_SIZE") != nullptr) {
        return {number_in("PMI_SIZE", 1), number_in("PMI_RANK", 0), true};
    }
    l.common = std::getenv("PMIX_RANK") != nullptr;
    l.count = number_in("SLURM_STEP_NUM_TASKS", l.common ? unknown : 1);
    l.rank = number_in("SLURM_PROCID", number_in("PMIX_RANK", 0));
    return l;
}

enum Kind : std::int64_t {
    ask,      // to the leader: one task, please
    halt,     // to the leader and from it: no new tasks, something has happened
    end,      // to the leader, last: a = exit code, b = the task to blame
    task,     // from the leader: a = the task, or none
    verdict,  // from the leader, last: a = exit code, b = the rank to blame
};

// How one rank ended.
struct End {
    int code = 0;
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

// One call of share() and its like on one rank. Lanes are the threads that work; beside them, where
// there are other ranks, one thread talks to these: it alone touches MPI while it runs.
class Round {
public:
    // `mpi`: null for one rank.
    Round(Mpi* mpi, std::int64_t n) : mpi_(mpi), n_(n) {
        if (leads() && mpi != nullptr) running_ = mpi->count() - 1;
    }

    // Works until nothing is left. Thread-safe.
    void lane(const std::function<void(std::int64_t)>& work) {
        for (;;) {
            if (stop_asked()) return stop();
            const std::int64_t i = take();
            if (i == none) return;
            try {
                Threads::apart([&] { work(i); });
            } catch (...) {
                return fail(i, std::current_exception());
            }
        }
    }

    void stop() { fail(behind_all, nullptr); }

    // A stop, too, if the exception is one. Thread-safe.
    void fail(std::int64_t i, std::exception_ptr error) {
        const int code = error == nullptr ? stopped : ending_of(error).code;
        fail({code, code == stopped ? behind_all : i}, std::move(error));
    }
    void fail(End how, std::exception_ptr error = nullptr) {
        const std::lock_guard lock(mutex_);
        halted_ = true;
        if (how.before(end_)) {
            end_ = how;
            error_ = std::move(error);
        }
        for_talker_.notify_one();
    }

    void lanes_ended() {
        const std::lock_guard lock(mutex_);
        lanes_ended_ = true;
        for_talker_.notify_one();
    }

    // Talks until the leader has told the verdict. To be called once, by one thread.
    Verdict talk() {
        using std::chrono::microseconds;
        constexpr microseconds shortest(20);
        constexpr microseconds longest(1000);
        if (leads()) verdict_ = {0, 0};
        microseconds pause = shortest;
        for (;;) {
            if (stop_asked()) stop_once();
            const bool moved = leads() ? lead() : follow();
            if (told_) return verdict_;
            pause = moved ? shortest : std::min(2 * pause, longest);
            std::unique_lock lock(mutex_);
            for_talker_.wait_for(lock, pause, [&] { return has_to_tell(); });
        }
    }

    // For one rank.
    Verdict alone() const { return {end_.code, 0}; }
    std::exception_ptr error() const { return error_; }

private:
    bool leads() const { return mpi_ == nullptr || mpi_->rank() == 0; }

    // The next task for a lane of this rank. A task that was handed out is always done, so that the
    // tasks done are the first ones and the lowest that fails is the same in every run.
    std::int64_t take() {
        std::unique_lock lock(mutex_);
        if (leads()) return next();
        if (halted_ || exhausted_) return none;
        ++wanted_;
        for_talker_.notify_one();
        for_lanes_.wait(lock, [&] { return !given_.empty(); });
        const std::int64_t i = given_.back();
        given_.pop_back();
        return i;
    }

    std::int64_t next() { return halted_ || next_ >= n_ ? none : next_++; }

    void stop_once() {
        {
            const std::lock_guard lock(mutex_);
            if (end_.code != 0 || end_told_) return;  // too late: the next round will see it
        }
        stop();
    }

    bool has_to_tell() const {
        if (halted_ && !halt_told_) return true;
        if (leads()) return lanes_ended_ && running_ == 0;
        return wanted_ > 0 || (lanes_ended_ && !end_told_);
    }

    // One turn of talking; true if something happened.
    bool follow() {
        std::int64_t wanted = 0;
        bool tell_halt = false;
        std::optional<End> tell_end;
        {
            const std::lock_guard lock(mutex_);
            std::swap(wanted, wanted_);
            tell_halt = halted_ && !halt_told_;
            halt_told_ = halted_;
            if (lanes_ended_ && !end_told_) tell_end = end_;
            end_told_ = lanes_ended_;
        }
        for (std::int64_t i = 0; i < wanted; ++i) mpi_->send(0, {ask});
        if (tell_halt) mpi_->send(0, {halt});
        if (tell_end) mpi_->send(0, {end, tell_end->code, tell_end->task});
        bool moved = wanted > 0 || tell_halt || tell_end;
        while (!told_) {
            const std::optional<Note> note = mpi_->receive();
            if (!note) break;
            moved = true;
            const std::lock_guard lock(mutex_);
            if (note->kind == task) {
                exhausted_ = exhausted_ || note->a == none;
                given_.push_back(note->a);
                for_lanes_.notify_one();
            } else if (note->kind == halt) {
                halted_ = true;
                halt_told_ = true;
            } else {
                verdict_ = {static_cast<int>(note->a), static_cast<int>(note->b)};
                told_ = true;
            }
        }
        return moved;
    }

    bool lead() {
        bool moved = false;
        while (const std::optional<Note> note = mpi_->receive()) {
            moved = true;
            std::unique_lock lock(mutex_);
            if (note->kind == ask) {
                const std::int64_t i = next();
                lock.unlock();
                mpi_->send(note->from, {task, i});
            } else if (note->kind == halt) {
                halted_ = true;
            } else {
                --running_;
                blame({static_cast<int>(note->a), note->b}, note->from);
            }
        }
        bool tell_halt = false;
        bool all_ended = false;
        {
            const std::lock_guard lock(mutex_);
            tell_halt = halted_ && !halt_told_;
            halt_told_ = halted_;
            all_ended = lanes_ended_ && running_ == 0;
            if (all_ended) blame(end_, 0);
        }
        if (tell_halt) tell_all({halt});
        if (all_ended) {
            tell_all({verdict, verdict_.code, verdict_.rank});
            told_ = true;
        }
        return moved || tell_halt || all_ended;
    }

    void tell_all(const Note& note) {
        for (int r = 1; r < mpi_->count(); ++r) mpi_->send(r, note);
    }

    void blame(const End& how, int rank) {
        if (how.code == 0) return;
        // Equal ends: the leader first, then the lower rank, whoever came first.
        if (how.before(worst_) || (!worst_.before(how) && rank < verdict_.rank)) {
            worst_ = how;
            verdict_ = {how.code, rank};
        }
    }

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

}  // namespace

struct Ranks::Impl {
    std::unique_ptr<Mpi> mpi;
    // The ranks agreed on an end: nothing is left to say to each other.
    mutable bool over = false;

    void finish(const Round& round, const Verdict& v) const {
        if (v.code == 0) return;
        over = true;
        const bool mine = v.rank == (mpi ? mpi->rank() : 0);
        if (mine && round.error()) std::rethrow_exception(round.error());
        if (mine) stop_if_asked();
        if (v.code == stopped) throw Stopped("");
        throw Error(static_cast<Exit>(v.code), "");
    }
};

Ranks::Ranks() : impl_(std::make_unique<Impl>()) {
    const Launch l = launch();
    if (l.count == 1) return;
    const auto refuse = [&](const std::string& why) {
        throw UsageError(l.rank > 0 ? ""
                                    : fmt::format("{} processes were started, {}", l.count, why));
    };
    if (!Mpi::built()) {
        refuse(
            "and this vfplan was built without MPI: each would do the whole job; start one, or "
            "build with -DVFPLAN_MPI=ON");
    }
    if (!l.common) {
        refuse(
            "and srun does not tell them how to find each other: each would do the whole job; "
            "use srun --mpi=pmix, or mpirun");
    }
    impl_->mpi = std::make_unique<Mpi>();
    if (const int found = impl_->mpi->count(); l.count != unknown && found != l.count) {
        refuse(
            fmt::format("but {} (which vfplan was built with) finds {}; use the mpirun that "
                        "belongs to it",
                        Mpi::name(), found));
    }
}

Ranks::Ranks(Alone) : impl_(std::make_unique<Impl>()) {}

Ranks::~Ranks() {
    // Without this, a rank that left early would make the others wait for ever.
    if (impl_->mpi && !impl_->over) fail(std::uncaught_exceptions() > 0 ? 70 : 0);
}

int Ranks::rank() const { return impl_->mpi ? impl_->mpi->rank() : 0; }
int Ranks::count() const { return impl_->mpi ? impl_->mpi->count() : 1; }
std::string Ranks::built_with() { return Mpi::name(); }

void Ranks::share(const Threads& threads, std::int64_t n,
                  const std::function<void(std::int64_t)>& work) const {
    Round round(impl_->mpi.get(), n);
    Verdict verdict;
    std::thread talker;
    if (impl_->mpi) talker = std::thread([&] { verdict = round.talk(); });
    try {
        const std::int64_t lanes = std::min<std::int64_t>(threads.count(), n);
        threads.for_each(lanes, 1, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t lane = from; lane < to; ++lane) round.lane(work);
        });
    } catch (...) {  // a lane could not even be started
        round.fail(before_all, std::current_exception());
    }
    round.lanes_ended();
    if (talker.joinable()) {
        talker.join();
    } else {
        verdict = round.alone();
    }
    impl_->finish(round, verdict);
}

void Ranks::lead(const std::function<void()>& work) const {
    Round round(impl_->mpi.get(), 0);
    Verdict verdict;
    std::thread talker;
    if (impl_->mpi) talker = std::thread([&] { verdict = round.talk(); });
    if (leader()) {
        try {
            work();
        } catch (...) {
            round.fail(before_all, std::current_exception());
        }
    }
    round.lanes_ended();
    if (talker.joinable()) {
        talker.join();
    } else {
        verdict = round.alone();
    }
    impl_->finish(round, verdict);
}

void Ranks::wait() const {
    if (!impl_->mpi) return;
    Round round(impl_->mpi.get(), 0);
    round.lanes_ended();
    impl_->finish(round, round.talk());
}

bool Ranks::fail(int exit_code) const noexcept {
    if (!impl_->mpi || impl_->over) return true;
    Round round(impl_->mpi.get(), 0);
    if (exit_code != 0) round.fail({exit_code, exit_code == stopped ? behind_all : before_all});
    round.lanes_ended();
    const Verdict verdict = round.talk();
    impl_->over = true;
    return verdict.rank == rank();
}

// mpirun gives each of two processes one core unless it is told otherwise, and Slurm's number of
// processors for a process is not always what the process may use.
std::string Ranks::binding_warning() const {
    const int here = number_in("OMPI_COMM_WORLD_LOCAL_SIZE", 0);
    if (here == 0) return "";
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return "";
    const int mine = CPU_COUNT(&set);
    const int node =
        number_in("SLURM_CPUS_ON_NODE", static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
    const int share = number_in("SLURM_CPUS_PER_TASK", node / here);
    if (mine >= share) return "";
    return fmt::format(
        "mpirun binds each of {} processes on this machine to {} of {} processors; start "
        "it with --bind-to none, or --map-by slot:PE={}",
        here, mine, node, share);
}

}  // namespace vfplan
