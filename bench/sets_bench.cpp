// Rows of the coverage table as sorted lists (what the search uses) or as sorted blocks of 64 bits,
// in what the search does with them. Each pair of benchmarks must give the same result.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <random>

#include "bench/scenes.h"
#include "engine/job/tables.h"
#include "io/tables/coverage_file.h"
#include "kernels/coverage.h"
#include "kernels/index.h"

namespace vfplan::bench {
namespace {

struct Block {
    std::int32_t word;  // pieces 64 * word ...
    std::uint64_t bits;
};

// A site's rows in both forms.
struct Sets {
    std::vector<std::int64_t> begin;
    std::vector<std::int32_t> piece;
    std::vector<std::int64_t> block_begin = {0};
    std::vector<Block> block;
    std::vector<double> length_m;  // of pieces
    std::vector<std::uint8_t> covered;
    std::vector<std::uint64_t> covered_bits;
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;  // rows that share a piece

    std::int32_t rows() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::span<const std::int32_t> list(std::int32_t r) const {
        return {piece.data() + begin[idx(r)], piece.data() + begin[idx(r) + 1]};
    }
    std::span<const Block> blocks(std::int32_t r) const {
        return {block.data() + block_begin[idx(r)], block.data() + block_begin[idx(r) + 1]};
    }

    Sets(const CoverageTables& t, const CoverageEntries& entries)
        : begin(t.begin),
          piece(entries.pieces(0, t.entries())),
          length_m(piece_lengths_m(t.pieces)),
          covered(length_m.size(), 0),
          covered_bits(length_m.size() / 64 + 1, 0) {
        std::mt19937_64 random(1);
        for (std::int32_t r = 0; r < rows(); ++r) {
            for (const std::int32_t p : list(r)) {
                const bool same = static_cast<std::int64_t>(block.size()) > block_begin.back() &&
                                  block.back().word == p / 64;
                if (!same) block.push_back({p / 64, 0});
                block.back().bits |= std::uint64_t{1} << (p % 64);
            }
            block_begin.push_back(static_cast<std::int64_t>(block.size()));
        }
        // As in the middle of a plan: a tenth of the stations of one.
        for (std::int32_t k = 0; k < rows() / 100 + 1; ++k) {
            for (const std::int32_t p : list(below(random, rows()))) {
                covered[idx(p)] = 1;
                covered_bits[idx(p / 64)] |= std::uint64_t{1} << (p % 64);
            }
        }
        std::vector<std::vector<std::int32_t>> viewers(length_m.size());
        for (std::int32_t r = 0; r < rows(); ++r) {
            for (const std::int32_t p : list(r)) viewers[idx(p)].push_back(r);
        }
        while (pairs.size() < 20000) {
            const std::int32_t a = below(random, rows());
            if (list(a).empty()) continue;
            const auto& with = viewers[idx(
                list(a)[idx(below(random, static_cast<std::int32_t>(list(a).size())))])];
            pairs.emplace_back(a, with[idx(below(random, static_cast<std::int32_t>(with.size())))]);
        }
    }

private:
    static std::int32_t below(std::mt19937_64& random, std::int32_t n) {
        return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(n));
    }
};

// nullptr where the site's data are missing.
const Sets* sets(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Sets>> all;
    const auto found = all.find(name);
    if (found != all.end()) return found->second.get();
    std::unique_ptr<Sets>& made = all[name];
    const Scene* site = scene(name);
    if (site == nullptr) return nullptr;
    const std::filesystem::path dir =
        std::filesystem::temp_directory_path() / ("vfplan_sets_" + std::to_string(getpid()));
    write_site(*site, dir, "bench");
    const Threads threads(1);
    const Ranks ranks;
    Progress progress(true);
    make_tables(table_options(site->config), dir, "bench", threads, ranks, progress);
    {
        const CoverageTables tables = read_coverage(dir / "coverage.h5");
        made = std::make_unique<Sets>(tables, CoverageEntries(dir / "coverage.h5"));
    }
    std::filesystem::remove_all(dir);
    return made.get();
}

template <class F>
void each_bit(std::uint64_t bits, F&& f) {
    for (; bits != 0; bits &= bits - 1) f(std::countr_zero(bits));
}

// What a station would add: the greedy gain of every row, in metres.
double gains_of_lists(const Sets& s) {
    double sum = 0;
    for (std::int32_t r = 0; r < s.rows(); ++r) {
        for (const std::int32_t p : s.list(r)) {
            if (s.covered[idx(p)] == 0) sum += s.length_m[idx(p)];
        }
    }
    return sum;
}
double gains_of_blocks(const Sets& s) {
    double sum = 0;
    for (std::int32_t r = 0; r < s.rows(); ++r) {
        for (const Block& b : s.blocks(r)) {
            each_bit(b.bits & ~s.covered_bits[idx(b.word)],
                     [&](int bit) { sum += s.length_m[idx(64 * b.word + bit)]; });
        }
    }
    return sum;
}

// The same in pieces, where all count alike.
double counts_of_lists(const Sets& s) {
    std::int64_t sum = 0;
    for (std::int32_t r = 0; r < s.rows(); ++r) {
        for (const std::int32_t p : s.list(r)) sum += 1 - s.covered[idx(p)];
    }
    return static_cast<double>(sum);
}
double counts_of_blocks(const Sets& s) {
    std::int64_t sum = 0;
    for (std::int32_t r = 0; r < s.rows(); ++r) {
        for (const Block& b : s.blocks(r)) {
            sum += std::popcount(b.bits & ~s.covered_bits[idx(b.word)]);
        }
    }
    return static_cast<double>(sum);
}

// Domination: how many of the pairs' first rows lie within the second.
double within_of_lists(const Sets& s) {
    std::int64_t sum = 0;
    for (const auto& [a, b] : s.pairs) {
        const auto whole = s.list(b);
        auto at = whole.begin();
        bool within = true;
        for (const std::int32_t p : s.list(a)) {
            while (at != whole.end() && *at < p) ++at;
            if (at == whole.end() || *at != p) {
                within = false;
                break;
            }
        }
        sum += within ? 1 : 0;
    }
    return static_cast<double>(sum);
}
double within_of_blocks(const Sets& s) {
    std::int64_t sum = 0;
    for (const auto& [a, b] : s.pairs) {
        const auto whole = s.blocks(b);
        auto at = whole.begin();
        bool within = true;
        for (const Block& part : s.blocks(a)) {
            while (at != whole.end() && at->word < part.word) ++at;
            if (at == whole.end() || at->word != part.word || (part.bits & ~at->bits) != 0) {
                within = false;
                break;
            }
        }
        sum += within ? 1 : 0;
    }
    return static_cast<double>(sum);
}

// Ruin and recreate: each row comes and goes; of each piece one has to know how many cover it.
double cover_of_lists(const Sets& s) {
    std::vector<std::int32_t> cover(s.length_m.size(), 0);
    std::int64_t bared = 0;
    for (std::int32_t r = 0; r < s.rows(); ++r) {
        for (const std::int32_t p : s.list(r)) ++cover[idx(p)];
        const std::int32_t gone = r - 16;
        if (gone < 0) continue;
        for (const std::int32_t p : s.list(gone)) bared += --cover[idx(p)] == 0 ? 1 : 0;
    }
    return static_cast<double>(bared);
}
double cover_of_blocks(const Sets& s) {
    std::vector<std::int32_t> cover(s.length_m.size(), 0);
    std::int64_t bared = 0;
    for (std::int32_t r = 0; r < s.rows(); ++r) {
        for (const Block& b : s.blocks(r)) {
            each_bit(b.bits, [&](int bit) { ++cover[idx(64 * b.word + bit)]; });
        }
        const std::int32_t gone = r - 16;
        if (gone < 0) continue;
        for (const Block& b : s.blocks(gone)) {
            each_bit(b.bits,
                     [&](int bit) { bared += --cover[idx(64 * b.word + bit)] == 0 ? 1 : 0; });
        }
    }
    return static_cast<double>(bared);
}

using Work = double (*)(const Sets&);

void run(benchmark::State& state, const std::string& site, Work work, Work other) {
    const Sets* s = sets(site);
    if (s == nullptr) return state.SkipWithError("the site's data are not there");
    const double want = other(*s);
    // Sums of lengths are taken in the same order: blocks ascend as lists do.
    for (auto _ : state) {
        if (work(*s) != want) return state.SkipWithError("lists and blocks differ");
    }
    const auto entries = static_cast<double>(s->piece.size());
    state.counters["entries"] = entries;
    state.counters["pieces_a_block"] = entries / static_cast<double>(s->block.size());
    state.counters["block_bytes_a_list_byte"] = static_cast<double>(s->block.size()) *
                                                (sizeof(std::int32_t) + sizeof(std::uint64_t)) /
                                                (entries * sizeof(std::int32_t));
}

#define VFPLAN_SETS(name)                                                                 \
    void name##_lists(benchmark::State& state, const std::string& site) {                 \
        run(state, site, name##_of_lists, name##_of_blocks);                              \
    }                                                                                     \
    void name##_blocks(benchmark::State& state, const std::string& site) {                \
        run(state, site, name##_of_blocks, name##_of_lists);                              \
    }                                                                                     \
    BENCHMARK_CAPTURE(name##_lists, town, "town")->Unit(benchmark::kMicrosecond);         \
    BENCHMARK_CAPTURE(name##_blocks, town, "town")->Unit(benchmark::kMicrosecond);        \
    BENCHMARK_CAPTURE(name##_lists, city, "city")->Unit(benchmark::kMicrosecond);         \
    BENCHMARK_CAPTURE(name##_blocks, city, "city")->Unit(benchmark::kMicrosecond);        \
    BENCHMARK_CAPTURE(name##_lists, flat, "flat")->Unit(benchmark::kMicrosecond);         \
    BENCHMARK_CAPTURE(name##_blocks, flat, "flat")->Unit(benchmark::kMicrosecond);        \
    BENCHMARK_CAPTURE(name##_lists, bellevue, "bellevue")->Unit(benchmark::kMicrosecond); \
    BENCHMARK_CAPTURE(name##_blocks, bellevue, "bellevue")->Unit(benchmark::kMicrosecond)

VFPLAN_SETS(gains);
VFPLAN_SETS(counts);
VFPLAN_SETS(within);
VFPLAN_SETS(cover);

}  // namespace
}  // namespace vfplan::bench
