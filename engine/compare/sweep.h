// A job planned with several values of parameters (docs/planning.md, "Plans side by side").
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/compare/compare.h"
#include "engine/runtime/ranks.h"

namespace vfplan {

struct SweepRun {
    std::string name;  // of its folder: key=value, with commas where there are several
    std::vector<std::string> swept;  // key=value of the parameters with several values
    std::vector<std::string> all;    // and of the others
};

// Every combination of the values in `sets`, each "key=value" or "key=value,value,...", the last
// key changing fastest. Commas within brackets, braces and quotes part no values. UsageError where
// there is no key with several values, a value is empty, or there are more than 1,000 combinations.
std::vector<SweepRun> sweep_runs(const std::vector<std::string>& sets);

// Plans them one after another, each in a folder of its own within `out`, and leaves sweep.csv and
// sweep.png there. Where only parameters of the plan change, tables are made once. Started again it
// goes on where it stopped. By all ranks together; gives the comparison, on the leader.
Comparison sweep(const std::filesystem::path& job, const std::vector<std::string>& sets,
                 const std::filesystem::path& out, int threads, const Ranks& ranks, bool quiet);

}  // namespace vfplan
