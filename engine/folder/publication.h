// A plan appears as one: summary.json goes first and comes last, and names every other file of the
// plan with its SHA-256. A folder without it has no plan, whatever else lies there.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vfplan {

// From now on the folder has no plan: what there was may be written over. Throws IoError.
void withdraw_plan(const std::filesystem::path& folder);

// Writes summary.json: `summary`, the hashes of the plan's files that are there and of job.toml and
// provenance.json ("files"), and its own ("sha256", of its text without this line). Throws IoError.
void publish_plan(const std::filesystem::path& folder, nlohmann::ordered_json summary);

// What is not as it was published, a line each, naming the file; empty when all is. Throws IoError
// where nothing was published.
std::vector<std::string> faults_since_published(const std::filesystem::path& folder);

}  // namespace vfplan
