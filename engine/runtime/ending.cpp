#include "engine/runtime/ending.h"

#include <fmt/format.h>

#include <cstdio>

#include "engine/runtime/exit_code.h"
#include "engine/runtime/ranks.h"
#include "kernels/printable.h"

namespace vfplan {

namespace {

// Where standard error cannot be written, nobody can be told.
void tell_person(const std::string& message) {
    const std::string line = fmt::format("vfplan: {}\n", printable(message));
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

int run_to_end(const std::function<int(const Ranks&)>& program) {
    const auto tell = [](const Ending& ending) {
        if (!ending.message.empty()) tell_person(ending.message);
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
