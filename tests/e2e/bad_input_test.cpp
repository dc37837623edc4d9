// What the program says to bad input: the right exit code, the problem, its cause, what to do, and
// nothing left behind.
#include <algorithm>

#include "program.h"

namespace vfplan::test {
namespace {

// One GeoJSON feature of `type` with `coordinates`.
std::string feature(const std::string& type, const std::string& coordinates) {
    return R"({"type":"Feature","properties":{"class":"building"},"geometry":{"type":")" + type +
           R"(","coordinates":)" + coordinates + "}}";
}

std::string collection(const std::vector<std::string>& features) {
    std::string text = R"({"type":"FeatureCollection","features":[)";
    for (std::size_t i = 0; i < features.size(); ++i) text += (i > 0 ? "," : "") + features[i];
    return text + "]}";
}

std::string polygon(const std::string& rings) { return feature("Polygon", rings); }

const std::string square = "[[[0,0],[10,0],[10,10],[0,10],[0,0]]]";
const std::string far_square = "[[[30,0],[40,0],[40,10],[30,10],[30,0]]]";
const std::string good_job =
    "[site]\ninput = \"site.geojson\"\n[field]\ncell_m = 1\n"
    "[visibility]\nkernel = \"exact\"\n";

std::string layer(const std::string& name) {
    return "<Folder><name>" + name +
           "</name><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>0,0 10,0 10,10 "
           "0,10 0,0</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Folder>";
}

class BadInput : public ::testing::Test {
protected:
    // Runs `job` on `site`; expects the exit code, every word on standard error, no word on
    // standard output, and no new file.
    void expect(int code, const std::vector<std::string>& words, const std::string& job,
                const std::string& site, const std::vector<std::string>& sets = {}) {
        scratch.write("site.geojson", site);
        scratch.write("job.toml", job);
        expect_words(code, words,
                     with_sets({"run", scratch / "job.toml", "--out", scratch / "out"}, sets));
    }

    void expect_words(int code, const std::vector<std::string>& words, const Words& command) {
        const auto before = scratch.names();
        const Output o = vfplan_process(command);
        EXPECT_EQ(o.code, code) << o.out << o.err;
        for (const std::string& w : words) {
            EXPECT_NE(o.err.find(w), std::string::npos) << "no \"" << w << "\" in: " << o.err;
        }
        EXPECT_EQ(o.out, "");
        EXPECT_EQ(o.err.rfind("vfplan: ", 0) == 0 || o.err.find("\nvfplan: ") != std::string::npos,
                  true)
            << o.err;
        for (const char* never : {"this is a bug", "terminate called", "0x"}) {
            EXPECT_EQ(o.err.find(never), std::string::npos) << o.err;
        }
        EXPECT_EQ(scratch.names(), before) << o.err;
    }

    void expect_usage(const std::vector<std::string>& words, const std::string& job) {
        expect(2, words, job, collection({polygon(square)}));
    }

    void expect_site(const std::vector<std::string>& words, const std::vector<std::string>& made) {
        expect(3, words, good_job, collection(made));
    }

    Scratch scratch;
};

TEST_F(BadInput, GoodJobRuns) {
    scratch.write("site.geojson", collection({polygon(square), polygon(far_square)}));
    scratch.write("job.toml", good_job);
    vfplan_expect(0, {"run", scratch / "job.toml", "--out", scratch / "out"});
}

TEST_F(BadInput, CommandLine) {
    expect_words(2, {"--help"}, {});
    expect_words(2, {"--help", "fly"}, {"fly"});
    expect_words(2, {"--help", "JOB"}, {"run"});
    expect_words(2, {"no such job file", "nowhere.toml", "configs/"}, {"run", "nowhere.toml"});
    scratch.write("job.toml", good_job);
    expect_words(2, {"--set field.cell_m", "section.key=value"},
                 {"run", scratch / "job.toml", "--set", "field.cell_m"});
    expect_words(2, {"--threads"}, {"run", scratch / "job.toml", "--threads", "0"});
    expect_words(2, {"village", "town"}, {"generate", "village"});
    expect_words(4, {"/proc/none/town.geojson"},
                 {"generate", "town", "--out", "/proc/none/town.geojson"});
}

TEST_F(BadInput, JobFile) {
    expect_usage({"job.toml:2:"}, "[site]\ninput = \n");
    expect_usage({"field.cell", "job.toml:4:", "did you mean field.cell_m?"},
                 "[site]\ninput = \"site.geojson\"\n[field]\ncell = 2\n");
    expect_usage({"scaner", "job.toml:3:", "did you mean scanner"},
                 "[site]\ninput = \"site.geojson\"\n[scaner]\nrange_max_m = 2\n");
    expect_usage({"field.cell_m", "two", "a number", "job.toml:4:"},
                 "[site]\ninput = \"site.geojson\"\n[field]\ncell_m = \"two\"\n");
    expect_usage({"scanner.range_max_m", "-3", "job.toml:4:"},
                 "[site]\ninput = \"site.geojson\"\n[scanner]\nrange_max_m = -3\n");
    expect_usage({"field.cell_m", "0", "job.toml:4:"},
                 "[site]\ninput = \"site.geojson\"\n[field]\ncell_m = 0\n");
    expect_usage({"field.cell_m", "nan", "job.toml:4:"},
                 "[site]\ninput = \"site.geojson\"\n[field]\ncell_m = nan\n");
    expect_usage({"plan.method", "job.toml:4:", "refined"},
                 "[site]\ninput = \"site.geojson\"\n[plan]\nmethod = \"quick\"\n");
    expect_usage({"job.toml", "range_min_m", "range_max_m"},
                 "[site]\ninput = \"site.geojson\"\n[scanner]\nrange_min_m = 9\nrange_max_m = 9\n");
    expect_usage({"job.toml", "crop_m", "x0, y0, x1, y1"},
                 "[site]\ninput = \"site.geojson\"\ncrop_m = [0, 0, 5]\n");
    expect_usage({"job.toml", "site.input", "missing"}, "[field]\ncell_m = 1\n");
    expect_usage({"job.toml"}, "");
}

TEST_F(BadInput, SetSaysWhereItCameFrom) {
    const std::string site = collection({polygon(square)});
    expect(2, {"field.cell_m", "--set", "-1"}, good_job, site, {"field.cell_m=-1"});
    expect(2, {"fields.cell_m", "--set", "did you mean field.cell_m?"}, good_job, site,
           {"fields.cell_m=1"});
    expect(4, {"gone.geojson", "no such file", "site.input"}, good_job, site,
           {"site.input=gone.geojson"});
}

TEST_F(BadInput, SiteFile) {
    expect(4, {"nowhere.geojson", "no such file", "site.input"},
           "[site]\ninput = \"nowhere.geojson\"\n", "");
    expect(3, {"site.geojson", "empty"}, good_job, "");
    expect(3, {"site.geojson", "not a site that can be read", "GeoJSON"}, good_job,
           "Dear reader,\n");
    expect(3, {"site.geojson:1:", "ends in the middle"}, good_job,
           R"({"type":"FeatureCollection","feat)");
    expect(3, {"site.geojson"}, good_job, collection({}));
    const std::string folder = scratch / "folder";
    std::filesystem::create_directory(folder);
    expect(3, {"folder"}, good_job, "", {"site.input=" + folder});
    expect(3, {"site.geojson", "no layer 'roofs'"}, good_job, collection({polygon(square)}),
           {"site.layer=roofs"});
}

TEST_F(BadInput, SeveralLayers) {
    scratch.write(
        "site.kml",
        "<?xml version=\"1.0\"?><kml xmlns=\"http://www.opengis.net/kml/2.2\"><Document>" +
            layer("houses") + layer("sheds") + "</Document></kml>");
    expect(3, {"site.kml", "2 layers", "site.layer", "houses", "sheds"}, good_job, "",
           {"site.input=" + scratch / "site.kml"});
}

TEST_F(BadInput, Geometry) {
    expect_site({"site.geojson", "no building polygons"},
                {feature("Point", "[3,4]"), feature("Point", "[5,4]")});
    expect_site({"degrees", "site.crs = \"utm\""},
                {polygon("[[[26.93,60.52],[26.9302,60.52],[26.9302,60.5201],[26.93,60.5201],"
                         "[26.93,60.52]]]")});
    expect_site({"feature 2", "no number"},
                {polygon(square), polygon("[[[0,20],[10,NaN],[10,30],[0,30],[0,20]]]")});
    const Words strict = {"site.invalid=error"};
    expect(3, {"feature 2", "5", "15", "site.invalid"}, good_job,
           collection({polygon(far_square), polygon("[[[0,10],[10,20],[10,10],[0,20],[0,10]]]")}),
           strict);
    expect(3, {"feature 2", "site.invalid"}, good_job,
           collection({polygon(far_square), polygon("[[[0,0],[10,0],[10,10],[0,10],[0,0]],"
                                                    "[[20,2],[22,2],[22,4],[20,4],[20,2]]]")}),
           strict);
    expect_site({"feature 1", "1e+300"}, {polygon("[[[0,0],[1e300,0],[1e300,10],[0,10],[0,0]]]")});
}

TEST_F(BadInput, SizesThatDoNotFit) {
    const std::string site = collection({polygon(square), polygon(far_square)});
    expect(2, {"field.cell_m", "5000", "larger than the site"}, good_job, site,
           {"field.cell_m=5000"});
    expect(2, {"field.cell_m", "1.8e+15 cells", "crop_m"}, good_job, site, {"field.cell_m=1e-6"});
    expect(2, {"coverage.partition_m", "pieces of wall", "crop_m"}, good_job, site,
           {"coverage.partition_m=1e-9"});
    expect(3, {"crop_m"}, good_job, site, {"site.crop_m=[500,500,600,600]"});
}

// What shows only after the site was read leaves nothing behind either, and once the job is
// corrected it runs in the same folder. What shows only after the field was made leaves that.
TEST_F(BadInput, LateErrorsDoNotSpoilTheFolder) {
    const std::string site = collection({polygon(square), polygon(far_square)});
    expect(2, {"plan.required", "(5, 5)"}, good_job, site, {"plan.required=[[5,5]]"});
    vfplan_process({"run", scratch / "job.toml", "--out", scratch / "again", "--set",
                    "plan.required=[[5,5]]"});
    vfplan_expect(0, {"run", scratch / "job.toml", "--out", scratch / "again", "--set",
                      "plan.required=[[15,5]]"});
    const Words blind = {"run",   scratch / "job.toml",     "--out", scratch / "blind",
                         "--set", "field.threshold_rad=6.2"};
    const Output late = vfplan_expect(2, blind);
    EXPECT_NE(late.err.find("field.threshold_rad = 6.2"), std::string::npos) << late.err;
    expect_words(2, {"field.threshold_rad"}, blind);  // nor does it become more
    vfplan_expect(0, {"run", scratch / "job.toml", "--out", scratch / "blind", "--fresh"});
    vfplan_expect(0, {"run", scratch / "job.toml", "--out", scratch / "seeing"});
    expect_same_run(scratch / "blind", scratch / "seeing");
}

TEST_F(BadInput, OutputFolder) {
    scratch.write("site.geojson", collection({polygon(square), polygon(far_square)}));
    const std::string job = scratch.write("job.toml", good_job);
    const std::string file = scratch.write("file", "");
    expect_words(4, {file, "--out"}, {"run", job, "--out", file});
    expect_words(4, {file + "/below", "--out"}, {"run", job, "--out", file + "/below"});
    expect_words(4, {"/proc/none/run", "--out"}, {"run", job, "--out", "/proc/none/run"});
    std::filesystem::create_directory(scratch / "mine");
    scratch.write("mine/letter.txt", "Dear reader,\n");
    expect_words(2, {scratch / "mine", "--out"}, {"run", job, "--out", scratch / "mine"});
    // Nor does --fresh remove what is no run.
    expect_words(2, {scratch / "mine", "--out"},
                 {"run", job, "--out", scratch / "mine", "--fresh"});
}

TEST_F(BadInput, AnotherJobsRun) {
    scratch.write("site.geojson", collection({polygon(square), polygon(far_square)}));
    const std::string job = scratch.write("job.toml", good_job);
    vfplan_expect(0, {"run", job, "--out", scratch / "one", "--quiet"});
    vfplan_expect(0, {"run", job, "--out", scratch / "two", "--quiet", "--set", "field.cell_m=2"});
    const auto hash = [&](const std::string& dir) {
        const std::string text = read_bytes(Path(scratch / dir) / "job.toml");
        return text.substr(text.find("# job ") + 6, 16);
    };
    expect_words(2, {scratch / "one", hash("one"), hash("two"), "--out", "--fresh"},
                 {"run", job, "--out", scratch / "one", "--set", "field.cell_m=2"});
    vfplan_expect(0, {"verify", scratch / "one"});
    vfplan_expect(
        0, {"run", job, "--out", scratch / "one", "--quiet", "--fresh", "--set", "field.cell_m=2"});
    EXPECT_EQ(read_json(scratch / "one/summary.json")["result_sha256"],
              read_json(scratch / "two/summary.json")["result_sha256"]);

    // The same path, another site in it.
    scratch.write("site.geojson", collection({polygon(square)}));
    expect_words(2, {scratch / "one", "--fresh"},
                 {"run", job, "--out", scratch / "one", "--set", "field.cell_m=2"});
}

TEST_F(BadInput, NoRunThere) {
    std::filesystem::create_directory(scratch / "empty");
    for (const std::string command : {"plan", "verify"}) {
        expect_words(4, {scratch / "nowhere"}, {command, scratch / "nowhere"});
        expect_words(4, {scratch / "empty"}, {command, scratch / "empty"});
        expect_words(2, {"DIR", "--help"}, {command});
    }
    scratch.write("site.geojson", collection({polygon(square), polygon(far_square)}));
    const std::string job = scratch.write("job.toml", good_job);
    vfplan_expect(0, {"precompute", job, "--out", scratch / "tables", "--quiet"});
    // Tables are there, a plan is not: what to do is `plan`.
    expect_words(4, {"plan.h5", "vfplan plan"}, {"verify", scratch / "tables"});
}

}  // namespace
}  // namespace vfplan::test
