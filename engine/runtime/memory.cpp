#include "engine/runtime/memory.h"

#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>

#include "engine/runtime/launch.h"

namespace vfplan {
namespace {

std::atomic<double> given_bytes{0};  // by limit_memory()

void lower(MemoryLimit& limit, double bytes, const char* whose) {
    if (bytes > 0 && bytes < limit.bytes) limit = {bytes, whose};
}

// The number in a file; 0 where there is none, or a word such as "max".
double number_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    double number = 0;
    return in >> number ? number : 0;
}

// Limits of a control group and those around it, up to where they are mounted.
void lower_by_groups(MemoryLimit& limit, const std::filesystem::path& root,
                     const std::filesystem::path& group, const char* name) {
    std::filesystem::path below = group.relative_path();
    while (true) {
        lower(limit, number_in(root / below / name), "the control group grants");
        if (below.empty()) return;
        below = below.parent_path();
    }
}

}  // namespace

MemoryLimit memory_limit() {
    MemoryLimit limit{1e18, ""};
    struct sysinfo info {};
    if (sysinfo(&info) == 0) {
        lower(limit,
              (static_cast<double>(info.totalram) + static_cast<double>(info.totalswap)) *
                  info.mem_unit,
              "this machine has");
    }
    // Version 2 says "0::/path", version 1 "7:memory:/path".
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const auto path = line.find(":/");
        if (path == std::string::npos) continue;
        const std::string group = line.substr(path + 1);
        if (line.starts_with("0::")) {
            lower_by_groups(limit, "/sys/fs/cgroup", group, "memory.max");
        } else if (line.substr(0, path).find("memory") != std::string::npos) {
            lower_by_groups(limit, "/sys/fs/cgroup/memory", group, "memory.limit_in_bytes");
        }
    }
    for (const auto& [which, whose] :
         {std::pair(RLIMIT_AS, "ulimit -v grants"), std::pair(RLIMIT_DATA, "ulimit -d grants")}) {
        rlimit r{};
        if (getrlimit(which, &r) == 0 && r.rlim_cur != RLIM_INFINITY) {
            lower(limit, static_cast<double>(r.rlim_cur), whose);
        }
    }
    lower(limit, given_bytes, "--memory grants");
    return limit;
}

void limit_memory(double bytes, int threads) {
    given_bytes = bytes;
    rlimit stack{};
    constexpr rlim_t usual = rlim_t{8} << 20;
    if (getrlimit(RLIMIT_STACK, &stack) != 0 || stack.rlim_cur == RLIM_INFINITY) {
        stack.rlim_cur = usual;
    }
    rlimit data{};
    if (getrlimit(RLIMIT_DATA, &data) != 0) return;
    const auto wanted = static_cast<rlim_t>(bytes) + stack.rlim_cur * static_cast<rlim_t>(threads);
    data.rlim_cur = std::min(data.rlim_cur, wanted);
    setrlimit(RLIMIT_DATA, &data);
}

double memory_left() {
    const MemoryLimit limit = memory_limit();
    // --memory is each process's own.
    const int sharing = given_bytes > 0 ? 1 : launch().here;
    std::ifstream in("/proc/self/statm");
    double pages = 0;
    double resident = 0;
    in >> pages >> resident;
    const auto page = static_cast<double>(sysconf(_SC_PAGESIZE));
    return std::max(0.0, limit.bytes / sharing - resident * page);
}

int tasks_at_once(double task_bytes, int threads) {
    if (task_bytes <= 0) return threads;
    return static_cast<int>(std::clamp(memory_left() / task_bytes, 1.0, 1.0 * threads));
}

}  // namespace vfplan
