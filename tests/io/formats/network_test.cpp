// A site's file leads nowhere: neither to other machines nor to other files, unless it may.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/features/crs.h"
#include "io/features/reach.h"
#include "io/formats/gdal.h"
#include "io/sha256.h"
#include "tests/http_server.h"
#include "tests/io/formats/files.h"

namespace vfplan {
namespace {

using test::expect_words;
using test::HttpServer;
using test::TemporaryFolder;

const std::string houses =
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
    R"({"type":"Polygon","coordinates":[[[500000,6700000],[500010,6700000],[500010,6700010],)"
    R"([500000,6700000]]]}}]})";

std::string linked(const std::string& crs) {
    return "{\"type\":\"FeatureCollection\",\"crs\":" + crs + "," + houses.substr(1);
}

std::string virtual_file(const std::string& source, const std::string& layer = "site") {
    return fmt::format(
        "<OGRVRTDataSource><OGRVRTLayer name=\"site\"><SrcDataSource>{}</SrcDataSource>"
        "<SrcLayer>{}</SrcLayer><LayerSRS>EPSG:32635</LayerSRS></OGRVRTLayer></OGRVRTDataSource>",
        source, layer);
}

std::string gml(const std::string& before, const std::string& attribute) {
    return fmt::format(
        "<?xml version=\"1.0\"?>{}<ogr:FeatureCollection xmlns:ogr=\"http://ogr.maptools.org/\" "
        "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
        "xmlns:gml=\"http://www.opengis.net/gml\" {}><gml:featureMember><ogr:house fid=\"1\">"
        "<ogr:geometryProperty><gml:Polygon><gml:outerBoundaryIs><gml:LinearRing><gml:coordinates>"
        "0,0 10,0 10,10 0,0</gml:coordinates></gml:LinearRing></gml:outerBoundaryIs></gml:Polygon>"
        "</ogr:geometryProperty></ogr:house></gml:featureMember></ogr:FeatureCollection>",
        before, attribute);
}

class Network : public ::testing::Test {
protected:
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder.path() / name, std::ios::binary) << text;
        return (folder.path() / name).string();
    }

    // What reading says; empty when it reads.
    std::string says(const std::string& file, bool network, const std::string& crs = "") {
        ReadOptions options;
        options.allow_network = network;
        options.crs = crs;
        try {
            read_features(file, options);
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }

    // Closed, nothing is asked for and the message says what could be done; open, something is.
    void expect_closed(const std::string& file, const std::string& crs = "") {
        const int before = server.requests();
        expect_words(says(file, false, crs), {"site.allow_network = true"});
        EXPECT_EQ(server.requests(), before) << file;
        says(file, true, crs);
        EXPECT_GT(server.requests(), before) << file;
        const int then = server.requests();
        says(file, false, crs);  // and closed again
        EXPECT_EQ(server.requests(), then) << file;
    }

    TemporaryFolder folder{"network"};
    HttpServer server{{{"/site.geojson", houses}, {"/crs", "EPSG:32635"}}};
};

TEST_F(Network, AVirtualFileIsRefusedWhateverItsName) {
    expect_closed(write("a.geojson", virtual_file("/vsicurl/" + server.url() + "/site.geojson")));
    EXPECT_EQ(says((folder.path() / "a.geojson").string(), true), "");
}

TEST_F(Network, AServiceIsRefused) {
    expect_closed(write("a.geojson", fmt::format("<OGRWFSDataSource><URL>{}/wfs</URL>"
                                                 "</OGRWFSDataSource>",
                                                 server.url())));
}

TEST_F(Network, ACrsFromAnAddress) {
    const std::string site = write("a.geojson", houses);
    expect_words(says(site, false, server.url() + "/crs"), {"site.crs", server.url()});
    expect_closed(site, server.url() + "/crs");
}

TEST_F(Network, ACrsFromAFile) {
    const std::string site = write("a.geojson", houses);
    const std::string crs = write("crs.txt", wkt_of_code("EPSG:32635"));
    expect_words(says(site, false, crs), {"site.crs", crs, "site.allow_network = true"});
    EXPECT_EQ(says(site, true, crs), "");
}

TEST_F(Network, ACrsThatGeoJsonLinksTo) {
    for (const char* type : {"link", "url"}) {
        const std::string properties = fmt::format(
            R"({{"type":"{}","properties":{{"href":"{}/crs","url":"{}/crs","type":"ogcwkt"}}}})",
            type, server.url(), server.url());
        expect_closed(write(fmt::format("{}.geojson", type), linked(properties)));
    }
}

// Closed, a file is read without what it names, or refused; never is anything asked for.
TEST_F(Network, NothingElseIsAskedForEither) {
    const std::string url = server.url();
    const std::string crs = R"({{"type":"name","properties":{{"name":"{}"}}}})";
    const std::string cityjson =
        R"({{"type":"CityJSON","version":"2.0","metadata":{{"referenceSystem":"{}/crs"}},)"
        R"("transform":{{"scale":[1,1,1],"translate":[0,0,0]}},"CityObjects":{{}},"vertices":[]}})";
    const std::string schema = "xsi:schemaLocation=\"http://ogr.maptools.org/ {}\"";
    const std::string entity = "<!DOCTYPE a [<!ENTITY e SYSTEM \"{}/site.geojson\">]>";
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
             {"n.geojson", linked(fmt::format(fmt::runtime(crs), url + "/crs"))},
             {"c.json", fmt::format(fmt::runtime(cityjson), url)},
             {"s.gml", gml("", fmt::format(fmt::runtime(schema), url + "/a.xsd"))},
             {"v.gml", gml("", fmt::format(fmt::runtime(schema), "/vsicurl/" + url + "/a.xsd"))},
             {"t.gml",
              gml("", fmt::format(fmt::runtime(schema), "/vsicurl_streaming/" + url + "/a.xsd"))},
             {"d.gml", gml(fmt::format("<!DOCTYPE a SYSTEM \"{}/a.dtd\">", url), "")},
             {"e.gml", gml(fmt::format(fmt::runtime(entity), url), "")},
             {"x.gml", gml("", fmt::format("xlink:href=\"{}/site.geojson#a\"", url))},
             {"k.kml",
              fmt::format("<kml xmlns=\"http://www.opengis.net/kml/2.2\"><NetworkLink><Link><href>"
                          "{}/site.geojson</href></Link></NetworkLink></kml>",
                          url)}}) {
        says(write(name, text), false);
        EXPECT_EQ(server.requests(), 0) << name;
    }
}

TEST_F(Network, FileSystemsOfGdalAreClosed) {
    for (const char* prefix : {"/vsicurl/", "/vsicurl_streaming/"}) {
        const std::string name = prefix + server.url() + "/site.geojson";
        const int before = server.requests();
        EXPECT_FALSE(can_be_opened(name));
        EXPECT_EQ(server.requests(), before) << name;
        const Reach open(true);
        EXPECT_TRUE(can_be_opened(name));
        const Reach closed(false);  // the youngest counts
        EXPECT_FALSE(can_be_opened(name + "?"));
        EXPECT_NE(Reach::refused(), "");
    }
}

// Names of files, from the folder.
std::vector<std::string> names_of(const std::filesystem::path& input, bool network = false) {
    std::vector<std::string> out;
    for (const auto& f : input_files(input, network)) {
        out.push_back(f.string().starts_with("/vsi")
                          ? "/vsi"
                          : f.lexically_relative(input.parent_path()).string());
    }
    return out;
}

using Names = std::vector<std::string>;

TEST_F(Network, TheFilesOfASiteAreListed) {
    const std::string plain = write("a.geojson", houses);
    EXPECT_EQ(names_of(plain), Names{"a.geojson"});
    const std::string near = write("near.vrt", virtual_file(plain, "a"));
    EXPECT_EQ(names_of(near), Names{"near.vrt"});  // it is refused when it is read
    EXPECT_EQ(names_of(near, true), (Names{"a.geojson", "near.vrt"}));
    const std::string far =
        write("far.vrt", virtual_file("/vsicurl/" + server.url() + "/site.geojson"));
    const std::vector<std::filesystem::path> files = input_files(far, true);
    EXPECT_EQ(names_of(far, true), (Names{"far.vrt", "/vsi"}));
    const std::string hash = input_sha256(files);
    EXPECT_EQ(hash.size(), 64U);
    const std::string service =
        write("wfs.xml",
              fmt::format("<OGRWFSDataSource><URL>{}/wfs</URL></OGRWFSDataSource>", server.url()));
    EXPECT_THROW(input_files(service, true), InputError);
    EXPECT_THROW(input_files(folder.path() / "gone.geojson"), IoError);

    write("map.pgm", "P5\n1 1\n255\n0");
    const std::string map = write("map.yaml", "image: map.pgm\nresolution: 0.05\n");
    EXPECT_EQ(names_of(map), (Names{"map.pgm", "map.yaml"}));
}

// The first 100 bytes of a Shapefile or its index: of polygons, but there are none.
std::string empty_shapefile() {
    std::string out(100, '\0');
    out[2] = 0x27;  // 9994
    out[3] = 0x0a;
    out[27] = 50;                       // length in words of two bytes
    out[28] = static_cast<char>(0xe8);  // version 1000
    out[29] = 0x03;
    out[32] = 5;
    return out;
}

TEST_F(Network, SiblingsAndFoldersAreListed) {
    const std::filesystem::path sub = folder.path() / "sub";
    std::filesystem::create_directories(sub / "deeper");
    const std::string shape = write("sub/t.shp", empty_shapefile());
    write("sub/t.shx", empty_shapefile());
    write("sub/t.prj", wkt_of_code("EPSG:32635"));
    write("sub/notes.txt", "nothing of the site");
    EXPECT_EQ(names_of(shape), (Names{"t.prj", "t.shp", "t.shx"}));
    EXPECT_EQ(names_of(sub), (Names{"sub/t.prj", "sub/t.shp", "sub/t.shx"}));
    const std::string before = input_sha256(input_files(shape));
    write("sub/t.prj", wkt_of_code("EPSG:32634"));
    EXPECT_NE(input_sha256(input_files(shape)), before);

    std::filesystem::create_directories(folder.path() / "a.gdb/below");
    write("a.gdb/1.gdbtable", "");
    write("a.gdb/below/2", "");
    EXPECT_EQ(names_of(folder.path() / "a.gdb"), (Names{"a.gdb/1.gdbtable", "a.gdb/below/2"}));
}

TEST_F(Network, TheHashIsThatOfContents) {
    const std::string one = write("a.geojson", houses);
    const std::string hash = input_sha256(input_files(one));
    EXPECT_EQ(hash, sha256_of_file(one));
    // A site may be moved and renamed, and is the same.
    const TemporaryFolder other("network");
    std::filesystem::copy_file(one, other.path() / "b.geojson");
    EXPECT_EQ(input_sha256(input_files(other.path() / "b.geojson")), hash);
    write("a.geojson", houses + " ");
    EXPECT_NE(input_sha256(input_files(one)), hash);
}

}  // namespace
}  // namespace vfplan
