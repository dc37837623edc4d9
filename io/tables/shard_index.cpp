#include "io/tables/shard_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "io/checksum.h"
#include "io/files.h"
#include "io/h5_reader.h"
#include "io/tables/shard.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr std::int64_t format_version = 4;  // of the tables' layout (docs/file_format.md)
constexpr std::size_t hash_bytes = 32;
constexpr std::size_t digits = 5;  // of a shard's number, at least

// "shards/field-1024-" of field.h5, "shards/coverage-" of coverage.h5: an index is over shards of
// its own, beside it.
void check_stem(const h5::Reader& file, std::string_view stem, const std::filesystem::path& index) {
    const std::string own = "shards/" + index.stem().string() + "-";
    std::string_view rest = stem;
    if (rest.starts_with(own)) {
        rest.remove_prefix(own.size());
        const std::size_t number = std::min(rest.find_first_not_of("0123456789"), rest.size());
        if (rest.empty() || (number > 0 && rest.substr(number) == "-")) return;
    }
    file.fail(fmt::format("it names shards \"{}\", not its own, \"{}\"", stem, own));
}

std::uint8_t hex_value(char c) {
    return static_cast<std::uint8_t>(c <= '9' ? c - '0' : c - 'a' + 10);
}

}  // namespace

h5::Writer begin_table(const std::filesystem::path& path, const std::string& title,
                       const std::string& key) {
    h5::Writer file(path);
    file.attribute("/", "file", path.filename().string());
    file.attribute("/", "title", title);
    file.attribute("/", "format_version", format_version);
    file.attribute("/", "key", key);
    return file;
}

void finish_table(h5::Writer& file) { finish_shard(file); }

void check_version(const h5::Reader& file, const std::filesystem::path& path) {
    const bool any = file.has_attribute("/", "format_version");
    const auto found = any ? static_cast<std::int64_t>(file.number("/", "format_version")) : 0;
    if (found == format_version) return;
    throw IoError(
        fmt::format("{}: has version {} of our tables, and this vfplan reads version {}; run the "
                    "job again with --fresh, or use the vfplan that made it",
                    path.string(), found, format_version));
}

std::string name_in_index(const std::filesystem::path& shard) {
    return shard.parent_path().filename().string() + "/" + shard.filename().string();
}

void write_shard_list(h5::Writer& file, const std::vector<std::filesystem::path>& shards) {
    std::vector<std::uint8_t> hashes;
    for (const std::filesystem::path& shard : shards) {
        const std::string hash = checked_hash(shard);
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

std::vector<std::filesystem::path> check_shards(const std::filesystem::path& index) {
    const h5::Reader file(index);
    const auto hashes = file.read<std::uint8_t>("tile_sha256");
    if (hashes.size() % hash_bytes != 0) file.fail("tile_sha256 is no list of hashes");
    std::vector<std::filesystem::path> out;
    if (hashes.empty()) return out;
    const std::string stem = file.text("tile_status", "shards");
    check_stem(file, stem, index);
    for (std::size_t i = 0; i * hash_bytes < hashes.size(); ++i) {
        const std::filesystem::path shard =
            index.parent_path() / fmt::format("{}{:0{}}.h5", stem, i, digits);
        if (!is_there(shard)) {
            throw IoError(
                fmt::format("{}: missing, and {} needs it; run the job again and it is "
                            "made anew",
                            shard.string(), index.string()));
        }
        std::string wanted;
        for (std::size_t k = 0; k < hash_bytes; ++k) {
            wanted += fmt::format("{:02x}", hashes[i * hash_bytes + k]);
        }
        if (checked_hash(shard) != wanted) {
            throw IoError(
                fmt::format("{}: another shard than {} was made from; run the job again "
                            "and it is made anew",
                            shard.string(), index.string()));
        }
        out.push_back(shard);
    }
    return out;
}

void check_sources(const h5::Reader& file, const std::string& name,
                   const std::vector<h5::Source>& wanted) {
    if (file.sources(name) == wanted) return;
    file.fail(fmt::format("{} consists of other parts than the shards beside it", name));
}

}  // namespace vfplan
