#include "io/tables/shard.h"

#include <fmt/format.h>

#include "io/h5_reader.h"
#include "kernels/error.h"

namespace vfplan {

std::filesystem::path ShardNames::one(std::int64_t number) const {
    return folder_ / fmt::format("{}-{:05}.h5", stem_, number);
}

h5::Writer begin_shard(const std::filesystem::path& path, const std::string& key) {
    h5::Writer file(path);
    file.attribute("/", "key", key);
    file.attribute("/", "file", path.filename().string());
    return file;
}

void finish_shard(h5::Writer& file) {
    file.attribute("/", "complete", std::int64_t{1});
    file.close();
}

std::string shard_fault(const std::filesystem::path& path, const std::string& key) {
    try {
        const h5::Reader file(path);
        if (!file.has_attribute("/", "complete") || file.text("/", "key") != key) {
            return path.string() + ": of another job";
        }
        const std::string name = file.text("/", "file");
        if (name == path.filename().string()) return "";
        return fmt::format("{}: is {} under another name", path.string(), name);
    } catch (const IoError& e) {
        return e.what();
    }
}

}  // namespace vfplan
