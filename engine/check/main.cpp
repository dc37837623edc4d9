// vfplan_check DIR: whether the plan of a run directory and the lower bound of its certificate are
// right. A program of its own, with nothing of the planner in it but how two rows overlap.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "engine/check/run_check.h"
#include "io/files.h"
#include "io/tables/certificate_text.h"
#include "kernels/error.h"

int main(int argc, char** argv) {
    using namespace vfplan;
    if (argc != 2) {
        fmt::print(stderr, "usage: vfplan_check DIR\n");
        return static_cast<int>(Exit::usage);
    }
    try {
        const std::filesystem::path dir = argv[1];
        const std::string name = (dir / "certificate.txt").string();
        if (!std::filesystem::exists(name)) {
            throw IoError(name + ": not there; plan again with certificate in output.formats");
        }
        const Certificate certificate = certificate_of(read_text(name), name);
        const PlanTable plan = read_plan(dir / "plan.h5");
        const auto [tables, entries] = read_candidates(dir, plan.pool);
        if (plan.key != tables.key) throw IoError("the plan was made from other tables");
        const RunCheck found = check_plan(tables, entries, plan, certificate);
        for (const std::string& line : found.wrong) fmt::print("NO   {}\n", line);
        if (!found.wrong.empty()) return 1;
        fmt::print(
            "yes  {} stations in {} networks cover what they have to; {} are needed over "
            "these {} candidates\n",
            found.stations, found.networks, found.bound, tables.candidates.size());
        return 0;
    } catch (const std::exception& e) {
        fmt::print(stderr, "vfplan_check: {}\n", e.what());
        return static_cast<int>(Exit::io);
    }
}
