// The formats that people have: OSM, GeoPackage, DXF, Shapefile, gzip'd GeoJSON.
#include <bit>

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
