// The formats that people have, through the program.
#include <bit>
#include <cstdio>
#include <map>

#include "program.h"

namespace vfplan::test {
namespace {

constexpr const char* quick = "visibility.kernel=exact";

Output read_only(const Path& input, std::vector<std::string> sets,
                 const char* config = "town.toml") {
    sets.insert(sets.end(), {"site.input=" + input.string(), quick});
    return vfplan_expect(0, with_sets({"run", config_file(config), "--dry-run"}, sets));
}

Json planned(const Scratch& scratch, const Path& input, std::vector<std::string> sets,
             const char* config = "town.toml", const char* out = "run") {
    sets.insert(sets.end(),
                {"site.input=" + input.string(), quick, "output.formats=['csv','geojson']"});
    vfplan_expect(0,
                  with_sets({"run", config_file(config), "--out", scratch / out, "--quiet"}, sets));
    vfplan_expect(0, {"verify", scratch / out});
    return read_json(Path(scratch / out) / "summary.json");
}

TEST(Formats, OsmXml) {
    VFPLAN_NEED_DATA("town_bellevue/raw/sample-bellevue.osm");
    const Output o =
        read_only(data_file("town_bellevue/raw/sample-bellevue.osm"), {"field.cell_m=8"});
    EXPECT_NE(o.out.find("pieces"), std::string::npos) << o.out;
}

TEST(Formats, OsmXmlGzip) {
    VFPLAN_NEED_DATA("city_allegheny/raw/42003409000.osm.gz");
    read_only(data_file("city_allegheny/raw/42003409000.osm.gz"),
              {"field.cell_m=8", "site.invalid=repair"});
}

// A corner of the town, cropped in metres of the UTM zone that OSM data are projected to.
TEST(Formats, OsmPbfCropped) {
    VFPLAN_NEED_DATA("town_karhula/raw/test.osm.pbf");
    const Scratch scratch;
    const Json s = planned(
        scratch, data_file("town_karhula/raw/test.osm.pbf"),
        {"field.cell_m=4", "site.invalid=repair", "site.crop_m=[497000,6710300,497400,6710700]"});
    EXPECT_GT(s["site"]["buildings"], 10);
    EXPECT_LT(s["site"]["buildings"], 300);
    EXPECT_GT(s["site"]["cleaning"]["outside_crop"], 1000);
    for (const double x : read_csv(scratch / "run/stations.csv").numbers("x")) {
        EXPECT_GT(x, 496900);
        EXPECT_LT(x, 497500);
    }
}

// The extract's own GeoJSON has the projected coordinates minus an origin: equal buildings.
TEST(Formats, GeoPackageLayer) {
    VFPLAN_NEED_DATA("town_bubenec/raw/bubenec.gpkg");
    VFPLAN_NEED_DATA("town_bubenec/bubenec_full.geojson");
    const Scratch scratch;
    const Json gpkg = planned(scratch, data_file("town_bubenec/raw/bubenec.gpkg"),
                              {"field.cell_m=4", "site.layer=buildings", "site.crs=utm"});
    const Json json = planned(scratch, data_file("town_bubenec/bubenec_full.geojson"),
                              {"field.cell_m=4"}, "town.toml", "json");
    EXPECT_EQ(gpkg["site"]["buildings"], json["site"]["buildings"]);
    EXPECT_NEAR(gpkg["site"]["area_m2"].get<double>(), json["site"]["area_m2"].get<double>(),
                0.002 * json["site"]["area_m2"].get<double>());
}

TEST(Formats, DxfInInches) {
    VFPLAN_NEED_DATA("plan_house_overland/raw/floorplan.dxf");
    const Scratch scratch;
    const Json s = planned(scratch, data_file("plan_house_overland/raw/floorplan.dxf"),
                           {"field.cell_m=0.1", "site.unit_m=0.0254"}, "office.toml");
    EXPECT_NEAR(s["site"]["width_m"].get<double>(), 20, 2);
    EXPECT_NEAR(s["site"]["height_m"].get<double>(), 14, 2);
}

// One plan drawn in four units gives one plan of stations, and a question when it does not say
// which.
TEST(Formats, DxfInEveryUnit) {
    const auto drawing = [](double per_m, int insunits) {
        std::string out = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n";
        if (insunits >= 0) out += "9\n$INSUNITS\n70\n" + std::to_string(insunits) + "\n";
        out += "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
        const std::vector<std::vector<double>> walls = {
            {0, 0, 8, 0}, {8, 0, 8, 6}, {8, 6, 0, 6}, {0, 6, 0, 0}, {3, 0, 3, 4}};
        for (const auto& w : walls) {
            out += "0\nLINE\n8\nWALL\n";
            const int codes[] = {10, 20, 11, 21};
            for (std::size_t i = 0; i < 4; ++i) {
                char value[64];
                std::snprintf(value, sizeof value, "%.12f", w[i] * per_m);
                out += std::to_string(codes[i]) + "\n" + value + "\n";
            }
        }
        return out + "0\nENDSEC\n0\nEOF\n";
    };
    const Scratch scratch;
    std::string metres;
    const std::map<int, double> per_m = {{6, 1}, {5, 100}, {4, 1000}, {1, 1 / 0.0254}};
    for (const auto& [insunits, scale] : per_m) {
        const std::string name = std::to_string(insunits) + "_units";
        planned(scratch, scratch.write(name + ".dxf", drawing(scale, insunits)),
                {"field.cell_m=0.1"}, "office.toml", name.c_str());
        const std::string stations = read_bytes(scratch / (name + "/stations.csv"));
        if (metres.empty()) metres = stations;
        EXPECT_EQ(stations, metres) << insunits;
        const Output o =
            vfplan_process({"run", scratch.write(name + "s.dxf", drawing(scale, -1)), "--dry-run"});
        if (insunits == 6) {
            EXPECT_EQ(o.code, 0) << o.err;
        } else {
            EXPECT_EQ(o.code, 3);
            EXPECT_NE(o.err.find("set site.unit_m"), std::string::npos) << o.err;
        }
    }
}

// Tables of a robot's map are those of its image, too.
TEST(Formats, AnotherImageIsAnotherJob) {
    const Scratch scratch;
    const auto image = [](int wall) {
        std::string out = "P5\n100 80\n255\n";
        for (int y = 0; y < 80; ++y) {
            for (int x = 0; x < 100; ++x) {
                const bool edge = x < 4 || y < 4 || x >= 96 || y >= 76;
                out += edge || (x >= wall && x < wall + 4 && y < 50) ? '\x00' : '\xFE';
            }
        }
        return out;
    };
    scratch.write("map.pgm", image(40));
    const std::string yaml =
        scratch.write("map.yaml", "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n");
    const Words run = {"run", yaml, "--out", scratch / "run", "--set", "field.cell_m=0.1"};
    vfplan_expect(0, run);
    const std::string first = read_bytes(scratch / "run/stations.csv");
    vfplan_expect(0, run);
    scratch.write("map.pgm", image(60));
    const Output other = vfplan_process(run);
    EXPECT_NE(other.code, 0) << "old tables were taken for the new image: " << other.out;
    Words fresh = run;
    fresh.push_back("--fresh");
    vfplan_expect(0, fresh);
    EXPECT_NE(read_bytes(scratch / "run/stations.csv"), first);
}

// Everything in the data sets' raw folders, and the art galleries, is understood.
TEST(Formats, EveryRawFileIsInspected) {
    VFPLAN_NEED_DATA("town_delft/raw");
    const Scratch scratch;
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(data_dir())) {
        const Path& file = entry.path();
        if (!entry.is_regular_file()) continue;
        if (file.parent_path().filename() != "raw" && file.extension() != ".pol") continue;
        std::vector<std::string> sets;
        if (file.filename() == "floorplan.dxf") sets = {"site.unit_m=0.0254"};
        if (file.filename() == "bubenec.gpkg") sets = {"site.layer=buildings", "site.crs=utm"};
        if (file.extension() == ".pol") sets = {"site.unit_m=20"};
        const Output o =
            vfplan_process(with_sets({"inspect", file, "--out", scratch / "site.png"}, sets));
        EXPECT_EQ(o.code, 0) << file << ": " << o.err;
        EXPECT_NE(o.out.find("m of faces to scan"), std::string::npos) << file << ": " << o.out;
        ++files;
    }
    EXPECT_EQ(files, 35 + 49);
}

TEST(Formats, GeoJsonGzip) {
    if (run_program("gzip", {"--version"}).code != 0) GTEST_SKIP() << "no gzip here";
    const Scratch scratch;
    const std::string plain = generated(scratch, "town");
    planned(scratch, plain, {"field.cell_m=8", "site.crop_m=[0,0,300,200]"}, "town.toml", "plain");
    ASSERT_EQ(run_program("gzip", {plain}).code, 0);
    planned(scratch, plain + ".gz", {"field.cell_m=8", "site.crop_m=[0,0,300,200]"}, "town.toml",
            "gzip");
    EXPECT_EQ(read_bytes(scratch / "plain/stations.csv"),
              read_bytes(scratch / "gzip/stations.csv"));
}

// --- Shapefile: main file and index, as in its specification
// --------------------------------------

template <class T>
void put(std::string& to, T value, bool big = false) {
    auto* from = reinterpret_cast<const char*>(&value);
    std::string bytes(from, sizeof value);
    if (big != (std::endian::native == std::endian::big))
        bytes.assign(bytes.rbegin(), bytes.rend());
    to += bytes;
}

std::string header(std::size_t bytes, const std::vector<double>& box) {
    std::string h;
    put<std::int32_t>(h, 9994, true);
    for (int i = 0; i < 5; ++i) put<std::int32_t>(h, 0, true);
    put<std::int32_t>(h, static_cast<std::int32_t>((bytes + 100) / 2), true);
    put<std::int32_t>(h, 1000);
    put<std::int32_t>(h, 5);  // polygons
    for (const double v : box) put(h, v);
    for (int i = 0; i < 4; ++i) put(h, 0.0);
    return h;
}

void write_shapefile(const Scratch& scratch, const std::string& name, const Json& geojson) {
    const std::vector<double> box = {0, 0, 2000, 2000};
    std::string records;
    std::string index;
    std::int32_t number = 0;
    for (const Json& feature : geojson["features"]) {
        const Json& ring = feature["geometry"]["coordinates"][0];
        std::string r;
        put<std::int32_t>(r, 5);
        for (const double v : box) put(r, v);
        put<std::int32_t>(r, 1);
        put(r, static_cast<std::int32_t>(ring.size()));
        put<std::int32_t>(r, 0);
        for (auto p = ring.rbegin(); p != ring.rend(); ++p) {  // outer rings run clockwise
            put(r, (*p)[0].get<double>());
            put(r, (*p)[1].get<double>());
        }
        put(index, static_cast<std::int32_t>((100 + records.size()) / 2), true);
        put(index, static_cast<std::int32_t>(r.size() / 2), true);
        put(records, ++number, true);
        put(records, static_cast<std::int32_t>(r.size() / 2), true);
        records += r;
    }
    scratch.write(name + ".shp", header(records.size(), box) + records);
    scratch.write(name + ".shx", header(index.size(), box) + index);
}

TEST(Formats, Shapefile) {
    const Scratch scratch;
    const std::string plain = generated(scratch, "town");
    write_shapefile(scratch, "town", read_json(plain));
    const std::vector<std::string> sets = {"field.cell_m=8", "site.crop_m=[0,0,300,200]"};
    const Json a = planned(scratch, plain, sets, "town.toml", "json");
    const Json b = planned(scratch, scratch / "town.shp", sets, "town.toml", "shape");
    EXPECT_EQ(a["site"]["buildings"], b["site"]["buildings"]);
    EXPECT_EQ(read_bytes(scratch / "json/stations.csv"),
              read_bytes(scratch / "shape/stations.csv"));
}

}  // namespace
}  // namespace vfplan::test
