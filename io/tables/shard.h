// Shards: immutable files that phases leave behind, each whole, of one job and under its own name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/h5_writer.h"

namespace vfplan {

// What the shards of a phase are called.
class ShardNames {
public:
    // `variant` stands behind the phase in file names where the same phase makes different shards.
    ShardNames(std::filesystem::path folder, std::string phase, const std::string& variant = "")
        : folder_(std::move(folder)), phase_(std::move(phase)), stem_(phase_ + variant) {}

    const std::string& phase() const { return phase_; }
    // FOLDER/PHASE-00012.h5
    std::filesystem::path one(std::int64_t number) const;
    // FOLDER/PHASE.h5: what was put together from them.
    std::filesystem::path whole() const { return folder_ / (stem_ + ".h5"); }

private:
    std::filesystem::path folder_;
    std::string phase_;
    std::string stem_;
};

// A file with the job's key already in it; and its end. Throws IoError.
h5::Writer begin_shard(const std::filesystem::path& path, const std::string& key);
void finish_shard(h5::Writer& file);

// Why a file that is there is no shard of this job under its own name, as the beginning of a
// message; empty when it is one. Looks at every byte, once for each state of the file.
std::string shard_fault(const std::filesystem::path& path, const std::string& key);

}  // namespace vfplan
