#include "engine/tables/shards.h"

#include <fmt/format.h>
#include <malloc.h>

#include <cmath>
#include <new>
#include <stdexcept>

#include "engine/runtime/memory.h"
#include "engine/runtime/shell_word.h"
#include "io/files.h"
#include "io/tables/shard_index.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

std::filesystem::path passing_folder(const std::filesystem::path& dir, std::int64_t tile_cells) {
    return dir / "work" / fmt::format("tiles-{}", tile_cells);
}

// From an error's message up to its first semicolon: what is wrong, without what to do.
void warn_made_again(const std::string& why, Progress& progress) {
    progress.warn(fmt::format("{}; it is made again", why.substr(0, why.find(';'))));
}

// A bug is found again by the same task: all shards before it are there.
template <class Make>
void with_replay(const TableJob& job, const std::filesystem::path& path, Make&& make) {
    try {
        make();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw std::runtime_error(
            fmt::format("{} could not be made: {}; replay: vfplan run {} --out {} --threads 1",
                        path.filename().string(), e.what(),
                        shell_word((job.dir / "job.toml").string()), shell_word(job.dir.string())));
    }
}

}  // namespace

std::int32_t TableJob::range_cells() const {
    return static_cast<std::int32_t>(
        std::ceil(scenes.options().scanner.range_max_m / layout().grid.cell_m));
}

ShardNames TableJob::kept(const std::string& phase, const std::string& variant) const {
    return {dir / "shards", phase, variant};
}

ShardNames TableJob::passing(const std::string& phase, const std::string& variant) const {
    return {passing_folder(dir, layout().tile_cells), phase, variant};
}

void make_shard_folders(const std::filesystem::path& dir, std::int64_t tile_cells) {
    for (const auto& folder : {dir / "shards", passing_folder(dir, tile_cells)}) {
        make_folders(folder);
    }
}

bool have_shard(const std::filesystem::path& path, const std::string& key, Progress& progress) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return false;
    const std::string fault = shard_fault(path, key);
    if (fault.empty()) return true;
    warn_made_again(fault, progress);
    std::filesystem::remove(path, error);
    return false;
}

bool have_table(const std::filesystem::path& path, const std::string& key, Progress& progress) {
    if (!have_shard(path, key, progress)) return false;
    try {
        check_shards(path);
        return true;
    } catch (const IoError& e) {
        warn_made_again(e.what(), progress);
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
        return false;
    }
}

void make_shards(const TableJob& job, const ShardNames& names, std::int64_t n,
                 const MakeShard& make, double task_bytes) {
    malloc_trim(0);  // what the phase before took and gave back
    job.progress.stage(names.phase(), n);
    job.ranks.share(
        job.threads, n,
        [&](std::int64_t task) {
            const std::filesystem::path path = names.one(task);
            if (!have_shard(path, job.key, job.progress)) {
                with_replay(job, path, [&] { make(task, path); });
            }
            job.progress.reach(task + 1);  // tasks are handed out in order, to all ranks
        },
        tasks_at_once(task_bytes, job.threads.count()));
}

void make_one(const TableJob& job, const std::string& phase, const std::filesystem::path& path,
              const std::function<void(const std::filesystem::path&)>& make) {
    job.progress.stage(phase);
    job.ranks.lead([&] {
        if (have_shard(path, job.key, job.progress)) return;
        with_replay(job, path, [&] { make(path); });
    });
}

}  // namespace vfplan
