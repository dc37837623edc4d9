// `verify` says no to a plan that somebody changed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "../words.h"
#include "engine/folder/publication.h"
#include "io/tables/certificate_text.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/field_tiles.h"
#include "io/tables/plan_file.h"
#include "program.h"

namespace vfplan::test {
namespace {

// One planned crop of a town, and its tables, for all tests here.
class Verify : public ::testing::Test {
protected:
    static void SetUpTestSuite() {
        scratch = new Scratch;
        const std::string site = generated(*scratch, "town");
        vfplan_expect(0, with_sets({"run", config_file("town.toml"), "--out", run(), "--quiet"},
                                   {"site.input=" + site, "site.crop_m=[0,0,300,200]",
                                    "field.cell_m=4", "output.formats=['csv']"}));
    }
    static void TearDownTestSuite() { delete scratch; }

    static std::string run() { return *scratch / "run"; }

    // Verifies (or plans) in a copy of the run after `change`; its answer.
    static Output after(const std::function<void(const Path&)>& change,
                        const char* command = "verify") {
        const Path copy = *scratch / "copy";
        std::filesystem::remove_all(copy);
        std::filesystem::copy(run(), copy, std::filesystem::copy_options::recursive);
        change(copy);
        return vfplan_process({command, copy});
    }

    static Output after_plan(const std::function<void(PlanTable&)>& change) {
        return after([&](const Path& dir) {
            PlanTable plan = read_plan(dir / "plan.h5");
            change(plan);
            write_plan(dir / "plan.h5", plan);
            publish_plan(dir, read_json(dir / "summary.json"));  // else its hash alone would tell
        });
    }

    static void expect_no(const Output& o) {
        EXPECT_EQ(o.code, 1) << o.out << o.err;
        EXPECT_NE(o.out.find("NO: the plan does not hold"), std::string::npos) << o.out << o.err;
    }

    // No yes and no crash: exit code 1, or 4 with the file's name where it cannot be read at all.
    static void expect_refused(const Output& o, const std::string& file) {
        EXPECT_TRUE(o.code == 1 || (o.code == 4 && o.err.find(file) != std::string::npos))
            << o.code << "\n"
            << o.out << o.err;
    }

    static Scratch* scratch;
};

Scratch* Verify::scratch = nullptr;

TEST_F(Verify, YesBefore) {
    const Output o = after_plan([](PlanTable&) {});
    EXPECT_EQ(o.code, 0) << o.out << o.err;
}

TEST_F(Verify, NoWhenAStationIsGone) {
    expect_no(after_plan([](PlanTable& t) {
        t.plan.stations.erase(t.plan.stations.begin());
        std::vector<Link> links;
        for (Link l : t.plan.links) {
            if (l.from == 0 || l.to == 0) continue;
            --l.from;
            --l.to;
            links.push_back(l);
        }
        t.plan.links = links;
    }));
}

TEST_F(Verify, NoWhenAStationMoved) {
    expect_no(after_plan([](PlanTable& t) {
        t.plan.stations[0].candidate = t.plan.stations[0].candidate == 0 ? 1 : 0;
    }));
}

TEST_F(Verify, NoWhenLinksAreGone) {
    expect_no(after_plan([](PlanTable& t) { t.plan.links.clear(); }));
}

TEST_F(Verify, NoWhenALinkIsMadeUp) {
    expect_no(after_plan([](PlanTable& t) {
        // The first station and the one farthest from the network's start that it has no link to.
        const auto linked = [&](std::int32_t b) {
            return std::any_of(t.plan.links.begin(), t.plan.links.end(),
                               [&](const Link& l) { return l.from == 0 && l.to == b; });
        };
        for (auto b = static_cast<std::int32_t>(t.plan.stations.size()) - 1; b > 0; --b) {
            if (!linked(b)) {
                const auto behind = std::find_if(t.plan.links.begin(), t.plan.links.end(),
                                                 [](const Link& l) { return l.from > 0; });
                t.plan.links.insert(behind, {0, b, 0.9, {}});
                return;
            }
        }
    }));
}

TEST_F(Verify, NoWhenACoveredPieceIsSaidToHaveNoViewpoint) {
    expect_no(after_plan([](PlanTable& t) {
        *std::find(t.plan.pieces.begin(), t.plan.pieces.end(), PieceStatus::covered) =
            PieceStatus::no_viewpoint;
    }));
}

TEST_F(Verify, NoWhenTheCertificateClaimsMore) {
    expect_no(after_plan([](PlanTable& t) { ++t.plan.certificate.networks[0].bound; }));
}

TEST_F(Verify, NoWhenTheCertificateWeighsLess) {
    expect_no(after_plan([](PlanTable& t) {
        for (LineWeight& w : t.plan.certificate.networks[0].cases[0].weights) w.weight /= 2;
    }));
}

// The same by the program that has nothing of the planner in it.
TEST_F(Verify, TheCheckerAgrees) {
    const auto check = [](const std::string& dir) {
        const std::string program = (Path(VFPLAN_BINARY).parent_path() / "vfplan_check").string();
        return std::system(
            fmt::format("\"{}\" \"{}\" > \"{}.check\" 2>&1", program, dir, dir).c_str());
    };
    const Path dir = *scratch / "checked";
    std::filesystem::copy(run(), dir, std::filesystem::copy_options::recursive);
    for (const std::string method : {"greedy", "certified", "refined"}) {
        vfplan_expect(0, with_sets({"plan", dir, "--quiet"},
                                   {"output.formats=['certificate']", "plan.method=" + method,
                                    "plan.proof_effort=100"}));
        EXPECT_EQ(check(dir), 0) << read_bytes(dir.string() + ".check");
        vfplan_expect(0, {"verify", dir, "--quiet"});
    }
    std::string text = read_bytes(dir / "certificate.txt");
    const PlanTable plan = read_plan(dir / "plan.h5");
    EXPECT_EQ(text, text_of(plan.plan.certificate));
    const std::size_t at = text.find("bound ") + 6;
    text[at] = static_cast<char>(text[at] + 1);
    std::ofstream(dir / "certificate.txt", std::ios::binary) << text;
    EXPECT_NE(check(dir), 0);
    EXPECT_NE(read_bytes(dir.string() + ".check").find("network 0"), std::string::npos);
}

// A whole field of this job by its hashes, with other values.
TEST_F(Verify, NoWhenTheFieldIsAnother) {
    expect_no(after([](const Path& dir) {
        const FieldFile field(dir / "field.h5");
        const Layout layout = field.info().layout;
        std::vector<Path> tiles;
        for (const auto& entry : std::filesystem::directory_iterator(dir / "shards")) {
            if (entry.path().filename().string().rfind("field-", 0) == 0) {
                tiles.push_back(entry.path());
            }
        }
        std::sort(tiles.begin(), tiles.end());
        ASSERT_EQ(tiles.size(), static_cast<std::size_t>(layout.tiles()));
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            FieldTile tile;
            tile.window = layout.tile_window(static_cast<std::int64_t>(t));
            tile.vf_rad = field.read(tile.window);
            for (float& v : tile.vf_rad) v *= 0.9F;
            tile.closed.resize(tile.vf_rad.size(), 0);
            write_field_tile(tiles[t], field.info().key, tile);
        }
        write_field_index(dir / "field.h5", field.info(), tiles);
    }));
}

TEST_F(Verify, DamagedShardsAreNamed) {
    std::vector<std::string> shards;
    for (const auto& entry : std::filesystem::directory_iterator(run() + "/shards")) {
        shards.push_back(entry.path().filename().string());
    }
    ASSERT_GE(shards.size(), 2U);
    for (const std::string& name : shards) {
        const auto flip = [&](const Path& dir) {
            std::string bytes = read_bytes(dir / "shards" / name);
            bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
            std::ofstream(dir / "shards" / name, std::ios::binary) << bytes;
        };
        const auto cut = [&](const Path& dir) {
            std::filesystem::resize_file(dir / "shards" / name, 500);
        };
        const auto remove = [&](const Path& dir) {
            std::filesystem::remove(dir / "shards" / name);
        };
        for (const auto& damage :
             std::vector<std::function<void(const Path&)>>{flip, cut, remove}) {
            for (const char* command : {"verify", "plan"}) {
                const Output o = after(damage, command);
                // The pool follows from the tables, so plan makes it again.
                const bool mends = command == std::string("plan") && name.starts_with("pool-");
                EXPECT_EQ(o.code, mends ? 0 : 4) << command << " " << name << "\n"
                                                 << o.out << o.err;
                EXPECT_NE(o.err.find(name), std::string::npos) << command << "\n" << o.err;
            }
        }
    }
}

// Another job's plan has other candidates and pieces.
TEST_F(Verify, NoToAnotherJobsPlan) {
    const std::string site = generated(*scratch, "flat");
    vfplan_expect(
        0, with_sets({"run", config_file("flat.toml"), "--out", *scratch / "flat", "--quiet"},
                     {"site.input=" + site, "field.cell_m=0.1", "output.formats=['csv']"}));
    const auto flat = *scratch / "flat/plan.h5";
    const auto over = std::filesystem::copy_options::overwrite_existing;
    expect_refused(
        after([&](const Path& dir) { std::filesystem::copy_file(flat, dir / "plan.h5", over); }),
        "plan.h5");
    std::filesystem::copy_file(run() + "/plan.h5", flat, over);
    expect_refused(vfplan_process({"verify", *scratch / "flat"}), "plan.h5");
}

TEST_F(Verify, NoToNumbersOutOfRange) {
    expect_refused(after_plan([](PlanTable& t) { t.plan.stations[0].candidate = 1'000'000; }),
                   "plan.h5");
    expect_refused(after_plan([](PlanTable& t) { t.plan.stations[0].candidate = -1; }), "plan.h5");
    expect_refused(after_plan([](PlanTable& t) { t.plan.links[0].to = 1'000'000; }), "plan.h5");
    expect_refused(after_plan([](PlanTable& t) { t.plan.pieces.resize(3); }), "plan.h5");
}

// A cell of this gallery has its centre a tenth of a millimetre beyond a slanted wall as drawn, and
// within it as rounded to a millimetre: neither is wrong.
TEST_F(Verify, LeavesOpenWhatRoundingDecides) {
    constexpr const char* site = "agp/randsimple/randsimple-60-1.geojson";
    VFPLAN_NEED_DATA(site);
    vfplan_expect(
        0,
        with_sets({"run", config_file("office.toml"), "--out", *scratch / "gallery", "--quiet"},
                  {"site.input=" + data_file(site), "site.unit_m=1.9079482195326158",
                   "scanner.range_min_m=0", "scanner.range_max_m=1000", "field.cell_m=0.2",
                   "coverage.partition_m=0.25", "site.min_width_m=0", "output.formats=['csv']"}));
    const Output out = vfplan_expect(0, {"verify", *scratch / "gallery"});
    EXPECT_NE(out.out.find("0 are free in something solid or outside"), std::string::npos)
        << out.out;
}

TEST_F(Verify, DamagedOrMissingFilesAreNamed) {
    for (const char* name : {"plan.h5", "coverage.h5", "field.h5"}) {
        const Output cut = after([&](const Path& dir) {
            std::filesystem::resize_file(dir / name, std::filesystem::file_size(dir / name) / 2);
        });
        EXPECT_EQ(cut.code, 4) << name << "\n" << cut.out << cut.err;
        EXPECT_NE(cut.err.find(name), std::string::npos) << cut.err;
        const Output gone = after([&](const Path& dir) { std::filesystem::remove(dir / name); });
        EXPECT_EQ(gone.code, 4) << name << "\n" << gone.out << gone.err;
        EXPECT_NE(gone.err.find(name), std::string::npos) << gone.err;
    }
}

// Within some decimetres of the point their distances are below the snap, and how many of them are
// one there is rounding's to say: GEOS has other lengths, and both are right.
TEST(VerifySite, WallsThatCrossInOnePointHold) {
    const Scratch scratch;
    Features walls;
    for (int k = 0; k < 400; ++k) {
        const double angle = M_PI * k / 400;
        const double r = 10 + k * 37 % 41;
        const double x = r * std::cos(angle);
        const double y = r * std::sin(angle);
        walls.push_back(
            {"wall", "LineString", fmt::format("[[{:.3f},{:.3f}],[{:.3f},{:.3f}]]", x, y, -x, -y)});
    }
    scratch.write("site.geojson", geojson(walls));
    const std::string job = scratch.write(
        "job.toml",
        "preset = \"outdoor\"\n[site]\ninput = \"site.geojson\"\n[field]\ncell_m = 1\n[scanner]\n"
        "range_max_m = 40\n[plan]\nmethod = \"greedy\"\ncandidates = \"axis\"\n[output]\n"
        "formats = [\"csv\"]\n");
    vfplan_expect(0, {"run", job, "--out", scratch / "run", "--quiet"});
    expect_words(vfplan_expect(0, {"verify", scratch / "run"}).out,
                 {"site read again with GEOS", "yes: the plan holds"});
}

}  // namespace
}  // namespace vfplan::test
