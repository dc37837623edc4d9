// What tests/e2e/ranks_test.cpp starts under mpirun and srun: `ranks_main CASE`. Each task and each
// end leaves a line on standard output.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/runtime/ending.h"
#include "engine/runtime/ranks.h"
#include "engine/runtime/stop.h"
#include "kernels/error.h"

namespace {

using vfplan::InputError;

// A line in one write, so that lines of several threads and ranks do not mix: to the file that
// VFPLAN_RANKS_LINES names, because mpirun, which gathers standard output, mixes lines of ranks.
void line(const std::string& text) {
    static const int out = [] {
        const char* file = std::getenv("VFPLAN_RANKS_LINES");
        return file == nullptr ? STDOUT_FILENO : open(file, O_WRONLY | O_CREAT | O_APPEND, 0600);
    }();
    const std::string whole = text + "\n";
    if (write(out, whole.data(), whole.size()) < 0) std::abort();
}

// Returns when all ranks have called it with the same folder.
void meet(const vfplan::Ranks& ranks, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / std::to_string(ranks.rank())).put('x');
    for (int r = 0; r < ranks.count(); ++r) {
        while (!std::filesystem::exists(folder / std::to_string(r))) usleep(1000);
    }
}

// A task with a loop of its own, as the real ones have.
void work(const vfplan::Threads& threads) {
    std::atomic<int> parts = 0;
    threads.for_each(
        64, 1, [&](std::int64_t from, std::int64_t to) { parts += static_cast<int>(to - from); });
    if (parts != 64) throw InputError("parts got lost");
}

int program(const vfplan::Ranks& ranks, const std::string& what, const std::string& folder) {
    const vfplan::Threads threads(2);
    const auto task = [&](std::int64_t i) {
        work(threads);
        line(fmt::format("task {} rank {}", i, ranks.rank()));
    };
    if (what == "once") {
        // Every rank gets one of the first tasks, or they would never meet.
        const vfplan::Threads one(1);
        ranks.share(one, ranks.count(), [&](std::int64_t i) {
            meet(ranks, folder);
            task(i);
        });
        for (int round = 1; round < 20; ++round) {
            ranks.share(threads, 50, [&](std::int64_t i) { task(1000 * round + i); });
            if (round % 3 == 0) ranks.wait();
            ranks.lead([&] { task(1000 * round + 50); });
        }
        ranks.share(threads, 0, task);
        ranks.share(threads, 1, [&](std::int64_t) { task(20000); });
    } else if (what == "error") {
        ranks.share(threads, 1000, [&](std::int64_t i) {
            task(i);
            if (i % 10 == 7) throw InputError(fmt::format("task {} is bad", i));
        });
    } else if (what == "lead_error") {
        ranks.lead([] { throw vfplan::IoError("the leader cannot write"); });
    } else if (what == "outside_error") {
        if (ranks.rank() == ranks.count() - 1) throw InputError("the last rank cannot go on");
        ranks.share(threads, 1000000, [&](std::int64_t) { work(threads); });
    } else if (what == "all_errors") {
        throw InputError("no rank can go on");
    } else if (what == "bug") {
        ranks.share(threads, 10, [&](std::int64_t) { throw std::logic_error("a slip"); });
    } else if (what == "stop") {
        meet(ranks, folder);
        const int who = ranks.count() - 1;
        ranks.share(threads, 1000000, [&](std::int64_t i) {
            task(i);
            if (ranks.rank() == who && i > 5) std::raise(SIGUSR1);
        });
    } else if (what == "forever") {  // until a signal from outside
        line(fmt::format("pid {} rank {}", getpid(), ranks.rank()));
        ranks.share(threads, std::int64_t{1} << 40, [&](std::int64_t) {
            work(threads);
            usleep(1000);
        });
    } else if (what == "die") {
        meet(ranks, folder);
        if (ranks.rank() == 1) std::raise(SIGKILL);
        ranks.share(threads, std::int64_t{1} << 40, [&](std::int64_t) { usleep(1000); });
    } else {
        throw vfplan::UsageError(what + ": no such case");
    }
    line(fmt::format("end rank {} of {}", ranks.rank(), ranks.count()));
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    vfplan::watch_signals();
    return vfplan::run_to_end([&](const vfplan::Ranks& ranks) {
        return program(ranks, argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : ".");
    });
}
