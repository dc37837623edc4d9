#include "io/tables_parts.h"

#include <fmt/format.h>

#include "io/tables.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr std::size_t hash_bytes = 32;
constexpr std::size_t digits = 5;  // of a shard's number, at least

std::uint8_t hex_value(char c) {
    return static_cast<std::uint8_t>(c <= '9' ? c - '0' : c - 'a' + 10);
}

}  // namespace

void write_header(h5::Writer& file, const std::filesystem::path& path, const std::string& title,
                  const std::string& key) {
    file.attribute("/", "file", path.filename().string());
    file.attribute("/", "title", title);
    file.attribute("/", "format_version", std::int64_t{2});
    file.attribute("/", "key", key);
}

void finish(h5::Writer& file) {
    file.attribute("/", "complete", std::int64_t{1});
    file.close();
}

void write_crs(h5::Writer& file, const std::string& crs_wkt, const Vec2d& origin) {
    file.write("crs", std::vector<std::int32_t>{0});
    if (!crs_wkt.empty()) {
        file.attribute("crs", "crs_wkt", crs_wkt);
        file.attribute("crs", "spatial_ref", crs_wkt);
    }
    file.attribute("crs", "origin_x_m", origin.x());
    file.attribute("crs", "origin_y_m", origin.y());
}

std::string read_crs(const h5::Reader& file, Vec2d& origin) {
    origin = {file.number("crs", "origin_x_m"), file.number("crs", "origin_y_m")};
    return file.has_attribute("crs", "crs_wkt") ? file.text("crs", "crs_wkt") : "";
}

std::string name_in_index(const std::filesystem::path& shard) {
    return shard.parent_path().filename().string() + "/" + shard.filename().string();
}

void write_shard_list(h5::Writer& file, const std::vector<std::filesystem::path>& shards) {
    std::vector<std::uint8_t> hashes;
    for (const std::filesystem::path& shard : shards) {
        const std::string hash = h5::checked_hash(shard);
        for (std::size_t i = 0; i < hash.size(); i += 2) {
            hashes.push_back(
                static_cast<std::uint8_t>(hex_value(hash[i]) << 4U | hex_value(hash[i + 1])));
        }
    }
    file.write("tile_status", std::vector<std::uint8_t>(shards.size(), 1));
    file.attribute("tile_status", "meaning", "1 complete; see also the attribute `complete` of /");
    file.write("tile_sha256", hashes, {shards.size(), hash_bytes});
    file.attribute("tile_sha256", "meaning", "SHA-256 of the shard but for its last 80 bytes");
    if (shards.empty()) return;
    const std::string first = name_in_index(shards.front());
    file.attribute("tile_status", "shards", first.substr(0, first.rfind('-') + 1));
}

void check_shards(const std::filesystem::path& index) {
    const h5::Reader file(index);
    const auto hashes = file.read<std::uint8_t>("tile_sha256");
    if (hashes.empty()) return;
    const std::string stem = file.text("tile_status", "shards");
    for (std::size_t i = 0; i * hash_bytes < hashes.size(); ++i) {
        const std::filesystem::path shard =
            index.parent_path() / fmt::format("{}{:0{}}.h5", stem, i, digits);
        if (!std::filesystem::exists(shard)) {
            throw IoError(
                fmt::format("{}: missing, and {} needs it; run the job again and it is "
                            "made anew",
                            shard.string(), index.string()));
        }
        std::string wanted;
        for (std::size_t k = 0; k < hash_bytes; ++k) {
            wanted += fmt::format("{:02x}", hashes[i * hash_bytes + k]);
        }
        if (h5::checked_hash(shard) != wanted) {
            throw IoError(
                fmt::format("{}: another shard than {} was made from; run the job again "
                            "and it is made anew",
                            shard.string(), index.string()));
        }
    }
}

}  // namespace vfplan
