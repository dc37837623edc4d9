// Any bytes as a site's file, outdoors and indoors: a clean site or an Error. Formats are told by
// content, so the bytes are the file; only Shapefiles and maps of robots get the name and the
// sibling that they are nothing without.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "io/formats/read_features.h"
#include "io/site/site_reader.h"
#include "io/temporary_folder.h"
#include "kernels/error.h"

namespace {

using namespace vfplan;

void write(const std::filesystem::path& file, std::string_view bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// The file to read, after all were written.
std::filesystem::path written(const std::filesystem::path& folder, std::string_view bytes) {
    constexpr std::string_view map = "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n";
    constexpr std::string_view image = "P5\n4 4\n255\n\0\0\0\0\0\xfe\xfe\0\0\xfe\xfe\0\0\0\0\0";
    const auto begins = [&](std::string_view with) { return bytes.substr(0, with.size()) == with; };
    if (begins("P5") || begins("P2") || begins("BM") || begins("\x89PNG") || begins("GIF8") ||
        begins("II*") || begins("\xff\xd8\xff")) {
        write(folder / "map.pgm", bytes);
        write(folder / "map.yaml", map);
        return folder / "map.yaml";
    }
    if (bytes.find("image:") != std::string_view::npos) {
        write(folder / "map.pgm", image);
        write(folder / "map.yaml", bytes);
        return folder / "map.yaml";
    }
    if (begins("<")) {  // GDAL tells some by their endings
        write(folder / "site.gml", bytes);
        return folder / "site.gml";
    }
    if (begins("WKT")) {
        write(folder / "site.csv", bytes);
        return folder / "site.csv";
    }
    if (begins("SQLite")) {
        write(folder / "site.gpkg", bytes);
        return folder / "site.gpkg";
    }
    write(folder / "site.dat", bytes);
    return folder / "site.dat";
}

void read(const std::filesystem::path& file, SiteKind kind) {
    SiteOptions options;
    options.kind = kind;
    if (kind == SiteKind::outdoor) {
        options.crs = "utm";
        options.invalid = InvalidPolygons::repair;
        options.osm_parts = options.osm_barriers = true;
    }
    try {
        FeatureSet set;
        try {
            set = read_features(file, options);
        } catch (const InputError&) {
            options.crs.clear();  // metres perhaps
            set = read_features(file, options);
        }
        build_site(std::move(set), options, file.string());
    } catch (const Error&) {  // what bad input ends with; all else is a finding
    }
}

}  // namespace

// Called by libFuzzer for each input.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const TemporaryFolder folder("fuzz");
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    const std::filesystem::path file = written(folder.path(), bytes);
    read(file, SiteKind::outdoor);
    read(file, SiteKind::indoor);
    return 0;
}
