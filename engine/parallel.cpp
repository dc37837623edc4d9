#include "engine/parallel.h"

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

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace vfplan {
namespace {

// TBB is not built for the thread sanitizer: tell it that what precedes a loop happens before the
// loop's bodies, and these before what follows the loop, even when one throws. The marks are static
// because to read a captured variable is an access already.
#ifdef __SANITIZE_THREAD__
char loop_begins;
char loop_ends;
void mark_loop() { __tsan_release(&loop_begins); }
struct BodyMarks {
    BodyMarks() { __tsan_acquire(&loop_begins); }
    ~BodyMarks() { __tsan_release(&loop_ends); }
};
struct LoopEndMark {
    ~LoopEndMark() { __tsan_acquire(&loop_ends); }
};
#else
void mark_loop() {}
struct BodyMarks {};
struct LoopEndMark {};
#endif

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
    if (const int n = slurm_threads(); n > 0) return n;
    const int affine = affinity_threads();
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

Threads::Threads(int count) : count_(count > 0 ? count : default_threads()) {
    impl_ = std::make_unique<Impl>(count_);
}

Threads::~Threads() = default;

void Threads::for_each(std::int64_t n, std::int64_t grain,
                       const std::function<void(std::int64_t, std::int64_t)>& body) const {
    const auto part = [&body](const tbb::blocked_range<std::int64_t>& r) {
        [[maybe_unused]] const BodyMarks marks;
        body(r.begin(), r.end());
    };
    mark_loop();
    [[maybe_unused]] const LoopEndMark end;
    impl_->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, n, static_cast<std::size_t>(grain)),
                          part);
    });
}

void Threads::run(const std::function<void()>& body) const { impl_->arena.execute(body); }

}  // namespace vfplan
