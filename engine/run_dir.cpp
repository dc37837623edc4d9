#include "engine/run_dir.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <thread>

#include "engine/stop.h"
#include "io/files.h"
#include "io/sha256.h"
#include "io/tables.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr const char* key_label = "# job ";
constexpr const char* text_label = "# text ";  // hash of all that follows the line
constexpr const char* lock_name = ".lock";
constexpr const char* format = "vfplan tables 2\n";

}  // namespace

JobKeys job_keys(const Config& config, const std::string& input_sha256) {
    const auto hash = [&](Stage stage) {
        Sha256 h;
        h.add(std::string(format));
        h.add(canonical(config, stage));
        h.add(input_sha256);
        return h.hex();
    };
    return {hash(Stage::tables), hash(Stage::plan)};
}

std::string RunDir::stored_key() const {
    const std::string text = read_text(file("job.toml"));
    const auto at = text.find(key_label);
    if (at == std::string::npos) return "";
    const auto from = at + std::string(key_label).size();
    return text.substr(from, text.find('\n', from) - from);
}

void RunDir::check(const JobKeys& keys, bool fresh) const {
    std::error_code error;
    if (!std::filesystem::exists(path_, error)) return;
    if (!std::filesystem::is_directory(path_, error)) {
        throw IoError(fmt::format("{}: is a file, and a run needs a folder; choose another --out",
                                  path_.string()));
    }
    const auto begun = [](const std::filesystem::directory_entry& e) {  // and killed at once
        return e.path().filename() == "job.toml.tmp" || e.path().filename() == lock_name;
    };
    const std::filesystem::directory_iterator entries(path_, error);
    if (std::all_of(begin(entries), end(entries), begun)) return;
    if (!std::filesystem::exists(file("job.toml"), error)) {
        throw UsageError(
            fmt::format("{}: holds files but no run of this program; choose another "
                        "--out or an empty folder",
                        path_.string()));
    }
    const std::string stored = stored_key();
    if (stored == keys.job || fresh) return;
    throw UsageError(
        fmt::format("{}: holds the run of another job (its hash {}, this job's {}); "
                    "choose another --out, or --fresh to replace it (for another plan from the "
                    "same tables: vfplan plan)",
                    path_.string(), stored.substr(0, 16), keys.job.substr(0, 16)));
}

void RunDir::write_job(const Config& config, const JobKeys& keys) const {
    const std::string text = to_toml(config);
    Sha256 hash;
    hash.add(text);
    write_text(file("job.toml"),
               fmt::format("{}{}\n{}{}\n{}", key_label, keys.job, text_label, hash.hex(), text));
}

void RunDir::remove_plan() const {
    std::error_code ignored;
    for (const char* name : {"summary.json", "plan.h5", "stations.csv", "stations.geojson",
                             "links.csv", "pieces.csv", "plan.gpkg", "map.png"}) {
        std::filesystem::remove(file(name), ignored);
    }
}

void RunDir::remove_run() const {
    remove_plan();
    std::error_code ignored;
    for (const char* name : {"field.h5", "coverage.h5", "shards", "work", "provenance.json"}) {
        std::filesystem::remove_all(file(name), ignored);
    }
}

void RunDir::remove_work() const {
    std::error_code ignored;
    std::filesystem::remove_all(file("work"), ignored);
    for (const std::filesystem::path& folder : {path_, file("shards")}) {
        std::vector<std::filesystem::path> left;
        for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
            if (entry.path().extension() == ".tmp") left.push_back(entry.path());
        }
        for (const std::filesystem::path& tmp : left) std::filesystem::remove(tmp, ignored);
    }
    const std::string ours =
        fmt::format("field-{}-", FieldFile(file("field.h5")).info().layout.tile_cells);
    std::vector<std::filesystem::path> others;
    for (const auto& entry : std::filesystem::directory_iterator(file("shards"), ignored)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("field-") && !name.starts_with(ours)) others.push_back(entry.path());
    }
    for (const std::filesystem::path& other : others) std::filesystem::remove(other, ignored);
}

FolderLock::FolderLock(const RunDir& dir, bool leader) {
    constexpr int tries = 40;
    constexpr auto pause = std::chrono::milliseconds(250);
    file_ = ::open(dir.file(lock_name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) return;  // a folder that cannot be written is told elsewhere
    for (int i = 0; ::flock(file_, (leader ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0; ++i) {
        if (errno != EWOULDBLOCK && errno != EINTR) return;  // no locks here
        stop_if_asked();
        if (i == tries) {
            ::close(file_);
            file_ = -1;
            throw IoError(fmt::format(
                "{}: another vfplan is writing into this folder; wait for it or end it, or choose "
                "another --out",
                dir.path().string()));
        }
        std::this_thread::sleep_for(pause);
    }
    // From now on other leaders are kept out, and the ranks of this job are let in.
    if (leader) ::flock(file_, LOCK_SH);
}

FolderLock::~FolderLock() {
    if (file_ >= 0) ::close(file_);
}

ClaimedFolder::ClaimedFolder(const RunDir& dir, const Config& config, const JobKeys& keys,
                             bool fresh)
    : dir_(dir) {
    dir.check(keys, fresh);
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(dir.path()).lexically_normal();
    std::filesystem::path part;
    for (const std::filesystem::path& name : whole) {
        part /= name;
        if (std::filesystem::exists(part, error)) continue;
        if (!std::filesystem::create_directory(part, error) || error) break;
        created_.push_back(part);
    }
    try {
        if (!std::filesystem::is_directory(whole, error)) {
            throw IoError(fmt::format("{}: the folder cannot be created; choose another --out",
                                      dir.path().string()));
        }
        lock_.emplace(dir, true);
        dir.check(keys, fresh);  // whoever held it may have left something
        new_job_ = !std::filesystem::exists(dir.file("job.toml"), error);
        if (fresh) dir.remove_run();
        dir.write_job(config, keys);
        for (const char* name : {"shards", "work"}) {
            std::filesystem::create_directories(dir.file(name), error);
            if (!error) continue;
            throw IoError(fmt::format("{}: cannot create: {}; check free space and permissions",
                                      dir.file(name).string(), error.message()));
        }
    } catch (...) {
        undo();
        throw;
    }
}

ClaimedFolder::~ClaimedFolder() {
    if (!kept_) undo();
}

void ClaimedFolder::undo() {
    std::error_code ignored;
    if (new_job_) {
        dir_.remove_run();
        std::filesystem::remove(dir_.file("job.toml"), ignored);
    }
    if (lock_ && !created_.empty()) std::filesystem::remove(dir_.file(lock_name), ignored);
    for (auto p = created_.rbegin(); p != created_.rend(); ++p) {
        std::filesystem::remove(*p, ignored);  // only while empty
    }
}

Config RunDir::config(const std::vector<std::string>& overrides) const {
    if (!std::filesystem::exists(file("job.toml"))) {
        throw IoError(fmt::format("{}: no job.toml in it; give the folder of a finished run",
                                  path_.string()));
    }
    const std::string whole = read_text(file("job.toml"));
    const auto at = whole.find(text_label);
    const auto end = at == std::string::npos ? at : whole.find('\n', at);
    Sha256 hash;
    if (end != std::string::npos) hash.add(whole.substr(end + 1));
    const std::size_t from = at + std::string(text_label).size();
    if (end == std::string::npos || whole.substr(from, end - from) != hash.hex()) {
        throw IoError(
            fmt::format("{}: changed by hand or damaged: it must say what the tables beside it "
                        "were made from; change the job file instead and run it into another "
                        "folder, or use vfplan plan --set",
                        file("job.toml").string()));
    }
    return read_config(file("job.toml"), overrides);
}

}  // namespace vfplan
