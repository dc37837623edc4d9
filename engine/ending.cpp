#include "engine/ending.h"

#include <fmt/format.h>

#include <cstdio>
#include <new>

#include "engine/ranks.h"
#include "kernels/error.h"

namespace vfplan {

Ending ending_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const Error& e) {
        return {static_cast<int>(e.code()), e.what()};
    } catch (const std::bad_alloc&) {
        return {static_cast<int>(Exit::io),
                "out of memory; choose larger cells or a crop, --dry-run tells what a job needs"};
    } catch (const std::exception& e) {
        return {70, fmt::format("{}; this is a bug, please report it with the job file", e.what())};
    } catch (...) {
        return {70, "unknown exception; this is a bug, please report it with the job file"};
    }
}

int run_to_end(const std::function<int(const Ranks&)>& program) {
    const auto tell = [](const Ending& ending) {
        if (!ending.message.empty()) fmt::print(stderr, "vfplan: {}\n", ending.message);
        return ending.code;
    };
    try {
        const Ranks ranks;
        try {
            const int code = program(ranks);
            ranks.wait();
            return code;
        } catch (...) {
            const Ending ending = ending_of(std::current_exception());
            return ranks.fail(ending.code) ? tell(ending) : ending.code;
        }
    } catch (...) {
        return tell(ending_of(std::current_exception()));
    }
}

}  // namespace vfplan
