#include "engine/folder/contents.h"

#include <fmt/format.h>

#include <regex>

#include "io/exports/outputs.h"
#include "io/tables/coverage_file.h"
#include "io/tables/site_store.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;

constexpr const char* in_the_making = ".tmp";

bool matches(std::string_view name, const std::regex& wanted) {
    return std::regex_match(name.begin(), name.end(), wanted);
}

bool is_tiles_folder(std::string_view name) {
    static const std::regex wanted("tiles-[0-9]+");
    return matches(name, wanted);
}

// The names in a folder; none where it is no folder, or a link to one.
std::vector<std::string> names_in(const fs::path& folder) {
    std::error_code error;
    std::vector<std::string> out;
    if (!fs::is_directory(fs::symlink_status(folder, error))) return out;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        out.push_back(entry.path().filename().string());
    }
    return out;
}

void erase(const fs::path& path) {
    std::error_code ignored;
    fs::remove(path, ignored);  // a file, a link itself, an empty folder
}

template <class Wanted>
void remove_from(const fs::path& folder, const Wanted& wanted) {
    for (const std::string& name : names_in(folder)) {
        if (wanted(name)) erase(folder / name);
    }
}

// All files of ours that lie in the folder itself, but for those that are locked.
std::vector<std::string> all_files() {
    std::vector<std::string> out = plan_files();
    for (const std::string& name : table_files()) out.push_back(name);
    out.insert(out.end(), {summary_name, job_name, provenance_name});
    return out;
}

void refuse_unless(bool good, const fs::path& path, fs::file_type type) {
    if (good || type == fs::file_type::not_found || type == fs::file_type::none) return;
    throw IoError(fmt::format(
        "{}: is {}, where a run keeps a file or folder of its own; remove it or choose another "
        "--out",
        path.string(), type == fs::file_type::symlink ? "a symbolic link" : "something else"));
}

void need_file(const fs::path& path) {
    std::error_code error;
    const fs::file_type type = fs::symlink_status(path, error).type();
    refuse_unless(type == fs::file_type::regular, path, type);
}

bool need_folder(const fs::path& path) {
    std::error_code error;
    const fs::file_type type = fs::symlink_status(path, error).type();
    refuse_unless(type == fs::file_type::directory, path, type);
    return type == fs::file_type::directory;
}

}  // namespace

std::vector<std::string> plan_files() {
    std::vector<std::string> out = {plan_name};
    for (const Output& o : outputs()) out.emplace_back(o.file);
    return out;
}

std::vector<std::string> table_files() { return {field_name, coverage_name, pool_name}; }

bool is_shard_name(std::string_view name) {
    static const std::regex wanted(R"((field-[0-9]+|coverage|pool)-[0-9]+\.h5(\.tmp)?)");
    return matches(name, wanted);
}

bool is_passing_name(std::string_view name) {
    static const std::regex wanted(
        "(skeleton|ridges|joints|splits|rescues|components|components-joined|paths|connectors|"
        R"(disputed|joins|apart|pool|weights|points)(-[0-9]+)*\.h5(\.tmp)?)");
    return matches(name, wanted);
}

void refuse_links(const fs::path& folder) {
    for (const std::string& name : all_files()) need_file(folder / name);
    if (need_folder(folder / "shards")) {
        for (const std::string& name : names_in(folder / "shards")) {
            if (is_shard_name(name)) need_file(folder / "shards" / name);
        }
    }
    if (!need_folder(folder / "work")) return;
    need_file(site_store_path(folder));
    for (const std::string& tiles : names_in(folder / "work")) {
        if (!is_tiles_folder(tiles)) continue;
        need_folder(folder / "work" / tiles);
        for (const std::string& name : names_in(folder / "work" / tiles)) {
            if (is_passing_name(name)) need_file(folder / "work" / tiles / name);
        }
    }
}

void remove_plan_files(const fs::path& folder) {
    erase(folder / summary_name);
    for (const std::string& name : plan_files()) erase(folder / name);
}

void remove_tables(const fs::path& folder) {
    for (const std::string& name : table_files()) erase(folder / name);
    erase(folder / provenance_name);
    remove_from(folder / "shards", is_shard_name);
    erase(folder / "shards");
}

void remove_passing(const fs::path& folder) {
    const fs::path work = folder / "work";
    for (const std::string& name : names_in(work)) {
        if (is_tiles_folder(name)) remove_from(work / name, is_passing_name);
        if (is_tiles_folder(name) || name == "site.h5" || name == "site.h5.tmp") erase(work / name);
    }
    erase(work);
}

void remove_unfinished(const fs::path& folder) {
    for (const std::string& name : all_files()) {
        const fs::path aside = folder / (name + in_the_making);
        if (!names_in(aside).empty()) {  // of libraries that put journals beside their file
            remove_from(aside, [&](const std::string& n) { return n.starts_with(name); });
        }
        erase(aside);
    }
    remove_from(folder / "shards", [](const std::string& name) {
        return is_shard_name(name) && name.ends_with(in_the_making);
    });
}

void remove_other_tiles(const fs::path& folder, std::int64_t tile_cells) {
    const std::string ours = fmt::format("field-{}-", tile_cells);
    remove_from(folder / "shards", [&](const std::string& name) {
        return is_shard_name(name) && name.starts_with("field-") && !name.starts_with(ours);
    });
}

}  // namespace vfplan
