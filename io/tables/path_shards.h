// Between the components of the overlap graph: which candidate is in which, the shortest paths from
// one to another, and the connectors that were tried on them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/tables/shard.h"
#include "kernels/vec.h"

namespace vfplan {

// work/.../components-TILE.h5: pairs of candidates that overlap enough, by number, so many that
// they connect what all such pairs connect.
using CandidatePairs = std::vector<std::pair<std::int32_t, std::int32_t>>;
void write_pairs(const std::filesystem::path& path, const std::string& key,
                 const CandidatePairs& pairs);
CandidatePairs read_pairs(const std::filesystem::path& path);

// work/.../components.h5: the component of each candidate, numbered from 0 on.
void write_components(const std::filesystem::path& path, const std::string& key,
                      const std::vector<std::int32_t>& component, std::int64_t count);
// Thread-safe. Throws IoError.
class Components {
public:
    explicit Components(std::filesystem::path file) : file_(std::move(file)) {}
    std::int64_t count() const;
    // Of the candidates with these numbers, which ascend.
    std::vector<std::int32_t> of(const std::vector<std::int32_t>& numbers) const;

private:
    std::filesystem::path file_;
};

// The shortest path between two candidates of different components, over the cells where floods
// from both meet.
struct ShortestPath {
    std::int32_t component[2] = {-1, -1};  // ascending
    std::int32_t candidate[2] = {-1, -1};  // ascending
    std::int32_t length = 0;               // steps of 10 and 14
    std::int64_t meets_at = -1;            // cell, and the direction of its neighbour
    std::int32_t direction = 0;
    std::vector<std::int64_t> cells;  // from candidate to candidate

    std::pair<std::int32_t, std::int32_t> components() const {
        return {component[0], component[1]};
    }
    std::pair<std::int32_t, std::int32_t> candidates() const {
        return {candidate[0], candidate[1]};
    }
    auto order() const { return std::tuple(length, meets_at, direction); }
};
// work/.../paths-TILE.h5, paths.h5.
void write_paths(const std::filesystem::path& path, const std::string& key,
                 const std::vector<ShortestPath>& paths);
std::vector<ShortestPath> read_paths(const std::filesystem::path& path);

// A candidate between the ends of a path.
struct Connector {
    Vec2d at{0, 0};
    std::int64_t cell = -1;  // or none
};
// Whether a path can be covered with connectors that overlap enough, one after another; and they.
struct Connection {
    bool good = false;
    std::vector<Connector> connectors;
};
// work/.../connectors-NUMBER.h5.
void write_connections(const std::filesystem::path& path, const std::string& key,
                       const std::vector<Connection>& connections);
std::vector<Connection> read_connections(const std::filesystem::path& path);

}  // namespace vfplan
