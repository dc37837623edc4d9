// A job's parameters: defaults, reading, writing, messages, hashes.
#include "engine/config/config.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "engine/config/parameters.h"
#include "engine/folder/run_dir.h"
#include "io/files.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Sets = std::vector<std::string>;

Config read(const std::string& text, const Sets& sets = {}) {
    return parse_config("site.input = \"town.geojson\"\n" + text, "job.toml", "/jobs/one", sets);
}

// The message of the error that reading `text` (from line 2 on) gives; empty for none.
std::string message(const std::string& text, const Sets& sets = {}) {
    try {
        read(text, sets);
    } catch (const UsageError& e) {
        return e.what();
    }
    return "";
}

void expect_words(const std::string& said, const Sets& words) {
    for (const std::string& w : words) {
        EXPECT_NE(said.find(w), std::string::npos) << "no \"" << w << "\" in: " << said;
    }
}

// A job in which every parameter differs from its default.
Config unusual() {
    return parse_config(
        "preset = 'indoor'\n"
        "[site]\ninput = 'town.geojson'\nlayer = \"walls, \\\"new\\\" \\\\ \\t \\u00e4\"\nkind = "
        "'outdoor'\n"
        "crop_m = [-1.5, 2, 3e5, 4.25]\ndoors = 'closed'\nwindows = 'opening'\ncrs = "
        "'utm'\nallow_network = true\n"
        "where = 'x > 3'\nroles = { 'A-*' = 'wall', 'B?' = 'ignored' }\nosm_parts = "
        "true\nosm_barriers = true\n"
        "unit_m = 0.0254\nsnap_m = 0.002\nmargin_m = 7\nclearance_m = 0.3\ninvalid = 'drop'\n"
        "max_opening_m = 1.5\nmin_width_m = 0.4\nmin_room_m2 = 2\nmax_gap_m2 = 3\n"
        "[scanner]\nrange_min_m = 0.1\nrange_max_m = 33.3\nmax_incidence_deg = 71\n"
        "[visibility]\nkernel = 'embree'\nrays = 64\n[field]\ncell_m = 0.07\nthreshold_rad = 0.3\n"
        "tile_cells = 128\n"
        "[coverage]\npartition_m = 0.333\nvisible_fraction = 0.7\n"
        "[overlap]\nratio = 'union_ang'\nthreshold = 0.15\n"
        "[plan]\nmethod = 'greedy'\ncandidates = 'axis'\npool_tried = 3\npool_taken = "
        "4\nmin_spacing_m = 5\nsurvive = 1\nshortcuts = 0.5\nloops = "
        "false\neffort = 7\nproof_effort = 9\n"
        "required = [[1, 2.5], [3, -4]]\nforbidden = 'no/go.geojson'\nexisting = [[5e6, 0.1]]\n"
        "[output]\nformats = ['png']\npieces = 'uncovered'\nmap_px = 300\n",
        "job.toml", "/jobs/one", {});
}

TEST(Config, PresetsAreThePapersDefaults) {
    const Config out = read("");
    EXPECT_EQ(out.preset, Preset::outdoor);
    EXPECT_EQ(out.site.kind, SiteKind::outdoor);
    EXPECT_EQ(out.scanner.range_min_m, 1.2);
    EXPECT_EQ(out.scanner.range_max_m, 75);
    EXPECT_EQ(out.scanner.max_incidence_deg, 90);
    EXPECT_EQ(out.coverage.partition_m, 1);
    EXPECT_EQ(out.field.cell_m, 0.25);
    EXPECT_EQ(out.field.threshold_rad, 1);
    EXPECT_EQ(out.overlap.ratio, OverlapRatio::mean_len);
    EXPECT_EQ(out.overlap.threshold, 0.3);

    const Config in = read("preset = \"indoor\"\n");
    EXPECT_EQ(in.site.kind, SiteKind::indoor);
    EXPECT_EQ(in.scanner.range_min_m, 0.6);
    EXPECT_EQ(in.scanner.range_max_m, 30);
    EXPECT_EQ(in.coverage.partition_m, 0.1);
    EXPECT_EQ(in.field.cell_m, 0.02);
    EXPECT_EQ(in.overlap.ratio, OverlapRatio::mean_len);
    EXPECT_EQ(in.overlap.threshold, 0.4);
}

TEST(Config, PresetComesFirstWhereverItStands) {
    EXPECT_EQ(read("field.cell_m = 0.5\npreset = \"indoor\"\n").field.cell_m, 0.5);
    EXPECT_EQ(read("preset = \"indoor\"\nfield.cell_m = 0.5\n").scanner.range_max_m, 30);
    const Config set = read("preset = \"outdoor\"\nfield.cell_m = 0.5\n", {"preset=indoor"});
    EXPECT_EQ(set.preset, Preset::indoor);
    EXPECT_EQ(set.scanner.range_max_m, 30);
    EXPECT_EQ(set.field.cell_m, 0.5);
}

TEST(Config, SetWinsOverTheFile) {
    const std::string file = "[field]\ncell_m = 2\n[plan]\nloops = true\n";
    const Config c = read(file, {"field.cell_m=3", "plan.loops=false", "site.crs=EPSG:32617",
                                 "overlap.ratio=\"min_len\"", "output.formats=[\"csv\"]",
                                 "plan.required=[[1, 2]]", "field.cell_m=4"});
    EXPECT_EQ(c.field.cell_m, 4);  // the last one counts
    EXPECT_FALSE(c.plan.loops);
    EXPECT_EQ(c.site.crs, "EPSG:32617");
    EXPECT_EQ(c.overlap.ratio, OverlapRatio::min_len);
    EXPECT_EQ(c.output.formats, (Sets{"csv"}));
    ASSERT_EQ(c.plan.required.size(), 1U);
    EXPECT_EQ(c.plan.required[0], Vec2d(1, 2));
    expect_words(message("", {"field.cell_m"}), {"--set field.cell_m", "section.key=value"});
    expect_words(message("", {"=3"}), {"--set =3", "section.key=value"});
}

// The values of a configuration as texts, by key.
std::map<std::string, std::string> values_of(Config config) {
    std::map<std::string, std::string> out;
    for (const Parameter& p : parameters(config)) out[p.key()] = text_of(p.value);
    return out;
}

TEST(Config, EveryParameterSurvivesWritingAndReading) {
    const auto changed = values_of(unusual());
    for (const auto& [key, value] : values_of(Config())) {
        if (key == "site.kind") continue;  // unlike the preset's
        EXPECT_NE(changed.at(key), value) << key;
    }
    for (const Config& c : {unusual(), read(""), read("preset = \"indoor\"\n")}) {
        const Config again = parse_config(to_toml(c), "again.toml", "/elsewhere", {});
        EXPECT_EQ(values_of(again), values_of(c));
        EXPECT_EQ(to_toml(again), to_toml(c));
    }
}

TEST(Config, AnyTextSurvivesWritingAndReading) {
    std::string all;
    for (char c = 0x7f; c > 0; --c) all += c;
    for (const std::string& text :
         {std::string("a\n'''b"), std::string("'''"), std::string("a 'b' \"c\" \\"),
          std::string("\r\n\t\x7f"), std::string("\"\"\"\n\"\"\""), std::string("a\\\n\xc3\xa9'"),
          all}) {
        Config c = read("");
        c.site.layer = text;
        c.site.roles = {{text, Role::wall}};
        const Config again = parse_config(to_toml(c), "again.toml", "/elsewhere", {});
        EXPECT_EQ(again.site.layer, text);
        ASSERT_EQ(again.site.roles.size(), 1U);
        EXPECT_EQ(again.site.roles[0].pattern, text);
    }
}

TEST(Config, UnknownKeysSayWhereAndWhatWasMeant) {
    expect_words(message("[field]\ncel_m = 2\n"),
                 {"field.cel_m", "job.toml:3:1", "did you mean field.cell_m?"});
    expect_words(message("[scaner]\nrange_max_m = 2\n"),
                 {"scaner", "job.toml:2:", "did you mean scanner?"});
    expect_words(message("prset = \"indoor\"\n"), {"job.toml:2:1", "did you mean preset?"});
    expect_words(message("[field]\n   zyxwvutsrq = 2\n"), {"job.toml:3:4", "docs/parameters.md"});
    EXPECT_EQ(message("[field]\nzyxwvutsrq = 2\n").find("did you mean"), std::string::npos);
    expect_words(message("", {"fields.cell_m=2"}), {"(--set)", "did you mean field.cell_m?"});
    expect_words(message("field = 3\n"), {"job.toml:2:1", "[field]"});
}

TEST(Config, SyntaxErrorsSayWhere) {
    expect_words(message("[field]\ncell_m = \n"), {"job.toml:3:"});
    expect_words(message("[field]\ncell_m = 1\ncell_m = 2\n"), {"job.toml:4:"});
}

TEST(Config, WrongTypesSayWhatIsExpected) {
    for (const auto& [line, words] : std::vector<std::pair<std::string, Sets>>{
             {"field.cell_m = \"2\"", {"field.cell_m", "a number", "side of a grid cell"}},
             {"field.cell_m = true", {"a number"}},
             {"field.cell_m = nan", {"finite"}},
             {"field.cell_m = inf", {"finite"}},
             {"output.map_px = 800.0", {"a whole number"}},
             {"plan.loops = 1", {"true or false"}},
             {"site.layer = 3", {"text in quotes"}},
             {"site.crop_m = 3", {"a list"}},
             {"site.crop_m = [1, 2, \"c\", 4]", {"a number"}},
             {"plan.required = [1, 2]", {"[x, y]"}},
             {"plan.required = [[1, 2, 3]]", {"[x, y]"}},
             {"plan.existing = [[1, inf]]", {"finite"}},
             {"output.formats = \"png\"", {"a list"}},
             {"output.formats = [1]", {"a list of texts"}},
             {"output.formats = [\"png\", \"svg\"]", {"one of", "geojson", "gpkg, png"}},
             {"overlap.ratio = \"max_len\"", {"one of", "min_len", "mean_ang"}},
             {"preset = \"garden\"", {"one of: outdoor, indoor"}}}) {
        const std::string said = message("\n" + line + "\n");
        expect_words(said, words);
        expect_words(said, {"job.toml:3:"});
    }
}

TEST(Config, EveryRangeIsChecked) {
    Config defaults;
    for (const Parameter& p : parameters(defaults)) {
        if (p.limits.least <= -1e300) continue;
        const bool whole = std::holds_alternative<std::int64_t*>(p.value);
        const auto said = [&, key = p.key()](double v) {
            return message(key + (whole ? fmt::format(" = {}\n", static_cast<std::int64_t>(v))
                                        : fmt::format(" = {}\n", v)));
        };
        const std::string beyond = p.key() + " = ";
        expect_words(said(p.limits.least - 1), {beyond, "job.toml:2:", "must be"});
        expect_words(said(p.limits.most * 2), {beyond, "job.toml:2:", "at most"});
        EXPECT_EQ(said(p.limits.least).find("must be greater than") != std::string::npos,
                  p.limits.above_least)
            << p.key();
        EXPECT_EQ(said(p.limits.most).find("at most"), std::string::npos) << p.key();
    }
}

TEST(Config, ParametersMustFitEachOther) {
    expect_words(message("[scanner]\nrange_min_m = 75\n"), {"job.toml", "not below range_max_m"});
    for (const char* crop : {"[0, 0, 1]", "[0, 0, 0, 1]", "[0, 1, 1, 0]", "[0, 0, 1, 1, 2]"}) {
        expect_words(message(std::string("site.crop_m = ") + crop + "\n"), {"x0 < x1"});
    }
    for (const char* rays : {"8", "100", "1"}) {
        expect_words(message("", {std::string("visibility.rays=") + rays}), {"power of two"});
    }
    for (const char* side : {"66", "101"}) {
        expect_words(message("", {std::string("field.tile_cells=") + side}),
                     {side, "multiple of 4"});
    }
    EXPECT_EQ(message("visibility.rays = 16\n"), "");
    expect_words(message("plan.method = \"cleverest\"\n"), {"must be one of", "refined"});
    EXPECT_THROW(parse_config("", "job.toml", "/", {}), UsageError);
    EXPECT_THROW(read_config("/no/such/job.toml", {}), UsageError);
}

TEST(Config, PathsAreRelativeToTheFileThoseOfSetToTheFolder) {
    const Config c = unusual();
    EXPECT_EQ(c.site.input, "/jobs/one/town.geojson");
    EXPECT_EQ(c.plan.forbidden, "/jobs/one/no/go.geojson");
    EXPECT_EQ(read("").plan.forbidden, "");
    EXPECT_EQ(read("plan.forbidden = '/a/../b.geojson'\n").plan.forbidden, "/b.geojson");
    const Config set = read("", {"site.input=a.gpkg", "plan.forbidden=../b.gpkg"});
    const auto here = std::filesystem::current_path();
    EXPECT_EQ(set.site.input, (here / "a.gpkg").string());
    EXPECT_EQ(set.plan.forbidden, (here.parent_path() / "b.gpkg").string());
}

TEST(JobKeys, EachParameterChangesTheHashesOfItsStage) {
    const Config defaults = read("");
    const JobKeys keys = job_keys(defaults, "s");
    Config changed = unusual();
    changed.site.kind = SiteKind::indoor;
    for (const Parameter& p : parameters(changed)) {
        // One parameter that differs.
        const Config one =
            p.key() == "preset" ? defaults : read("", {p.key() + "=" + text_of(p.value)});
        const bool path = std::holds_alternative<std::filesystem::path*>(p.value);
        const bool counts = p.key() != "preset" && !path;
        const JobKeys now = job_keys(one, "s");
        EXPECT_EQ(now.tables != keys.tables, counts && p.stale == Stale::tables) << p.key();
        EXPECT_EQ(now.job != keys.job, counts && p.stale != Stale::output) << p.key();
        EXPECT_EQ(canonical(one, Stale::output) != canonical(defaults, Stale::output), counts)
            << p.key();
    }
    EXPECT_NE(job_keys(defaults, "t").tables, keys.tables);  // another site
    EXPECT_NE(job_keys(defaults, "t").job, keys.job);
    EXPECT_NE(keys.tables, keys.job);
}

TEST(JobKeys, OnlyWhatChangesTheResultCounts) {
    Config a = read("");
    const Config method = read("", {"plan.method=greedy"});
    EXPECT_EQ(job_keys(a, "").tables, job_keys(method, "").tables);
    EXPECT_NE(job_keys(a, "").job, job_keys(method, "").job);
    const Config output = read("", {"output.map_px=400", "site.input=/other/copy.geojson"});
    EXPECT_EQ(job_keys(a, "").job, job_keys(output, "").job);
    // A preset is its values.
    Config indoor = read("preset = \"indoor\"\n");
    indoor.preset = Preset::outdoor;
    EXPECT_EQ(job_keys(indoor, "").job, job_keys(read("preset = \"indoor\"\n"), "").job);
}

TEST(Parameters, TheirPageInTheTreeIsTheirList) {
    EXPECT_EQ(read_text(std::filesystem::path(VFPLAN_SOURCE_DIR) / "docs/parameters.md"),
              parameters_markdown());
}

}  // namespace
}  // namespace vfplan
