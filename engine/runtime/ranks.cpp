#include "engine/runtime/ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "engine/runtime/launch.h"
#include "engine/runtime/mpi.h"
#include "engine/runtime/round.h"
#include "engine/runtime/stop.h"

namespace vfplan {

constexpr int stopped = static_cast<int>(Exit::stopped);

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
    if (const int found = impl_->mpi->count(); l.count != Launch::unknown && found != l.count) {
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
                  const std::function<void(std::int64_t)>& work, int at_once) const {
    Round round(impl_->mpi.get(), n);
    const Verdict verdict = round.run([&] {
        const int most = at_once > 0 ? std::min(at_once, threads.count()) : threads.count();
        const std::int64_t lanes = std::min<std::int64_t>(most, n);
        threads.for_each(lanes, 1, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t lane = from; lane < to; ++lane) round.lane(work);
        });
    });
    impl_->finish(round, verdict);
}

void Ranks::lead(const std::function<void()>& work) const {
    Round round(impl_->mpi.get(), 0);
    const Verdict verdict = round.run([&] {
        if (leader()) work();
    });
    impl_->finish(round, verdict);
}

void Ranks::wait() const {
    if (!impl_->mpi) return;
    Round round(impl_->mpi.get(), 0);
    impl_->finish(round, round.conclude());
}

bool Ranks::fail(int exit_code) const noexcept {
    if (!impl_->mpi || impl_->over) return true;
    Round round(impl_->mpi.get(), 0);
    if (exit_code != 0) {
        round.fail({exit_code, exit_code == stopped ? End::behind_all : End::before_all});
    }
    const Verdict verdict = round.conclude();
    impl_->over = true;
    return verdict.rank == rank();
}

}  // namespace vfplan
