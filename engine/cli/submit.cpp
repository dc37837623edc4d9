#include "engine/cli/submit.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "engine/config/parameters.h"
#include "engine/runtime/mpi.h"
#include "engine/runtime/shell_word.h"
#include "kernels/error.h"
#include "vfplan_version.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;

struct Said {
    int code = -1;
    std::string text;
};

// Runs a command line of the shell; its standard output, and its errors where they are wanted.
Said shell(const std::string& line) {
    std::FILE* pipe = popen(line.c_str(), "r");
    if (pipe == nullptr) return {};
    Said said;
    char part[4096];
    while (const std::size_t n = std::fread(part, 1, sizeof part, pipe)) said.text.append(part, n);
    const int status = pclose(pipe);
    said.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    while (!said.text.empty() && said.text.back() == '\n') said.text.pop_back();
    return said;
}

void check_text(const std::string& name, const std::string& text) {
    if (std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; })) return;
    throw UsageError(
        fmt::format("{} holds a control character such as a line's end, which a batch script "
                    "cannot; rename or leave it out",
                    name));
}

// Slurm replaces %j and the like in the names of logs.
std::string without_patterns(std::string path) {
    for (std::size_t at = 0; (at = path.find('%', at)) != std::string::npos; at += 2) {
        path.insert(at, 1, '%');
    }
    return path;
}

std::string log_file(const fs::path& out, const std::string& job_id) {
    return out.string() + ".slurm-" + job_id + ".log";
}

// What follows the options and `program`, `ranks`, `threads` in every script.
constexpr const char* script_body = R"script(
if ((ranks == 1)); then
    launch=()
elif srun --mpi=list 2>&1 | grep -q pmix; then
    # A rank that ends early has died: the others, which wait for it, are ended after --wait.
    # All ranks that stop politely end within a moment, and keep their exit code.
    launch=(srun --mpi=pmix --kill-on-bad-exit=0 --wait=15 --cpus-per-task="$threads")
    if scontrol show config | grep -qE '^TaskPlugin .*(affinity|cgroup)'; then
        launch+=(--cpu-bind=cores)
    fi
else
    launch=(mpirun --bind-to none --map-by "ppr:$SLURM_NTASKS_PER_NODE:node")
fi

# Slurm tells this script before the time is over or another job takes the nodes; srun and mpirun
# pass SIGUSR1 on, which makes the program stop where it can be taken up again.
asked=0
child=
ask() {
    asked=$((asked + 1))
    [[ -z $child ]] || kill -USR1 "$child" 2>/dev/null
}
trap ask TERM

say() { echo "$(date -Is) job $SLURM_JOB_ID: $*"; }
say "start $((${SLURM_RESTART_COUNT:-0} + 1)), $ranks x $threads threads on $SLURM_JOB_NODELIST"
"${launch[@]}" "${program[@]}" --threads "$threads" &
child=$!
((asked)) && kill -USR1 "$child"
code=127
while :; do
    heard=$asked
    wait "$child"
    ended=$?
    ((ended == 127)) || code=$ended
    ((asked == heard)) && break  # otherwise it was the signal that ended `wait`
done
say "ended with $code"

# 75: stopped, to be taken up again; 138: the same, before the program listened. A job that Slurm
# ends (scancel) or requeues by itself is not running any more and left alone.
if ((code == 75 || (asked && code == 138))); then
    code=75
    state=$(squeue -h -j "$SLURM_JOB_ID" -o %T)
    if [[ $state != RUNNING ]]; then
        say "stopped, not requeued: Slurm calls it ${state:-unknown}"
    elif ((${SLURM_RESTART_COUNT:-0} >= 100)); then
        say "stopped, not requeued a 101st time; submit it again, with more --time"
    else
        trap 'exit 75' TERM  # which Slurm sends next
        say "stopped, requeued"
        scontrol requeue "$SLURM_JOB_ID" && { sleep 60 & wait; }
    fi
elif ((code > 128)); then
    say "a process was killed by signal $((code - 128)), perhaps for want of memory; the same vfplan submit goes on from what is complete"
fi
exit "$code"
)script";

void check_job(const SubmitOptions& o) {
    const Config config = read_config(o.job, o.sets);
    existing_paths(config);
    std::error_code error;
    const fs::path parent = fs::absolute(o.out).parent_path();
    if (!fs::is_directory(parent, error)) {
        throw IoError(
            fmt::format("{}: no such folder, and the log is to stand in it; make it, or "
                        "choose another --out",
                        parent.string()));
    }
}

}  // namespace

std::optional<NodeShape> node_shape(const std::string& sinfo_lines, const std::string& partition) {
    std::optional<NodeShape> least;
    std::istringstream lines(sinfo_lines);
    std::string name;
    NodeShape node;
    while (lines >> name >> node.sockets >> node.processors) {
        const bool standard = name.back() == '*';
        if (standard) name.pop_back();
        if (partition.empty() ? !standard : name != partition) continue;
        if (!least) least = node;
        least->sockets = std::max(1, std::min(least->sockets, node.sockets));
        least->processors = std::max(1, std::min(least->processors, node.processors));
    }
    return least;
}

std::string batch_script(const SubmitOptions& o, const std::optional<NodeShape>& shape, bool mpi) {
    const int ranks_per_node = o.ranks_per_node > 0 ? o.ranks_per_node
                               : shape && mpi       ? shape->sockets
                                                    : 1;
    const int ranks = o.nodes * ranks_per_node;
    if (ranks > 1 && !mpi) {
        throw UsageError(
            fmt::format("{} ranks were asked for, and this vfplan was built without MPI; use one "
                        "node and one rank, or build it with -DVFPLAN_MPI=ON",
                        ranks));
    }
    const int threads = o.threads > 0 ? o.threads
                        : shape       ? std::max(1, shape->processors / ranks_per_node)
                                      : 0;
    const std::string out = fs::absolute(o.out).lexically_normal().string();
    const std::string job = fs::absolute(o.job).lexically_normal().string();
    check_text("the job file's path", job);
    check_text("--out", out);
    check_text("the current folder's path", o.folder.string());
    for (const std::string& s : o.sets) check_text("--set", s);
    check_text("--time, --account or --partition", o.time + o.account + o.partition);

    std::string text = "#!/bin/bash\n";
    const auto sbatch = [&](const char* option, const std::string& value = "") {
        text += fmt::format("#SBATCH --{}{}{}\n", option, value.empty() ? "" : "=", value);
    };
    sbatch("job-name", shell_word(fmt::format("vfplan-{}", o.job.stem().string())));
    sbatch("nodes", std::to_string(o.nodes));
    sbatch("ntasks-per-node", std::to_string(ranks_per_node));
    if (threads > 0) sbatch("cpus-per-task", std::to_string(threads));
    if (o.threads == 0) {  // whole nodes
        sbatch("exclusive");
        sbatch("mem", "0");
    }
    if (!o.time.empty()) sbatch("time", shell_word(o.time));
    if (!o.account.empty()) sbatch("account", shell_word(o.account));
    if (!o.partition.empty()) sbatch("partition", shell_word(o.partition));
    sbatch("chdir", shell_word(o.folder.string()));
    sbatch("output", shell_word(log_file(without_patterns(out), "%j")));
    sbatch("open-mode", "append");
    sbatch("requeue");
    sbatch("signal", "B:TERM@120");
    text += fmt::format("# Made by vfplan submit ({} {}).\n\n", version, version_git);
    text += fmt::format("program=({} run {} --out {}", shell_word(o.program.string()),
                        shell_word(job), shell_word(out));
    for (const std::string& s : o.sets) text += fmt::format(" --set {}", shell_word(s));
    text += fmt::format(
        ")\n"
        "ranks={}\n"
        "threads=\"${{SLURM_CPUS_PER_TASK:-$((SLURM_CPUS_ON_NODE / {}))}}\"\n",
        ranks, ranks_per_node);
    return text + script_body;
}

std::string submit(const SubmitOptions& o, bool print) {
    check_job(o);
    const Said nodes = shell("sinfo -h -N -o '%P %X %c' 2>/dev/null");
    const auto shape = node_shape(nodes.text, o.partition);
    const std::string script = batch_script(o, shape, Mpi::built());
    if (print) return script;

    std::string file = (fs::temp_directory_path() / "vfplan-submit-XXXXXX").string();
    const int handle = mkstemp(file.data());
    if (handle < 0) {
        throw IoError(
            fmt::format("{}: cannot be created; set TMPDIR to a folder for the script", file));
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(fdopen(handle, "w"), std::fclose);
    std::fwrite(script.data(), 1, script.size(), out.get());
    std::fflush(out.get());
    const Said said = shell(fmt::format("sbatch --parsable {} 2>&1", shell_word(file)));
    std::error_code ignored;
    fs::remove(file, ignored);
    if (said.code == 127) {
        throw IoError(
            "sbatch: not found, and it is what hands a job to Slurm; log in to a machine of the "
            "cluster that has it, or take the script with --print");
    }
    if (said.code != 0) {
        throw IoError(
            fmt::format("sbatch refused the job and says: {}; change what it names, or "
                        "take the script with --print and submit it by hand",
                        said.text));
    }
    // The last line is "job" or "job;cluster"; warnings may precede it.
    std::string id = said.text.substr(said.text.find_last_of('\n') + 1);
    id = id.substr(0, id.find(';'));
    const fs::path result = fs::absolute(o.out).lexically_normal();
    return fmt::format(
        "job          {}\n"
        "log          {}\n"
        "result       {}\n"
        "state        squeue -j {}; end it with scancel {}\n",
        id, log_file(result, id), result.string(), id, id);
}

}  // namespace vfplan
