// A job that is killed, stopped or damaged goes on and ends in the same bytes.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <iostream>
#include <random>
#include <sstream>

#include "program.h"

namespace vfplan::test {
namespace {

// A generated city of half a kilometre in tiles of 64 cells, and its finished run, for all tests.
class Resume : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        scratch = new Scratch;
        const std::string site = generated(*scratch, "city", {"--size-km", "0.5", "--seed", "3"});
        scratch->write("job.toml", "preset = \"outdoor\"\n[site]\ninput = \"" + site +
                                       "\"\n[field]\ncell_m = 2\ntile_cells = 64\n"
                                       "[scanner]\nrange_max_m = 30\n");
        const auto begin = std::chrono::steady_clock::now();
        vfplan_expect(0, command("whole"));
        wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    static void TearDownTestSuite() { delete scratch; }

    static Words command(const std::string& dir) {
        return {"run", *scratch / "job.toml", "--out", *scratch / dir, "--quiet"};
    }
    static Path folder(const std::string& name) { return *scratch / name; }
    static Path copy_of_whole(const std::string& name) {
        std::filesystem::remove_all(folder(name));
        std::filesystem::copy(folder("whole"), folder(name),
                              std::filesystem::copy_options::recursive);
        return folder(name);
    }
    static std::vector<Path> files_below(const Path& dir) {
        std::vector<Path> out;
        if (!std::filesystem::exists(dir)) return out;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
            if (entry.is_regular_file()) out.push_back(entry.path());
        }
        std::sort(out.begin(), out.end());
        return out;
    }
    // Runs to the end and expects a warning that names a file; gives what was said.
    static std::string repaired(const std::string& dir, const std::string& name) {
        Words words = command(dir);
        words.pop_back();
        const Output o = vfplan_expect(0, words);
        bool warned = false;
        std::istringstream lines(o.err);
        for (std::string line; std::getline(lines, line);) {
            warned = warned || (line.find("warning") != std::string::npos &&
                                line.find(name) != std::string::npos);
        }
        EXPECT_TRUE(warned) << "no warning about " << name << " in:\n" << o.err;
        return o.err;
    }

    static Scratch* scratch;
    static double wall_s;  // that a whole run takes
};

Scratch* Resume::scratch = nullptr;
double Resume::wall_s = 0;

TEST_F(Resume, KilledAtAnyInstantItEndsInTheSameBytes) {
    std::random_device entropy;
    const unsigned seed = entropy();
    std::cout << "seed " << seed << ", a whole run takes " << wall_s << " s\n";
    std::mt19937_64 random(seed);
    int kills = 0;
    for (int round = 0; kills < 15; ++round) {
        const std::string dir = "killed" + std::to_string(round);
        // Later kills of a round come when much is done already.
        for (int k = 0; k < 4; ++k) {
            const double after = wall_s * std::uniform_real_distribution<double>(0.02, 0.9)(random);
            const Output o = vfplan_signalled(SIGKILL, after, command(dir));
            ASSERT_TRUE(o.code == 0 || o.code == 128 + SIGKILL)
                << "after " << after << " s of round " << round << ": " << o.code << "\n"
                << o.err;
            if (o.code == 0) break;
            ++kills;
        }
        vfplan_expect(0, command(dir));
        expect_same_run(folder("whole"), folder(dir));
        std::filesystem::remove_all(folder(dir));
    }
}

TEST_F(Resume, ASignalEndsItPolitelyAndKeepsItsShards) {
    int stopped = 0;
    for (const double share : {0.1, 0.25, 0.4, 0.6}) {
        std::filesystem::remove_all(folder("stopped"));
        const Output o = vfplan_signalled(SIGTERM, share * wall_s, command("stopped"));
        if (o.code == 0) continue;
        if (o.code == 128 + SIGTERM) continue;  // before it listened
        ++stopped;
        EXPECT_EQ(o.code, 75) << o.err;
        EXPECT_NE(o.err.find("stopped"), std::string::npos) << o.err;
        const auto before = files_below(folder("stopped") / "shards");
        std::map<Path, std::filesystem::file_time_type> times;
        for (const Path& p : before) {
            EXPECT_EQ(p.extension(), ".h5") << p;  // nothing half written
            times[p] = std::filesystem::last_write_time(p);
        }
        vfplan_expect(0, command("stopped"));
        expect_same_run(folder("whole"), folder("stopped"));
        for (const auto& [path, time] : times) {
            EXPECT_EQ(std::filesystem::last_write_time(path), time) << path << " was made again";
        }
    }
    EXPECT_GT(stopped, 0);
}

// One tile of 1.2 km in cells of 10 cm takes a minute and more. Slurm gives 30 s, we take ten.
TEST_F(Resume, ATaskThatTakesLongIsGivenUp) {
    const Scratch own;
    const std::string site = generated(own, "city", {"--size-km", "1.2", "--seed", "4"});
    for (const int signal : {SIGTERM, SIGHUP}) {
        const Path dir = folder("long");
        std::filesystem::remove_all(dir);
        const auto begin = std::chrono::steady_clock::now();
        constexpr double after_s = 4;
        const Output o =
            vfplan_signalled(signal, after_s,
                             {"run", site, "--out", dir, "--quiet", "--threads", "2", "--set",
                              "field.cell_m=0.1", "--set", "field.tile_cells=16384"});
        const double s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        EXPECT_EQ(o.code, 75) << o.err;
        EXPECT_LT(s, after_s + 10);
        for (const Path& p : files_below(dir)) EXPECT_NE(p.extension(), ".tmp") << p;
    }
}

// Whoever starts it with nohup wants it to stay.
TEST_F(Resume, AnIgnoredHangupStaysIgnored) {
    std::signal(SIGHUP, SIG_IGN);
    const Output o = vfplan_signalled(SIGHUP, 0.3 * wall_s, command("nohup"));
    std::signal(SIGHUP, SIG_DFL);
    EXPECT_EQ(o.code, 0) << o.err;
    expect_same_run(folder("whole"), folder("nohup"));
}

TEST_F(Resume, DamagedShardsAreNamedAndMadeAgain) {
    const auto shards = files_below(folder("whole") / "shards");
    ASSERT_GT(shards.size(), 3U);
    std::mt19937_64 random(1);
    for (const std::size_t i : {std::size_t{0}, shards.size() / 2, shards.size() - 1}) {
        const std::string name = shards[i].filename().string();
        for (const int way : {0, 1, 2}) {
            const Path dir = copy_of_whole("damaged");
            const Path shard = dir / "shards" / name;
            if (way == 0) flip_a_bit(shard, std::uniform_real_distribution<double>()(random));
            if (way == 1) std::filesystem::resize_file(shard, 700);
            if (way == 2) std::filesystem::remove(shard);
            repaired("damaged", name);
            expect_same_run(folder("whole"), dir);
        }
    }
}

TEST_F(Resume, DamagedIndicesAreNamedAndMadeAgain) {
    for (const char* name : {"field.h5", "coverage.h5", "pool.h5"}) {
        for (const double where : {0.0, 0.3, 0.999}) {
            const Path dir = copy_of_whole("damaged");
            flip_a_bit(dir / name, where);
            repaired("damaged", name);
            expect_same_run(folder("whole"), dir);
        }
    }
}

// The shard of another job under the right name is whole, but not what the index was made from.
TEST_F(Resume, AShardOfAnotherJobIsNotTaken) {
    Words other = command("other");
    other.insert(other.end(), {"--set", "scanner.range_max_m=25"});
    vfplan_expect(0, other);
    for (const Path& p : files_below(folder("whole") / "shards")) {
        const std::string name = p.filename().string();
        if (name != "coverage-00000.h5" && name.find("00002") == std::string::npos) continue;
        const Path dir = copy_of_whole("mixed");
        std::filesystem::copy_file(folder("other") / "shards" / name, dir / "shards" / name,
                                   std::filesystem::copy_options::overwrite_existing);
        for (const char* c : {"verify", "plan"}) {
            const Output o = vfplan_expect(4, {c, dir});
            EXPECT_NE(o.err.find(name), std::string::npos) << o.err;
        }
        repaired("mixed", name);
        expect_same_run(folder("whole"), dir);
    }
}

// Work in progress is checked as well as what stays.
TEST_F(Resume, DamagedWorkInProgressIsNamedAndMadeAgain) {
    int tried = 0;
    for (double share = 0.15; tried < 3 && share < 0.9; share += 0.05) {
        std::filesystem::remove_all(folder("early"));
        const Output o = vfplan_signalled(SIGTERM, share * wall_s, command("early"));
        if (o.code != 75) continue;
        std::vector<Path> files = files_below(folder("early") / "work");
        std::erase_if(files, [](const Path& p) { return p.extension() != ".h5"; });
        if (files.empty()) continue;
        ++tried;
        const Path damaged = files[files.size() * static_cast<std::size_t>(tried) / 4];
        flip_a_bit(damaged, 0.5);
        repaired("early", damaged.filename().string());
        expect_same_run(folder("whole"), folder("early"));
    }
    EXPECT_GT(tried, 0);
}

}  // namespace
}  // namespace vfplan::test
