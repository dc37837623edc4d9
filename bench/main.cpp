// What all suites share: VFPLAN_ISA, and the commit in the context of their results.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "kernels/isa.h"
#include "vfplan_version.h"

namespace {

// Work that no change of ours touches: times are compared between machines as multiples of it.
void calibration(benchmark::State& state) {
    std::vector<double> numbers(200000);
    for (auto _ : state) {
        std::uint64_t x = 88172645463325252;  // xorshift
        for (double& d : numbers) {
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            d = static_cast<double>(x >> 11);
        }
        std::sort(numbers.begin(), numbers.end());
        double sum = 0;
        for (const double d : numbers) sum += std::sqrt(d) / (1 + d);
        benchmark::DoNotOptimize(sum);
    }
}
BENCHMARK(calibration)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
    try {
        if (const char* isa = std::getenv("VFPLAN_ISA")) vfplan::limit_isa(isa);
        benchmark::AddCustomContext("vfplan", vfplan::version_git);
        benchmark::AddCustomContext("build", vfplan::build_type);
        benchmark::Initialize(&argc, argv);
        if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
        benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
    } catch (const std::exception& e) {
        std::fprintf(stderr, "bench: %s\n", e.what());
        return 1;
    }
    return 0;
}
