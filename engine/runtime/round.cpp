#include "engine/runtime/round.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "engine/runtime/exit_code.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/stop.h"

namespace vfplan {
namespace {

constexpr std::int64_t none = -1;
constexpr int stopped = static_cast<int>(Exit::stopped);

enum Kind : std::int64_t {
    ask,      // to the leader: one task, please
    halt,     // to the leader and from it: no new tasks, something has happened
    end,      // to the leader, last: a = exit code, b = the task to blame
    task,     // from the leader: a = the task, or none
    verdict,  // from the leader, last: a = exit code, b = the rank to blame
};

}  // namespace

Round::Round(Mpi* mpi, std::int64_t n) : mpi_(mpi), n_(n) {
    if (leads() && mpi != nullptr) running_ = mpi->count() - 1;
}

Verdict Round::run(const std::function<void()>& work) {
    Verdict verdict;
    std::thread talker;
    if (mpi_ != nullptr) talker = std::thread([&] { verdict = talk(); });
    try {
        work();
    } catch (...) {
        fail_at(End::before_all, std::current_exception());
    }
    lanes_ended();
    if (!talker.joinable()) return {end_.code, 0};
    talker.join();
    return verdict;
}

Verdict Round::conclude() {
    lanes_ended();
    return mpi_ == nullptr ? Verdict{end_.code, 0} : talk();
}

void Round::lane(const std::function<void(std::int64_t)>& work) {
    for (;;) {
        if (stop_asked()) return stop();
        const std::int64_t i = take();
        if (i == none) return;
        try {
            Threads::apart([&] { work(i); });
        } catch (...) {
            return fail_at(i, std::current_exception());
        }
    }
}

// A stop, too, if the exception is one.
void Round::fail_at(std::int64_t i, std::exception_ptr error) {
    const int code = error == nullptr ? stopped : ending_of(error).code;
    fail({code, code == stopped ? End::behind_all : i}, std::move(error));
}

void Round::fail(End how, std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    halted_ = true;
    if (how.before(end_)) {
        end_ = how;
        error_ = std::move(error);
    }
    for_talker_.notify_one();
}

void Round::lanes_ended() {
    const std::lock_guard lock(mutex_);
    lanes_ended_ = true;
    for_talker_.notify_one();
}

// Talks until the leader has told the verdict. To be called once, by one thread.
Verdict Round::talk() {
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

// The next task for a lane of this rank. A task that was handed out is always done, so that the
// tasks done are the first ones and the lowest that fails is the same in every run.
std::int64_t Round::take() {
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

std::int64_t Round::next() { return halted_ || next_ >= n_ ? none : next_++; }

void Round::stop_once() {
    {
        const std::lock_guard lock(mutex_);
        if (end_.code != 0 || end_told_) return;  // too late: the next round will see it
    }
    stop();
}

bool Round::has_to_tell() const {
    if (halted_ && !halt_told_) return true;
    if (leads()) return lanes_ended_ && running_ == 0;
    return wanted_ > 0 || (lanes_ended_ && !end_told_);
}

// One turn of talking; true if something happened.
bool Round::follow() {
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

bool Round::lead() {
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

void Round::tell_all(const Note& note) {
    for (int r = 1; r < mpi_->count(); ++r) mpi_->send(r, note);
}

void Round::blame(const End& how, int rank) {
    if (how.code == 0) return;
    // Equal ends: the leader first, then the lower rank, whoever came first.
    if (how.before(worst_) || (!worst_.before(how) && rank < verdict_.rank)) {
        worst_ = how;
        verdict_ = {how.code, rank};
    }
}

}  // namespace vfplan
