#include "engine/folder/run_dir.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "engine/config/parameters.h"
#include "engine/folder/contents.h"
#include "engine/folder/lock.h"
#include "io/files.h"
#include "io/sha256.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr std::string_view key_label = "# job ";
constexpr std::string_view version_label = " tables ";
constexpr std::string_view text_label = "# text ";  // hash of all that follows the line
constexpr std::size_t hash_digits = 64;

bool is_hash(std::string_view text) {
    return text.size() == hash_digits &&
           text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

JobKeys job_keys(const Config& config, const std::string& input_sha256) {
    const auto hash = [&](Stale stage) {
        return sha256_of(fmt::format("vfplan tables {}\n{}{}", tables_version,
                                     canonical(config, stage), input_sha256));
    };
    return {hash(Stale::tables), hash(Stale::plan)};
}

RunDir::Header RunDir::header() const {
    const std::string whole = read_text(file(job_name));
    std::string_view rest = whole;
    const auto line = [&] {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view out = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        return out;
    };
    Header out;
    const std::string_view first = line();
    const std::string_view second = line();
    if (!first.starts_with(key_label) || !second.starts_with(text_label)) return out;
    const std::string_view said = first.substr(key_label.size());
    const std::string_view version = said.substr(std::min(hash_digits, said.size()));
    if (!is_hash(said.substr(0, hash_digits)) || !version.starts_with(version_label)) return out;
    std::from_chars(version.data() + version_label.size(), version.data() + version.size(),
                    out.version);
    out.key = said.substr(0, hash_digits);
    out.whole = second.substr(text_label.size()) == sha256_of(rest);
    return out;
}

bool RunDir::holds_nothing() const {
    const auto begun = [](const std::filesystem::directory_entry& e) {  // and killed at once
        const std::string name = e.path().filename().string();
        return name == fmt::format("{}.tmp", job_name) || name == lock_name || name == ranks_name;
    };
    std::error_code error;
    const std::filesystem::directory_iterator entries(path_, error);
    return std::all_of(begin(entries), end(entries), begun);
}

void RunDir::check_ours() const {
    std::error_code error;
    if (is_marked(path_) && std::filesystem::exists(file(job_name), error) &&
        !header().key.empty()) {
        return;
    }
    throw UsageError(fmt::format(
        "{}: holds files but no run of this program (a run has a {} of ours and the mark {}); "
        "choose another --out or an empty folder",
        path_.string(), job_name, lock_name));
}

void RunDir::check(const JobKeys& keys, bool fresh) const {
    std::error_code error;
    if (!std::filesystem::exists(path_, error)) return;
    if (!std::filesystem::is_directory(path_, error)) {
        throw IoError(fmt::format("{}: is a file, and a run needs a folder; choose another --out",
                                  path_.string()));
    }
    refuse_links(path_);
    if (holds_nothing()) return;
    check_ours();
    const Header said = header();
    if (fresh && !said.whole) {
        throw UsageError(fmt::format(
            "{}: changed by hand, and --fresh would write over it; move it away, or choose "
            "another --out",
            file(job_name).string()));
    }
    if (fresh || said.key == keys.job) return;
    if (said.version != tables_version) {
        throw UsageError(fmt::format(
            "{}: holds the run of another vfplan (its tables are of version {}, these of {}); "
            "choose another --out, or --fresh to make all again",
            path_.string(), said.version, tables_version));
    }
    throw UsageError(
        fmt::format("{}: holds the run of another job (its hash {}, this job's {}); "
                    "choose another --out, or --fresh to replace it (for another plan from the "
                    "same tables: vfplan plan)",
                    path_.string(), said.key.substr(0, 16), keys.job.substr(0, 16)));
}

void RunDir::write_job(const Config& config, const JobKeys& keys) const {
    const std::string text = to_toml(config);
    write_text(file(job_name), fmt::format("{}{}{}{}\n{}{}\n{}", key_label, keys.job, version_label,
                                           tables_version, text_label, sha256_of(text), text));
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

std::string RunDir::input_sha256() const {
    const auto json = nlohmann::json::parse(provenance(), nullptr, false);
    if (json.is_object() && json.contains("input_sha256") && json["input_sha256"].is_string()) {
        return json["input_sha256"];
    }
    throw IoError(
        fmt::format("{}: does not say which input the run had; run the job again with --fresh",
                    file(provenance_name).string()));
}

void RunDir::check_job(const std::string& tables_key) const {
    const JobKeys keys = job_keys(config(), input_sha256());
    if (keys.tables == tables_key && keys.job == header().key) return;
    throw IoError(
        fmt::format("{}: is of another job than the tables beside it; put the job's own back, or "
                    "run the job into another folder",
                    file(job_name).string()));
}

void RunDir::begin_copy(const RunDir& from, const std::vector<std::string>& overrides) const {
    const std::string provenance = from.provenance();
    const Config config = from.config(overrides);
    const JobKeys keys = job_keys(config, from.input_sha256());
    std::error_code error;
    refuse_links(path_);
    if (!holds_nothing()) {
        if (!std::filesystem::exists(file(job_name), error) || header().key != keys.job ||
            std::filesystem::exists(file(summary_name), error)) {
            throw UsageError(fmt::format(
                "{}: holds files, and plan --out writes over none; choose another --out, or remove "
                "the folder",
                path_.string()));
        }
        remove_run();
    }
    write_job(config, keys);
    write_text(file(provenance_name), provenance);
    make_folders(path_ / "shards");
    std::vector<std::filesystem::path> tables;
    for (const auto& entry : std::filesystem::directory_iterator(from.file("shards"))) {
        const std::string name = entry.path().filename().string();
        if (is_shard_name(name) && name.ends_with(".h5")) tables.push_back(entry.path());
    }
    for (const std::string& name : table_files()) {
        if (std::filesystem::exists(from.file(name))) tables.push_back(from.file(name));
    }
    for (const std::filesystem::path& table : tables) {
        const std::filesystem::path to = path_ / table.lexically_relative(from.path());
        // Nobody writes into a file of ours that is there, so two names may share one.
        std::filesystem::create_hard_link(table, to, error);
        if (error) std::filesystem::copy_file(table, to, error);
        if (!error) continue;
        throw IoError(fmt::format("{}: cannot be copied from {}: {}; {}", to.string(),
                                  table.string(), error.message(), advice_on(error.value())));
    }
}

void RunDir::remove_plan() const { remove_plan_files(path_); }

void RunDir::remove_run() const {
    remove_plan_files(path_);
    remove_tables(path_);
    remove_passing(path_);
    remove_unfinished(path_);
}

void RunDir::remove_work() const {
    remove_passing(path_);
    remove_unfinished(path_);
    remove_other_tiles(path_, FieldFile(file(field_name)).info().layout.tile_cells);
}

Config RunDir::config(const std::vector<std::string>& overrides) const {
    if (!std::filesystem::exists(file(job_name))) {
        throw IoError(fmt::format("{}: no {} in it; give the folder of a finished run",
                                  path_.string(), job_name));
    }
    const Header said = header();
    if (!said.whole) {
        throw IoError(
            fmt::format("{}: changed by hand or damaged: it must say what the tables beside it "
                        "were made from; change the job file instead and run it into another "
                        "folder, or use vfplan plan --set",
                        file(job_name).string()));
    }
    return read_config(file(job_name), overrides);
}

}  // namespace vfplan
