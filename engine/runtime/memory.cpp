#include "engine/runtime/memory.h"

#include <sys/resource.h>
#include <sys/sysinfo.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace vfplan {
namespace {

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
    return limit;
}

}  // namespace vfplan
