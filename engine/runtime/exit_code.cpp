#include "engine/runtime/exit_code.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "engine/runtime/limits.h"
#include "io/files.h"
#include "kernels/error.h"
#include "kernels/printable.h"

namespace vfplan {

Ending ending_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const Error& e) {
        return {static_cast<int>(e.code()), e.what()};
    } catch (const std::bad_alloc&) {
        return {static_cast<int>(Exit::io), out_of_memory_text()};
    } catch (const std::length_error&) {  // more than any memory
        return {static_cast<int>(Exit::io), out_of_memory_text()};
    } catch (const std::filesystem::filesystem_error& e) {
        return {static_cast<int>(Exit::io),
                fmt::format("{}: {}; {}", e.path1().string(), e.code().message(),
                            advice_on(e.code().value()))};
    } catch (const std::system_error& e) {
        if (e.code() == std::errc::resource_unavailable_try_again) {
            return {static_cast<int>(Exit::io),
                    "a thread could not be started: allow more (ulimit -u) or give a smaller "
                    "--threads"};
        }
        return {static_cast<int>(Exit::io),
                fmt::format("{}; {}", e.what(), advice_on(e.code().value()))};
    } catch (const std::exception& e) {
        return {70, fmt::format("{}; this is a bug, please report it with the job file", e.what())};
    } catch (...) {
        return {70, "unknown exception; this is a bug, please report it with the job file"};
    }
}

void tell(const Ending& ending) {
    if (ending.message.empty()) return;
    const std::string line = fmt::format("vfplan: {}\n", printable(ending.message));
    std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace vfplan
