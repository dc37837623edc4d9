// What a launcher (mpirun, srun) says of the processes that it started.
#pragma once

#include <string>

namespace vfplan {

struct Launch {
    static constexpr int unknown = 0;
    int count = 1;  // or unknown
    int rank = 0;
    bool common = false;  // the processes were told how to find each other
    int here = 1;         // of them on this machine, as far as the launcher says
};

// From the environment. Slurm's variables count inside srun only, which sets SLURM_STEP_NUM_TASKS;
// batch scripts have the job's numbers too.
Launch launch();

// What to tell a person who gave the ranks of this machine fewer processors than it has; empty if
// all is well.
std::string binding_warning();

}  // namespace vfplan
