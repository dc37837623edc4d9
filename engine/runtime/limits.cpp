#include "engine/runtime/limits.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <latch>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "engine/runtime/exit_code.h"
#include "io/aside.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr char memory_text[] =
    "out of memory: less is left than the work needs; what is finished stays. Choose larger cells, "
    "smaller tiles (field.tile_cells), fewer --threads or a crop; --dry-run tells what a job needs";

// Only what may be done wherever memory gives out.
[[noreturn]] void end_for_want_of_memory() {
    constexpr char before[] = "vfplan: ";
    [[maybe_unused]] ssize_t written = write(STDERR_FILENO, before, sizeof before - 1);
    written = write(STDERR_FILENO, memory_text, sizeof memory_text - 1);
    written = write(STDERR_FILENO, "\n", 1);
    remove_asides();
    _exit(static_cast<int>(Exit::io));
}

[[noreturn]] void end_by_exception() noexcept {
    int code = 70;
    if (const std::exception_ptr error = std::current_exception()) {
        const Ending ending = ending_of(error);
        code = ending.code;
        tell(ending);
    }
    remove_asides();
    _exit(code);
}

// Pages that a stack has had it keeps.
__attribute__((noinline)) void touch_stack() {
    constexpr std::size_t bytes = std::size_t{2} << 20;
    constexpr std::size_t page = 4096;
    volatile char room[bytes];
    for (std::size_t i = 0; i < bytes; i += page) room[i] = static_cast<char>(room[i] | 1);
}

}  // namespace

std::string out_of_memory_text() { return memory_text; }

void meet_limits() {
    std::signal(SIGXFSZ, SIG_IGN);
    std::set_terminate(end_by_exception);
    rlimit memory{};
    if (getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY) touch_stack();
}

void check_threads(int count) {
    static std::atomic<int> known{1};
    if (count <= known) return;
    // TBB starts its threads when there is work, and does not look whether it can.
    std::latch go(1);
    std::vector<std::thread> trial;
    std::string why;
    try {
        for (int i = 1; i < count; ++i) trial.emplace_back([&] { go.wait(); });
    } catch (const std::system_error& e) {
        why = std::strerror(e.code().value());
    }
    go.count_down();
    for (std::thread& t : trial) t.join();
    if (!why.empty()) {
        throw IoError(
            fmt::format("{} threads: only {} could be started: {}; allow more (ulimit -u, ulimit "
                        "-v) or give a smaller --threads",
                        count, trial.size() + 1, why));
    }
    known = count;
}

}  // namespace vfplan

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__GLIBC__)

// In front of the C library's own. What is refused in large pieces is left to whoever asked: the
// size may come from a damaged file.
namespace {
constexpr std::size_t large = std::size_t{16} << 20;

void* given(void* memory, std::size_t bytes) {
    if (memory == nullptr && bytes != 0 && bytes < large) vfplan::end_for_want_of_memory();
    return memory;
}
}  // namespace

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);

void* malloc(std::size_t bytes) { return given(__libc_malloc(bytes), bytes); }
void* calloc(std::size_t count, std::size_t bytes) {
    std::size_t all = 0;
    const bool too_many = __builtin_mul_overflow(count, bytes, &all);
    return given(__libc_calloc(count, bytes), too_many ? large : all);
}
void* realloc(void* memory, std::size_t bytes) {
    return given(__libc_realloc(memory, bytes), bytes);
}
}

void* operator new(std::size_t bytes) {
    while (true) {
        if (void* memory = __libc_malloc(bytes == 0 ? 1 : bytes)) return memory;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

#endif
