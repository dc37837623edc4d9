#include "engine/job/run_dir.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/config/parameters.h"
#include "io/exports/outputs.h"
#include "io/files.h"
#include "io/formats/read_features.h"
#include "io/sha256.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr const char* key_label = "# job ";
constexpr const char* text_label = "# text ";  // hash of all that follows the line
constexpr const char* format = "vfplan tables 3\n";

}  // namespace

std::string input_hash(const Config& config) {
    std::string hash;
    for (const std::filesystem::path& path : existing_paths(config)) {
        if (std::filesystem::is_regular_file(path)) hash += sha256_of_file(path);
    }
    for (const std::filesystem::path& path : companions(config.site.input)) {
        hash += sha256_of_file(path);
    }
    return hash;
}

JobKeys job_keys(const Config& config, const std::string& input_sha256) {
    const auto hash = [&](Stale stage) {
        Sha256 h;
        h.add(std::string(format));
        h.add(canonical(config, stage));
        h.add(input_sha256);
        return h.hex();
    };
    return {hash(Stale::tables), hash(Stale::plan)};
}

std::string RunDir::stored_key() const {
    const std::string text = read_text(file("job.toml"));
    const auto at = text.find(key_label);
    if (at == std::string::npos) return "";
    const auto from = at + std::string(key_label).size();
    return text.substr(from, text.find('\n', from) - from);
}

bool RunDir::holds_nothing() const {
    const auto begun = [](const std::filesystem::directory_entry& e) {  // and killed at once
        return e.path().filename() == "job.toml.tmp" || e.path().filename() == lock_name;
    };
    std::error_code error;
    const std::filesystem::directory_iterator entries(path_, error);
    return std::all_of(begin(entries), end(entries), begun);
}

void RunDir::check(const JobKeys& keys, bool fresh) const {
    std::error_code error;
    if (!std::filesystem::exists(path_, error)) return;
    if (!std::filesystem::is_directory(path_, error)) {
        throw IoError(fmt::format("{}: is a file, and a run needs a folder; choose another --out",
                                  path_.string()));
    }
    if (holds_nothing()) return;
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

std::string RunDir::provenance() const {
    if (!std::filesystem::exists(file(provenance_name))) {
        throw UsageError(
            fmt::format("{}: holds no {}, so that its run did not come to the end of "
                        "its tables; run the job again, it goes on",
                        path_.string(), provenance_name));
    }
    return read_text(file(provenance_name));
}

void RunDir::begin_copy(const RunDir& from, const std::vector<std::string>& overrides) const {
    const std::string provenance = from.provenance();
    const Config config = from.config(overrides);
    const JobKeys keys =
        job_keys(config, nlohmann::json::parse(provenance).at("input_sha256").get<std::string>());
    std::error_code error;
    if (!holds_nothing()) {
        if (!std::filesystem::exists(file("job.toml"), error) || stored_key() != keys.job ||
            std::filesystem::exists(file("summary.json"), error)) {
            throw UsageError(fmt::format(
                "{}: holds files, and plan --out writes over none; choose another --out, or remove "
                "the folder",
                path_.string()));
        }
        remove_run();
    }
    write_job(config, keys);
    write_text(file(provenance_name), provenance);
    std::filesystem::create_directories(path_ / "shards", error);
    if (error) {
        throw IoError(fmt::format("{}: cannot create: {}; check free space and permissions",
                                  path_.string(), error.message()));
    }
    std::vector<std::filesystem::path> tables;
    for (const auto& entry : std::filesystem::directory_iterator(from.file("shards"))) {
        if (entry.path().extension() == ".h5") tables.push_back(entry.path());
    }
    for (const char* name : {"field.h5", "coverage.h5", pool_name}) {
        if (std::filesystem::exists(from.file(name))) tables.push_back(from.file(name));
    }
    for (const std::filesystem::path& table : tables) {
        const std::filesystem::path to = path_ / table.lexically_relative(from.path());
        // Nobody writes into a file of ours that is there, so two names may share one.
        std::filesystem::create_hard_link(table, to, error);
        if (error) std::filesystem::copy_file(table, to, error);
        if (!error) continue;
        throw IoError(
            fmt::format("{}: cannot be copied from {}: {}; check free space and "
                        "permissions",
                        to.string(), table.string(), error.message()));
    }
}

void RunDir::remove_plan() const {
    std::error_code ignored;
    for (const char* name : {"summary.json", "plan.h5"}) {
        std::filesystem::remove(file(name), ignored);
    }
    for (const Output& o : outputs()) std::filesystem::remove(file(o.file), ignored);
}

void RunDir::remove_run() const {
    remove_plan();
    std::error_code ignored;
    for (const char* name :
         {"field.h5", "coverage.h5", "pool.h5", "shards", "work", provenance_name}) {
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
