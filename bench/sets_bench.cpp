// Rows of the coverage table as sorted lists (what planning uses), as sorted blocks of 64 bits, and
// as a bit for each piece, in what planning does with them. All forms must give the same.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <bit>
#include <ctime>
#include <string>
#include <utility>

#include "bench/networks.h"
#include "bench/sets.h"
#include "engine/search/reduce.h"
#include "engine/search/search.h"

namespace vfplan::bench {
namespace {

using Result = std::vector<double>;

template <class Gain>
Result for_all(const Sets& s, const Gain& gain) {
    Result out;
    out.reserve(idx(s.lists.size()));
    for (std::int32_t i = 0; i < s.lists.size(); ++i) out.push_back(gain(i));
    return out;
}

// --- gains: by length, in ascending order, so that sums have the same bits; and by count
// ----------

Result length_lists(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        double sum = 0;
        for (const std::int32_t n : s.lists.of(i)) {
            if (s.covered[idx(n)] == 0) sum += s.length_m[idx(n)];
        }
        return sum;
    });
}
// Covered pieces have length 0: nothing to ask, and adding 0 changes no bit.
Result length_zeroed(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        double sum = 0;
        for (const std::int32_t n : s.lists.of(i)) sum += s.open_m[idx(n)];
        return sum;
    });
}
Result length_blocks(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        double sum = 0;
        s.blocks.each(i, [&](std::int32_t w, std::uint64_t bits) {
            const double* of = s.length_m.data() + 64 * idx(w);
            each_bit(bits & s.open_bits[idx(w)], [&](int b) { sum += of[b]; });
        });
        return sum;
    });
}
Result length_dense(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        double sum = 0;
        const std::uint64_t* row = s.dense.data() + s.words * idx(i);
        for (std::size_t w = 0; w < s.words; ++w) {
            const double* of = s.length_m.data() + 64 * w;
            each_bit(row[w] & s.open_bits[w], [&](int b) { sum += of[b]; });
        }
        return sum;
    });
}
Result count_lists(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        std::int64_t sum = 0;
        for (const std::int32_t n : s.lists.of(i)) sum += 1 - s.covered[idx(n)];
        return static_cast<double>(sum);
    });
}
Result count_blocks(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        std::int64_t sum = 0;
        s.blocks.each(i, [&](std::int32_t w, std::uint64_t bits) {
            sum += std::popcount(bits & s.open_bits[idx(w)]);
        });
        return static_cast<double>(sum);
    });
}
Result count_dense(const Sets& s) {
    return for_all(s, [&](std::int32_t i) {
        std::int64_t sum = 0;
        const std::uint64_t* row = s.dense.data() + s.words * idx(i);
        for (std::size_t w = 0; w < s.words; ++w) sum += std::popcount(row[w] & s.open_bits[w]);
        return static_cast<double>(sum);
    });
}

// --- domination: as engine/search/reduce.cpp looks for it, among those that share the rarest
// ------

template <class Within>
Result dominated(const Sets& s, const Within& within) {
    Result out;
    for (const std::int32_t c : s.asked) {
        std::int32_t rarest = -1;
        for (const std::int32_t n : s.lists.of(c)) {
            if (rarest < 0 || s.listed_by.of(n).size() < s.listed_by.of(rarest).size()) rarest = n;
        }
        std::int32_t hits = 0;
        if (rarest >= 0) {
            for (const std::int32_t by : s.listed_by.of(rarest)) {
                if (by == c || (s.signature[idx(c)] & ~s.signature[idx(by)]) != 0) continue;
                hits += within(c, by) ? 1 : 0;
            }
        }
        out.push_back(hits);
    }
    return out;
}
Result subset_lists(const Sets& s) {
    return dominated(s, [&](std::int32_t part, std::int32_t whole) {
        const auto all = s.lists.of(whole);
        auto at = all.begin();
        for (const std::int32_t n : s.lists.of(part)) {
            if (s.there[idx(n)] == 0) continue;
            while (at != all.end() && *at < n) ++at;
            if (at == all.end() || *at != n) return false;
        }
        return true;
    });
}
Result subset_blocks(const Sets& s) {
    const Blocks& b = s.blocks;
    return dominated(s, [&](std::int32_t part, std::int32_t whole) {
        auto at = idx(b.begin[idx(whole)]);
        const auto end = idx(b.begin[idx(whole) + 1]);
        for (auto i = idx(b.begin[idx(part)]); i < idx(b.begin[idx(part) + 1]); ++i) {
            const std::uint64_t bits = b.bits[i] & s.all_there[idx(b.word[i])];
            if (bits == 0) continue;
            while (at < end && b.word[at] < b.word[i]) ++at;
            if (at == end || b.word[at] != b.word[i] || (bits & ~b.bits[at]) != 0) return false;
        }
        return true;
    });
}
Result subset_dense(const Sets& s) {
    return dominated(s, [&](std::int32_t part, std::int32_t whole) {
        const std::uint64_t* p = s.dense.data() + s.words * idx(part);
        const std::uint64_t* q = s.dense.data() + s.words * idx(whole);
        for (std::size_t w = 0; w < s.words; ++w) {
            if ((p[w] & s.all_there[w] & ~q[w]) != 0) return false;
        }
        return true;
    });
}

// --- ruin and recreate: stations go and come again, with what engine/search/choosing.cpp notes
// ----

struct Notes {
    const Sets& s;
    std::vector<std::int32_t> cover, owner, alone;
    double bared = 0;

    explicit Notes(const Sets& sets)
        : s(sets), cover(s.length_m.size()), owner(cover.size()), alone(idx(s.lists.size())) {}
    void put(std::int32_t r, std::int32_t c) {
        const std::int32_t before = cover[idx(r)]++;
        if (before == 0) ++alone[idx(c)];
        if (before == 1) --alone[idx(owner[idx(r)])];
        owner[idx(r)] ^= c;
    }
    void take(std::int32_t r, std::int32_t c) {
        owner[idx(r)] ^= c;
        const std::int32_t left = --cover[idx(r)];
        if (left == 0) --alone[idx(c)], ++bared;
        if (left == 1) ++alone[idx(owner[idx(r)])];
    }
    Result result() const {
        Result out(cover.begin(), cover.end());
        out.insert(out.end(), alone.begin(), alone.end());
        out.push_back(bared);
        return out;
    }
};

// Puts the plan, then takes and puts each ball.
template <class Put, class Take>
void ruin(const Sets& s, const Put& put, const Take& take) {
    for (std::size_t k = 0; k < s.ruined.size(); ++k) {
        for (const std::int32_t c : s.ruined[k]) {
            if (k > 0) take(c);
        }
        for (const std::int32_t c : s.ruined[k]) put(c);
    }
}
Result change_lists(const Sets& s) {
    Notes n(s);
    const auto put = [&](std::int32_t c) {
        for (const auto r : s.lists.of(c)) n.put(r, c);
    };
    const auto take = [&](std::int32_t c) {
        for (const auto r : s.lists.of(c)) n.take(r, c);
    };
    ruin(s, put, take);
    return n.result();
}
Result change_blocks(const Sets& s) {
    Notes n(s);
    const auto rows = [&](std::int32_t c, const auto& f) {
        s.blocks.each(c, [&](std::int32_t w, std::uint64_t bits) {
            each_bit(bits, [&](int b) { f(64 * w + b); });
        });
    };
    const auto put = [&](std::int32_t c) { rows(c, [&](std::int32_t r) { n.put(r, c); }); };
    const auto take = [&](std::int32_t c) { rows(c, [&](std::int32_t r) { n.take(r, c); }); };
    ruin(s, put, take);
    return n.result();
}
// Counts of cover alone: all that bits can keep, one digit of 64 counts in a word. Who covers a row
// alone, which the search asks, they cannot say.
Result cover_lists(const Sets& s) {
    std::vector<std::int32_t> cover(s.length_m.size(), 0);
    double bared = 0;
    ruin(
        s,
        [&](std::int32_t c) {
            for (const auto r : s.lists.of(c)) ++cover[idx(r)];
        },
        [&](std::int32_t c) {
            for (const auto r : s.lists.of(c)) bared += --cover[idx(r)] == 0 ? 1 : 0;
        });
    Result out(cover.begin(), cover.end());
    out.push_back(bared);
    return out;
}
Result cover_blocks(const Sets& s) {
    constexpr int digits = 12;
    std::vector<std::array<std::uint64_t, digits>> count(s.words);
    std::int64_t bared = 0;
    ruin(
        s,
        [&](std::int32_t c) {
            s.blocks.each(c, [&](std::int32_t w, std::uint64_t carry) {
                for (int d = 0; carry != 0; ++d) {
                    const std::uint64_t was =
                        std::exchange(count[idx(w)][d], count[idx(w)][d] ^ carry);
                    carry &= was;
                }
            });
        },
        [&](std::int32_t c) {
            s.blocks.each(c, [&](std::int32_t w, std::uint64_t bits) {
                std::uint64_t borrow = bits;
                std::uint64_t left = 0;
                for (int d = 0; d < digits; ++d) {
                    std::uint64_t& digit = count[idx(w)][d];
                    digit ^= borrow;
                    borrow &= digit;
                    left |= digit;
                }
                bared += std::popcount(bits & ~left);
            });
        });
    Result out;
    for (std::size_t r = 0; r < s.length_m.size(); ++r) {
        double sum = 0;
        for (int d = digits; d-- > 0;)
            sum = 2 * sum + static_cast<double>(count[r / 64][d] >> (r % 64) & 1);
        out.push_back(sum);
    }
    out.push_back(static_cast<double>(bared));
    return out;
}

// --- the benchmarks -----------------------------------------------------------------------------

using Work = Result (*)(const Sets&);
struct Form {
    const char* name;
    Work work;
};

void run(benchmark::State& state, const std::string& site, const std::string& kind,
         const Form& form, Work lists) {
    const Sets* s = sets(site, kind);
    if (s == nullptr) return state.SkipWithError("no data of this site");
    const std::string name = form.name;
    if (name == "dense" && s->dense.empty()) return state.SkipWithError("no data: too large");
    if (form.work(*s) != lists(*s)) return state.SkipWithError("another result than lists give");
    for (auto _ : state) benchmark::DoNotOptimize(form.work(*s));
    const auto entries = static_cast<double>(s->lists.to.size());
    const auto blocks = static_cast<double>(s->blocks.word.size());
    state.counters["sets"] = s->lists.size();
    state.counters["entries"] = entries;
    state.counters["fill"] = entries / blocks;
    state.counters["bytes_an_entry"] = name == "dense"
                                           ? 8 * static_cast<double>(s->dense.size()) / entries
                                       : name == "blocks" ? 12 * blocks / entries
                                                          : 4;
}

// How long the parts of planning take that these loops lie in, once.
void part(benchmark::State& state, const std::string& site, const std::string& what) {
    const MainNetwork* n = main_network(site);
    if (n == nullptr) return state.SkipWithError("no data of this site");
    if (what == "greedy") {
        for (auto _ : state) state.SetIterationTime(n->greedy_s);
        return;
    }
    Problem free = n->problem;
    free.block.clear();
    free.loose.clear();
    const Threads threads(1);
    const bool loops = what.ends_with("loops");
    const Reduced reduced = reduce(free);
    const Problem& p = loops ? n->problem : reduced.problem;
    const Choice start = loops ? n->greedy : reduced_choice(reduced, free.columns(), n->greedy);
    std::size_t stations = 0;
    for (auto _ : state) {
        const std::clock_t before = std::clock();
        if (what.starts_with("reduce")) {
            benchmark::DoNotOptimize(reduce(free));
        } else {
            stations = search(threads, p, start, {n->options.effort, 0}).size();
        }
        state.SetIterationTime(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
    }
    if (stations > 0) state.counters["stations"] = static_cast<double>(stations);
}

const bool registered = [] {
    const std::vector<std::pair<std::string, std::vector<Form>>> loops = {
        {"length",
         {{"lists", length_lists},
          {"zeroed", length_zeroed},
          {"blocks", length_blocks},
          {"dense", length_dense}}},
        {"count", {{"lists", count_lists}, {"blocks", count_blocks}, {"dense", count_dense}}},
        {"subset", {{"lists", subset_lists}, {"blocks", subset_blocks}, {"dense", subset_dense}}},
        {"change", {{"lists", change_lists}, {"blocks", change_blocks}}},
        {"cover", {{"lists", cover_lists}, {"blocks", cover_blocks}}}};
    for (const std::string site : {"town", "bellevue", "office", "allegheny"}) {
        for (const std::string kind : {"table", "network", "reduced", "rows"}) {
            for (const auto& [loop, forms] : loops) {
                if (kind == "rows" && loop != "subset") continue;
                for (const Form& form : forms) {
                    benchmark::RegisterBenchmark(
                        fmt::format("sets_{}/{}/{}/{}", loop, site, kind, form.name).c_str(),
                        [=, lists = forms.front().work](benchmark::State& state) {
                            run(state, site, kind, form, lists);
                        })
                        ->Unit(benchmark::kMillisecond);
                }
            }
        }
        for (const std::string what :
             {"greedy", "reduce", "reduce_loops", "search", "search_loops"}) {
            benchmark::RegisterBenchmark(fmt::format("sets_plan/{}/{}", site, what).c_str(),
                                         [=](benchmark::State& state) { part(state, site, what); })
                ->Unit(benchmark::kMillisecond)
                ->UseManualTime()
                ->Iterations(1);
        }
    }
    return true;
}();

}  // namespace
}  // namespace vfplan::bench
