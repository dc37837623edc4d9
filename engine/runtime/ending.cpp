#include "engine/runtime/ending.h"

#include "engine/runtime/exit_code.h"
#include "engine/runtime/ranks.h"

namespace vfplan {

int run_to_end(const std::function<int(const Ranks&)>& program) {
    const auto told = [](const Ending& ending) {
        tell(ending);
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
            return ranks.fail(ending.code) ? told(ending) : ending.code;
        }
    } catch (...) {
        return told(ending_of(std::current_exception()));
    }
}

}  // namespace vfplan
