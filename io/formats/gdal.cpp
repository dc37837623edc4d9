#include "io/formats/gdal.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <new>

#include "io/features/reach.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

struct VsiCloser {
    void operator()(VSILFILE* f) const { VSIFCloseL(f); }
};
using VsiFile = std::unique_ptr<VSILFILE, VsiCloser>;

std::string read_head(const std::string& name) {
    constexpr std::size_t most = 65536;
    const VsiFile in(VSIFOpenL(name.c_str(), "rb"));
    std::string head(most, '\0');
    head.resize(in ? VSIFReadL(head.data(), 1, most, in.get()) : 0);
    return head;
}

std::string lower_ending(const std::string& name) {
    const auto dot = name.rfind('.');
    std::string out = dot == std::string::npos ? "" : name.substr(dot + 1);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

// The files in an archive, without folders and what systems put beside.
std::vector<std::string> entries_of(const std::string& archive) {
    std::vector<std::string> out;
    char** list = VSIReadDirRecursive(archive.c_str());
    for (int i = 0; list != nullptr && list[i] != nullptr; ++i) {
        const std::string entry = list[i];
        if (entry.empty() || entry.back() == '/' || entry.rfind("__MACOSX", 0) == 0) continue;
        out.push_back(entry);
    }
    CSLDestroy(list);
    return out;
}

std::string joined(const std::vector<std::string>& names) {
    constexpr std::size_t most = 10;
    std::string out;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
        out += (i > 0 ? ", " : "") + names[i];
    }
    return out + (names.size() > most ? ", ..." : "");
}

// The entry of a ZIP archive that is the site.
std::string site_in(const std::string& archive, const std::filesystem::path& file) {
    const std::vector<std::string> all = entries_of(archive);
    if (all.empty()) {
        throw InputError(fmt::format(
            "{}: a ZIP archive that is empty or damaged; pack or fetch it again", file.string()));
    }
    const auto ending = [&](const std::vector<std::string>& endings) {
        std::vector<std::string> out;
        for (const std::string& e : all) {
            const auto has = std::find(endings.begin(), endings.end(), lower_ending(e));
            if (has != endings.end()) out.push_back(e);
        }
        return out;
    };
    const auto folder_of = [](const std::string& e) {
        const auto slash = e.rfind('/');
        return slash == std::string::npos ? std::string() : e.substr(0, slash);
    };
    const std::vector<std::string> shapes = ending({"shp"});
    if (shapes.size() == 1) return archive + "/" + shapes[0];
    if (!shapes.empty() && std::all_of(shapes.begin(), shapes.end(), [&](const std::string& e) {
            return folder_of(e) == folder_of(shapes[0]);
        })) {
        const std::string folder = folder_of(shapes[0]);
        return folder.empty() ? archive : archive + "/" + folder;
    }
    for (const std::string& e : all) {
        if (e == "Home.xml") return archive + "/" + e;
    }
    if (std::find(all.begin(), all.end(), "Home") != all.end()) {
        throw InputError(
            fmt::format("{}: a home of Sweet Home 3D without a Home.xml, as versions before 5.3 "
                        "wrote it; open it in a newer one and save it again",
                        file.string()));
    }
    std::vector<std::string> sites = ending({"geojson", "json", "gpkg", "dxf", "osm", "pbf", "gml",
                                             "kml", "fgb", "xml", "pol", "yaml"});
    if (sites.empty()) sites = all;
    if (sites.size() > 1) {
        throw InputError(
            fmt::format("{}: several files in it could be the site ({}); unpack it "
                        "and give one of them",
                        file.string(), joined(sites)));
    }
    return archive + "/" + sites[0];
}

// Drivers that read the files they are given and what lies beside them, and nothing else.
constexpr std::array files_alone = {
    "GeoJSON",    "GeoJSONSeq", "TopoJSON", "ESRIJSON", "GPKG",         "ESRI Shapefile",
    "FlatGeobuf", "GML",        "LIBKML",   "KML",      "MapInfo File", "OpenFileGDB",
    "DXF",        "DGN",        "OSM",      "GPX",      "CSV"};
// Drivers whose files say where to look.
constexpr std::array elsewhere = {"OGR_VRT", "WFS"};
constexpr std::array<const char*, 8> images = {"PNG", "PNM",  "JPEG",  "BMP",
                                               "GIF", "WEBP", "GTiff", nullptr};

// Throws bad_alloc where GDAL was refused memory that a sound file would have been granted: what a
// damaged file asks for may be any number.
void fail_on_memory(const std::string& said) {
    const auto speaks_of = [&](const char* word) { return said.find(word) != std::string::npos; };
    if (CPLGetLastErrorNo() != CPLE_OutOfMemory && !speaks_of("memory") && !speaks_of("alloc")) {
        return;
    }
    constexpr std::size_t fair = std::size_t{256} << 20;
    void* volatile there = std::malloc(fair);
    if (there == nullptr) throw std::bad_alloc();
    std::free(there);
}

}  // namespace

void DatasetCloser::operator()(void* dataset) const { GDALClose(dataset); }

QuietGdal::QuietGdal() {
    CPLErrorReset();
    CPLPushErrorHandler(CPLQuietErrorHandler);
}
QuietGdal::~QuietGdal() { CPLPopErrorHandler(); }
// Without the place in GDAL's own sources.
std::string QuietGdal::last() {
    const std::string said = CPLGetLastErrorMsg();
    fail_on_memory(said);
    const auto source = said.find(".cpp, ");
    if (source == std::string::npos) return said;
    const auto end = said.find_first_of(":,", source + 6);
    const auto text = end == std::string::npos ? end : said.find_first_not_of(" :,", end);
    return text == std::string::npos ? said : said.substr(text);
}
bool QuietGdal::failed() { return CPLGetLastErrorType() >= CE_Failure; }

FileInMemory::FileInMemory(std::string text) : text_(std::move(text)) {
    static std::atomic<int> count = 0;
    name_ = fmt::format("/vsimem/vfplan-{}", ++count);
    VSIFCloseL(VSIFileFromMemBuffer(name_.c_str(), reinterpret_cast<GByte*>(text_.data()),
                                    text_.size(), FALSE));
}
FileInMemory::~FileInMemory() { VSIUnlink(name_.c_str()); }

void use_gdal() {
    static std::once_flag registered;
    std::call_once(registered, [] {
        close_the_network();
        GDALAllRegister();
        CPLSetConfigOption("OSM_USE_CUSTOM_INDEXING", "NO");         // it refuses negative ids
        CPLSetConfigOption("CPL_VSIL_GZIP_WRITE_PROPERTIES", "NO");  // no files beside the user's
    });
}

Dataset open_vector(const std::string& name, bool network, bool no_files) {
    use_gdal();
    std::vector<const char*> drivers(files_alone.begin(), files_alone.end());
    if (network) drivers.insert(drivers.end(), elsewhere.begin(), elsewhere.end());
    drivers.push_back(nullptr);
    constexpr std::array<const char*, 3> written = {"WRITE_GFS=NO", "DOWNLOAD_SCHEMA=NO", nullptr};
    return Dataset(GDALOpenEx(name.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, drivers.data(),
                              no_files ? written.data() : nullptr, nullptr));
}

std::string leads_to(const std::string& head) {
    const auto begins = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (begins == std::string::npos || head[begins] != '<') return "";
    if (head.find("<OGRVRTDataSource") != std::string::npos) {
        return "a virtual file (OGR VRT), which leads to other files or addresses";
    }
    for (const std::string_view service : {"<OGRWFSDataSource", "WFS_Capabilities"}) {
        if (head.find(service) != std::string::npos) return "the address of a service (WFS)";
    }
    return "";
}

std::vector<std::string> files_of(const std::string& name, bool network) {
    const QuietGdal quiet;
    const Dataset set = open_vector(name, network, true);
    if (!set) return {};
    for (int i = 0; i < GDALDatasetGetLayerCount(set.get()); ++i) {
        OGR_L_GetLayerDefn(GDALDatasetGetLayer(set.get(), i));
    }
    char** list = GDALGetFileList(set.get());
    std::vector<std::string> out;
    for (int i = 0; list != nullptr && list[i] != nullptr; ++i) out.emplace_back(list[i]);
    CSLDestroy(list);
    return out;
}

bool can_be_opened(const std::string& name) {
    use_gdal();
    const QuietGdal quiet;
    return !read_head(name).empty();
}

PackedFile look_into(const std::filesystem::path& file) {
    use_gdal();
    const QuietGdal quiet;
    const std::string path = file.string();
    if (!std::filesystem::exists(file)) {
        throw IoError(fmt::format(
            "{}: no such file; check site.input (it is relative to the job file)", path));
    }
    if (std::filesystem::is_directory(file)) return {path, ""};
    std::string head = read_head(path);
    if (head.empty()) {
        if (std::filesystem::is_regular_file(file) && std::filesystem::file_size(file) > 0) {
            throw IoError(fmt::format("{}: cannot be read; check its permissions", path));
        }
        throw InputError(fmt::format("{}: the file is empty; export the site again", path));
    }
    if (head.rfind("PK\x03\x04", 0) == 0 || head.rfind("PK\x05\x06", 0) == 0) {
        const std::string entry = site_in("/vsizip/{" + path + "}", file);
        return {entry, read_head(entry)};
    }
    if (head.rfind("\x1f\x8b", 0) == 0) {
        const std::string name = "/vsigzip/" + path;
        std::string inside = read_head(name);
        if (inside.empty() || QuietGdal::failed()) {
            throw InputError(fmt::format(
                "{}: a gzip file that is empty or damaged; pack or fetch it again", path));
        }
        return {name, std::move(inside)};
    }
    return {path, std::move(head)};
}

void each_part(const PackedFile& packed, const std::filesystem::path& file,
               const std::function<void(std::string_view)>& f) {
    const QuietGdal quiet;
    const VsiFile in(VSIFOpenL(packed.name.c_str(), "rb"));
    if (!in) throw IoError(fmt::format("{}: cannot be opened", file.string()));
    std::array<char, 1 << 16> part{};
    while (const std::size_t n = VSIFReadL(part.data(), 1, part.size(), in.get())) {
        f({part.data(), n});
    }
    if (QuietGdal::failed()) {
        throw InputError(fmt::format("{}: {}; the file is damaged, export the site again",
                                     file.string(), QuietGdal::last()));
    }
}

std::string read_text(const PackedFile& packed, const std::filesystem::path& file) {
    constexpr std::size_t most = std::size_t{1} << 30;
    std::string text;
    each_part(packed, file, [&](std::string_view part) {
        text += part;
        if (text.size() <= most) return;
        throw InputError(fmt::format(
            "{}: more than 1 GiB of text; cut the site into parts, or convert it to GeoPackage",
            file.string()));
    });
    return text;
}

GreyImage read_grey_image(const std::filesystem::path& file) {
    use_gdal();
    if (!std::filesystem::is_regular_file(file)) {
        throw IoError(fmt::format("{}: no such image", file.string()));
    }
    const QuietGdal quiet;
    const Dataset set(GDALOpenEx(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, images.data(),
                                 nullptr, nullptr));
    const auto damaged = [&] {
        const std::string why = QuietGdal::last();
        return InputError(fmt::format("{}: not an image that can be read{}{}; give PGM or PNG",
                                      file.string(), why.empty() ? "" : ": ", why));
    };
    if (!set) throw damaged();
    GreyImage image;
    image.width = GDALGetRasterXSize(set.get());
    image.height = GDALGetRasterYSize(set.get());
    const int bands = std::min(3, GDALGetRasterCount(set.get()));
    const int colours = bands == 2 ? 1 : bands;  // the second is how opaque it is
    constexpr double most = 4e8;
    if (colours < 1) throw damaged();
    if (static_cast<double>(image.width) * image.height > most) {
        throw InputError(
            fmt::format("{}: {} x {} pixels, and at most 4e8 are read; make it coarser",
                        file.string(), image.width, image.height));
    }
    // Of an image with a palette the band has numbers of colours.
    std::array<int, 256> grey{};
    GDALColorTableH palette = GDALGetRasterColorTable(GDALGetRasterBand(set.get(), 1));
    for (int i = 0; i < 256; ++i) {
        const GDALColorEntry* c = palette == nullptr ? nullptr : GDALGetColorEntry(palette, i);
        grey[idx(i)] = c == nullptr ? i : (c->c1 + c->c2 + c->c3) / 3;
    }
    std::vector<unsigned char> row(idx(image.width));
    std::vector<int> sum(idx(image.width));
    for (int y = 0; y < image.height; ++y) {
        std::fill(sum.begin(), sum.end(), 0);
        for (int band = 1; band <= colours; ++band) {
            if (GDALRasterIO(GDALGetRasterBand(set.get(), band), GF_Read, 0, y, image.width, 1,
                             row.data(), image.width, 1, GDT_Byte, 0, 0) != CE_None) {
                throw damaged();
            }
            for (std::size_t x = 0; x < row.size(); ++x) sum[x] += grey[row[x]];
        }
        for (const int s : sum) image.pixels.push_back(static_cast<unsigned char>(s / colours));
    }
    return image;
}

}  // namespace vfplan
