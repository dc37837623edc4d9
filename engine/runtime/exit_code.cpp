#include "engine/runtime/exit_code.h"

#include <fmt/format.h>

#include <new>

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

}  // namespace vfplan
