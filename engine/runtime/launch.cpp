#include "engine/runtime/launch.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace vfplan {
namespace {

int number_in(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr || *text == '\0' ? otherwise : std::atoi(text);
}

}  // namespace

Launch launch() {
    Launch l;
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) {
        return {number_in("OMPI_COMM_WORLD_SIZE", 1), number_in("OMPI_COMM_WORLD_RANK", 0), true,
                std::max(1, number_in("OMPI_COMM_WORLD_LOCAL_SIZE", 1))};
    }
    if (std::getenv("PMI_SIZE") != nullptr) {
        return {number_in("PMI_SIZE", 1), number_in("PMI_RANK", 0), true,
                std::max(1, number_in("MPI_LOCALNRANKS", 1))};
    }
    // "2(x3)": two on each of three machines.
    l.here = std::max(1, number_in("SLURM_STEP_TASKS_PER_NODE", 1));
    l.common = std::getenv("PMIX_RANK") != nullptr;
    l.count = number_in("SLURM_STEP_NUM_TASKS", l.common ? Launch::unknown : 1);
    l.rank = number_in("SLURM_PROCID", number_in("PMIX_RANK", 0));
    return l;
}

// mpirun gives each of two processes one core unless it is told otherwise, and Slurm's number of
// processors for a process is not always what the process may use.
std::string binding_warning() {
    const int here = number_in("OMPI_COMM_WORLD_LOCAL_SIZE", 0);
    if (here == 0) return "";
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return "";
    const int mine = CPU_COUNT(&set);
    const int node =
        number_in("SLURM_CPUS_ON_NODE", static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
    const int share = number_in("SLURM_CPUS_PER_TASK", node / here);
    if (mine >= share) return "";
    return fmt::format(
        "mpirun binds each of {} processes on this machine to {} of {} processors; start "
        "it with --bind-to none, or --map-by slot:PE={}",
        here, mine, node, share);
}

}  // namespace vfplan
