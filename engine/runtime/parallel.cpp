#include "engine/runtime/parallel.h"

#include <sched.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

#include "engine/runtime/limits.h"

namespace vfplan {
namespace {

// TBB is not built for the thread sanitizer, which is therefore told that what precedes a loop
// happens before its parts, and these before what follows the loop; and not to watch what TBB
// copies when it splits a loop and hands from thread to thread. Otherwise these do nothing.
char loop_begun;
char part_done;
#ifdef __SANITIZE_THREAD__
void release(char& mark) { __tsan_release(&mark); }
void acquire(char& mark) { __tsan_acquire(&mark); }
#define VFPLAN_UNWATCHED __attribute__((no_sanitize("thread")))
#else
void release(char&) {}
void acquire(char&) {}
#define VFPLAN_UNWATCHED
#endif

struct PartEnds {
    ~PartEnds() { release(part_done); }
};
struct LoopEnds {
    ~LoopEnds() { acquire(part_done); }
};

class Part {
public:
    using Body = std::function<void(std::int64_t, std::int64_t)>;

    Part(const Body& body, const std::function<void()>& may_go_on)
        : body_(&body), may_go_on_(&may_go_on) {}
    VFPLAN_UNWATCHED Part(const Part& other) : body_(other.body_), may_go_on_(other.may_go_on_) {}
    Part& operator=(const Part&) = delete;

    void operator()(const tbb::blocked_range<std::int64_t>& r) const {
        acquire(loop_begun);
        const PartEnds when_left;  // by an exception too
        if (may_go_on()) may_go_on()();
        body()(r.begin(), r.end());
    }

private:
    VFPLAN_UNWATCHED const Body& body() const { return *body_; }
    VFPLAN_UNWATCHED const std::function<void()>& may_go_on() const { return *may_go_on_; }
    const Body* body_;
    const std::function<void()>* may_go_on_;
};

int slurm_threads() {
    const char* text = std::getenv("SLURM_CPUS_PER_TASK");
    return text == nullptr ? 0 : std::atoi(text);
}

int affinity_threads() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    return std::max(1, CPU_COUNT(&set));
}

// Processors' worth of time that control group v2 grants; 0 for no limit.
int quota_threads() {
    std::ifstream in("/sys/fs/cgroup/cpu.max");
    std::string quota;
    double period = 0;
    if (!(in >> quota >> period) || quota == "max" || period <= 0) return 0;
    return std::max(1, static_cast<int>(std::ceil(std::stod(quota) / period)));
}

int default_threads() {
    const int affine = affinity_threads();
    if (const int n = slurm_threads(); n > 0) return std::min(n, affine);
    const int quota = quota_threads();
    return quota > 0 ? std::min(affine, quota) : affine;
}

}  // namespace

struct Threads::Impl {
    explicit Impl(int count)
        : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)),
          arena(count) {}
    tbb::global_control limit;
    mutable tbb::task_arena arena;
};

Threads::Threads(int count, std::function<void()> may_go_on)
    : may_go_on_(std::move(may_go_on)), count_(count > 0 ? count : default_threads()) {
    check_threads(count_);
    impl_ = std::make_unique<Impl>(count_);
}

Threads::~Threads() = default;

void Threads::for_each(std::int64_t n, std::int64_t grain,
                       const std::function<void(std::int64_t, std::int64_t)>& body) const {
    const Part part(body, may_go_on_);
    release(loop_begun);
    const LoopEnds when_left;
    impl_->arena.execute([&] {
        tbb::this_task_arena::isolate([&] {
            const tbb::blocked_range<std::int64_t> all(0, n, static_cast<std::size_t>(grain));
            if (may_go_on_) {
                tbb::parallel_for(all, part, tbb::simple_partitioner());
            } else {
                tbb::parallel_for(all, part);
            }
        });
    });
}

void Threads::run(const std::function<void()>& body) const { impl_->arena.execute(body); }

void Threads::apart(const std::function<void()>& body) { tbb::this_task_arena::isolate(body); }

}  // namespace vfplan
