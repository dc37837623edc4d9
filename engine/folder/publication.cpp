#include "engine/folder/publication.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>

#include "engine/folder/contents.h"
#include "io/files.h"
#include "io/sha256.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* own_hash = "sha256";

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// All that summary.json vouches for.
std::vector<std::string> vouched_for() {
    std::vector<std::string> out = {job_name, provenance_name};
    for (const std::string& name : plan_files()) out.push_back(name);
    return out;
}

}  // namespace

void withdraw_plan(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / summary_name;
    if (::unlink(file.c_str()) != 0 && errno != ENOENT) fail_on_file(file, "remove", errno);
    // On the disk too before anything of a new plan is.
    sync_folder(folder);
}

void publish_plan(const std::filesystem::path& folder, Json summary) {
    Json files = Json::object();
    for (const std::string& name : vouched_for()) {
        if (is_there(folder / name)) files[name] = sha256_of_file(folder / name);
    }
    summary["files"] = files;
    summary.erase(own_hash);
    summary[own_hash] = sha256_of(text_of(summary));
    write_text(folder / summary_name, text_of(summary));
}

std::vector<std::string> faults_since_published(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / summary_name;
    if (!is_there(file)) {
        throw IoError(fmt::format(
            "{}: no {}, so that no plan was published here: making it did not come to its end; "
            "vfplan run or vfplan plan {} goes on",
            folder.string(), summary_name, folder.string()));
    }
    const std::string text = read_text(file);
    const std::string changed = fmt::format("{}: not as it was written", summary_name);
    Json summary = Json::parse(text, nullptr, false);
    if (!summary.is_object() || !summary.contains(own_hash) || !summary.contains("files") ||
        !summary["files"].is_object() || text_of(summary) != text) {
        return {changed};
    }
    const Json said = summary[own_hash];
    const Json files = summary["files"];
    summary.erase(own_hash);
    if (said != sha256_of(text_of(summary))) return {changed};
    std::vector<std::string> out;
    for (const std::string& name : vouched_for()) {
        const bool there = is_there(folder / name);
        if (!files.contains(name)) {
            if (there) out.push_back(fmt::format("{}: belongs to no plan here", name));
        } else if (!there) {
            out.push_back(fmt::format("{}: missing", name));
        } else if (files[name] != sha256_of_file(folder / name)) {
            out.push_back(fmt::format("{}: not as it was written", name));
        }
    }
    return out;
}

}  // namespace vfplan
