// What readers share of GDAL: its drivers, its silence, and its way into packed files. A folder, a
// file, a gzip'd file or an entry of a ZIP archive all have a name that GDAL opens.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vfplan {

// Keeps GDAL's own messages from the terminal while it lives, and forgets what it said before.
class QuietGdal {
public:
    QuietGdal();
    ~QuietGdal();
    QuietGdal(const QuietGdal&) = delete;
    QuietGdal& operator=(const QuietGdal&) = delete;
    // What it said last; empty when nothing. Throws bad_alloc where memory gave out.
    static std::string last();
    static bool failed();  // it said that something went wrong
};

// Registers the drivers, and closes the network, once.
void use_gdal();

struct DatasetCloser {
    void operator()(void* dataset) const;
};
using Dataset = std::unique_ptr<void, DatasetCloser>;

// Opens vector data with the drivers that docs/formats.md promises, and no other: what a file is
// called or says of itself must not make GDAL ask a database or another machine. `network`: also
// those that lead to other files and services. `no_files`: nothing is written beside a file of GML.
// Null when none of them can; QuietGdal has why.
Dataset open_vector(const std::string& name, bool network, bool no_files = false);

// What a file that begins so leads to, where it is one that open_vector() opens with `network`
// only; empty for all others.
std::string leads_to(const std::string& head);

// All files that GDAL reads for a name, as it names them; empty when it cannot open it. Layers are
// opened, so that `network` files and services behind a virtual file are found.
std::vector<std::string> files_of(const std::string& name, bool network);

// Whether GDAL can open a file of that name and read from it.
bool can_be_opened(const std::string& name);

// Text as a file that GDAL opens, in memory, while the object lives.
class FileInMemory {
public:
    explicit FileInMemory(std::string text);
    ~FileInMemory();
    FileInMemory(const FileInMemory&) = delete;
    FileInMemory& operator=(const FileInMemory&) = delete;
    const std::string& name() const { return name_; }

private:
    std::string text_;
    std::string name_;
};

// What GDAL opens for a site's file, and how its contents begin.
struct PackedFile {
    std::string name;  // for GDAL
    std::string head;  // up to 64 KiB, unpacked; empty for a folder
};

// Looks into gzip'd files and ZIP archives. Of an archive: its Shapefile (or the folder of its
// Shapefiles), else its Home.xml, else its only file that can be a site. Throws IoError when there
// is no such file, InputError when it is empty, or an archive without a site or with several.
PackedFile look_into(const std::filesystem::path& file);

// Calls f(part) for one part of an unpacked file after the other. Throws InputError when it is
// damaged.
void each_part(const PackedFile& packed, const std::filesystem::path& file,
               const std::function<void(std::string_view)>& f);

// All of an unpacked file, at most 1 GiB. Throws InputError when it is longer or damaged.
std::string read_text(const PackedFile& packed, const std::filesystem::path& file);

// A raster of grey values, the mean of its colours, 0 to 255; rows from top to bottom.
struct GreyImage {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> pixels;
};

// Throws IoError when there is no such file, InputError for one that is no image, is damaged, or
// has more than 4e8 pixels.
GreyImage read_grey_image(const std::filesystem::path& file);

}  // namespace vfplan
