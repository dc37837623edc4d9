#include "engine/work.h"

#include <fmt/format.h>
#include <malloc.h>

#include <cmath>

#include "engine/tables_stage.h"
#include "kernels/error.h"

namespace vfplan {

OverlapRatio Work::ratio() const { return ratio_of(config.overlap.ratio); }

std::int32_t Work::range_cells() const {
    return static_cast<std::int32_t>(std::ceil(config.scanner.range_max_m / config.field.cell_m));
}

std::filesystem::path Work::kept(const std::string& name, std::int64_t number) const {
    return dir / "shards" / fmt::format("{}-{:05}.h5", name, number);
}

std::filesystem::path Work::passing(const std::string& name, std::int64_t number) const {
    return dir / "work" / fmt::format("tiles-{}", layout().tile_cells) /
           fmt::format("{}-{:05}.h5", name, number);
}

bool have_shard(const std::filesystem::path& path, const std::string& key, Progress& progress) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return false;
    std::string why;
    try {
        const h5::Reader file(path);
        if (!file.has_attribute("/", "complete") || file.text("/", "key") != key) {
            why = path.string() + ": of another job";
        } else if (file.text("/", "file") != path.filename().string()) {
            why =
                fmt::format("{}: is {} under another name", path.string(), file.text("/", "file"));
        } else {
            return true;
        }
    } catch (const IoError& e) {
        why = e.what();
    }
    note_made_again(why, progress);
    std::filesystem::remove(path, error);
    return false;
}

void note_made_again(const std::string& why, Progress& progress) {
    progress.warn(fmt::format("{}; it is made again", why.substr(0, why.find(';'))));
}

void make_shards(const Work& work, const std::string& stage, std::int64_t n,
                 const std::function<std::filesystem::path(std::int64_t)>& path_of,
                 const std::function<void(std::int64_t, const std::filesystem::path&)>& make) {
    malloc_trim(0);  // what the phase before took and gave back
    work.progress.stage(stage, n);
    work.ranks.share(work.threads, n, [&](std::int64_t task) {
        const std::filesystem::path path = path_of(task);
        if (!have_shard(path, work.key, work.progress)) make(task, path);
        work.progress.reach(task + 1);  // tasks are handed out in order, to all ranks
    });
}

void make_shard(const Work& work, const std::string& stage, const std::filesystem::path& path,
                const std::function<void(const std::filesystem::path&)>& make) {
    work.progress.stage(stage);
    work.ranks.lead([&] {
        if (!have_shard(path, work.key, work.progress)) make(path);
    });
}

h5::Writer shard_writer(const std::filesystem::path& path, const std::string& key) {
    h5::Writer file(path);
    file.attribute("/", "key", key);
    file.attribute("/", "file", path.filename().string());
    return file;
}

void finish_shard(h5::Writer& file) {
    file.attribute("/", "complete", std::int64_t{1});
    file.close();
}

}  // namespace vfplan
