// A job for Slurm: the batch script, and handing it over.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vfplan {

struct SubmitOptions {
    std::filesystem::path job;
    std::filesystem::path out;
    std::vector<std::string> sets;  // checked key=value overrides
    std::filesystem::path program;  // this one
    std::filesystem::path folder;   // where relative paths in `sets` begin
    int nodes = 1;
    int ranks_per_node = 0;  // 0: one per socket
    int threads = 0;         // per rank; 0: all of the node, which is then taken whole
    std::string time;        // the rest as Slurm understands it; empty: not said
    std::string account;
    std::string partition;
};

// What Slurm says of the nodes of a partition: the least of each over them.
struct NodeShape {
    int sockets = 1;
    int processors = 1;
};

// From the lines of `sinfo -h -N -o "%P %X %c"`; nothing where there is none of the partition
// (empty: the one that Slurm marks as its default).
std::optional<NodeShape> node_shape(const std::string& sinfo_lines, const std::string& partition);

// The batch script. Paths become absolute. `mpi`: whether the program was built with it.
// Throws UsageError for several ranks without MPI and for text that no script can hold.
std::string batch_script(const SubmitOptions& options, const std::optional<NodeShape>& shape,
                         bool mpi);

// Checks the job as run would, asks Slurm for the shape of its nodes and submits. Returns what a
// person wants to read; with `print`, the script, and nothing is submitted. Throws UsageError, and
// IoError where sbatch is missing or refuses.
std::string submit(const SubmitOptions& options, bool print);

}  // namespace vfplan
