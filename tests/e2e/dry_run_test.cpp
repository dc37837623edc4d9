// A dry run: bounded whatever the job, names what lies far off, refuses what cannot be done.
#include <csignal>

#include "../words.h"
#include "program.h"

namespace vfplan::test {
namespace {

// The number behind a word of what a dry run prints.
double number_after(const std::string& text, const std::string& word) {
    const auto at = text.find(word);
    if (at == std::string::npos) return -1;
    return std::stod(text.substr(text.find_first_of("0123456789", at)));
}

std::string house(double x, double y) {
    std::string ring;
    for (const auto& [dx, dy] : {std::pair(0, 0), {12, 0}, {12, 9}, {0, 9}, {0, 0}}) {
        ring += (ring.empty() ? "[" : ",[") + std::to_string(x + dx) + "," +
                std::to_string(y + dy) + "]";
    }
    return R"({"type":"Feature","properties":{"id":"house )" + std::to_string(int(x)) +
           R"("},"geometry":{"type":"Polygon","coordinates":[[)" + ring + "]]}}";
}

std::string job(const Scratch& scratch, const std::vector<std::string>& features,
                const std::string& more = "") {
    std::string all;
    for (const std::string& f : features) all += (all.empty() ? "" : ",") + f;
    scratch.write("site.geojson", R"({"type":"FeatureCollection","features":[)" + all + "]}");
    return scratch.write("job.toml", "preset = \"outdoor\"\n[site]\ninput = \"site.geojson\"\n" +
                                         ("[field]\ncell_m = 0.5\n" + more));
}

// A run and its dry run alike end with code 2 and these words, and leave nothing.
void expect_refused(const Scratch& scratch, const Words& job, const Words& words) {
    for (const char* last : {"--dry-run", "--quiet"}) {
        Words all = {"run", "--out", scratch / "out", last};
        all.insert(all.end(), job.begin(), job.end());
        const Output o = vfplan_process(all);
        EXPECT_EQ(o.code, 2) << o.err;
        expect_words(o.err, words);
        EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
    }
}

TEST(DryRun, NamesWhatLiesFarOffAndEndsAllTheSame) {
    const Scratch scratch;
    for (const double far : {5e4, 1e6}) {
        const std::string file = job(scratch, {house(0, 0), house(20, 3), house(far, 200)});
        const Output o = vfplan_process({"run", file, "--dry-run"});
        EXPECT_EQ(o.code, 0) << o.err;
        expect_words(o.err,
                     {"feature 3, id house", "lies far off", "site.crop_m = [0, 0, 32, 12]"});
        EXPECT_GT(number_after(o.out, "cells"), 1e7);
        EXPECT_GT(number_after(o.out, "candidates"), 1);
        EXPECT_LT(number_after(o.out, "candidates"), 100);
        const Output looked = vfplan_process({"inspect", file, "--out", scratch / "site.png"});
        expect_words(looked.out, {"feature 3, id house"});
    }
}

TEST(DryRun, RefusesWhatRunRefuses) {
    const Scratch scratch;
    const std::string file = job(scratch, {house(0, 0), house(9e4, 9e4)});
    expect_refused(scratch, {file, "--set", "field.cell_m=0.1"},
                   {"can be numbered", "site.crop_m"});
    expect_refused(scratch, {file, "--set", "coverage.partition_m=1e-9"},
                   {"pieces of wall", "can be numbered"});
}

// A limit of the shell is as good as a small machine.
TEST(DryRun, RefusesWhatDoesNotFitIntoMemory) {
    const Scratch scratch;
    const std::string file = job(scratch, {house(0, 0), house(60, 0)});
    const std::string limited = "ulimit -v 3000000; exec " VFPLAN_BINARY " run " + file +
                                " --set coverage.partition_m=2e-7 --out " + (scratch / "out");
    for (const char* last : {" --dry-run", " --quiet"}) {
        const Output o = run_program("sh", {"-c", limited + last});
        EXPECT_EQ(o.code, 2) << o.err;
        expect_words(o.err, {"coverage.partition_m", "ulimit -v grants 3.07 GB", "or more"});
        EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
    }
}

TEST(DryRun, IsRightWithinTwo) {
    const Scratch scratch;
    for (const char* kind : {"town", "flat"}) {
        const std::string site = generated(scratch, kind);
        const std::vector<std::string> sets = {"site.input=" + site, kind == std::string("town")
                                                                         ? "field.cell_m=1"
                                                                         : "field.cell_m=0.03"};
        const std::string config = config_file(kind + std::string(".toml"));
        const Output o = vfplan_expect(0, with_sets({"run", config, "--dry-run"}, sets));
        vfplan_expect(0, with_sets({"run", config, "--out", scratch / kind, "--quiet"}, sets));
        const Json s = read_json(Path(scratch / kind) / "summary.json");
        const auto near = [&](double estimate, double real) {
            EXPECT_LT(estimate, 2 * real) << kind << "\n" << o.out;
            EXPECT_GT(estimate, real / 2) << kind << "\n" << o.out;
        };
        EXPECT_EQ(number_after(o.out, "cells"), s["grid"]["cells"].get<double>());
        EXPECT_EQ(number_after(o.out, "pieces"), s["pieces"].get<double>());
        near(number_after(o.out, "candidates"), s["candidates"].get<double>());
        near(number_after(o.out, "memory"), s["peak_rss_mb"].get<double>());
    }
}

TEST(DryRun, EndsAtASignal) {
    const Scratch scratch;
    const std::string site = generated(scratch, "town");
    const Words words = {
        "run",   config_file("town.toml"),   "--dry-run", "--set", "site.input=" + site,
        "--set", "scanner.range_max_m=3000", "--quiet"};
    int stopped = 0;
    for (const int signal : {SIGTERM, SIGINT}) {
        for (const double after_s : {0.1, 0.2, 0.4, 0.8}) {
            const Output o = vfplan_signalled(signal, after_s, words);
            if (o.code == 0 || o.code == 128 + signal) continue;  // over, or before it listened
            EXPECT_EQ(o.code, 75) << o.err;
            expect_words(o.err, {"stopped by a signal"});
            ++stopped;
        }
    }
    EXPECT_GT(stopped, 0);
}

// A job that takes more than is granted is refused before it begins; others keep to it.
TEST(DryRun, MemoryAndTimeThatAreGrantedAreHeldAgainstTheEstimate) {
    const Scratch scratch;
    const std::string file = job(scratch, {house(0, 0), house(20, 3), house(5, 30)});
    const auto refused = [&](const char* option, const char* grant,
                             const std::vector<std::string>& words) {
        expect_refused(scratch, {file, "--set", "field.cell_m=0.02", option, grant}, words);
    };
    refused("--memory", "64M", {"--memory grants 0.067", "take"});
    refused("--time", "0.01s", {"the job takes about", "--time grants 0.01 s", "take"});
    refused("--memory", "1K", {"--memory: at least 64M"});
    refused("--time", "4 weeks", {"--time", "weeks"});
    vfplan_expect(
        0, {"run", file, "--out", scratch / "granted", "-q", "--memory", "1.5g", "--time", "2h"});
    vfplan_expect(0, {"run", file, "--out", scratch / "free", "-q"});
    expect_same_run(scratch / "granted", scratch / "free");
}

}  // namespace
}  // namespace vfplan::test
