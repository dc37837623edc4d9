// Walls as columns of a group, as site.h5 and coverage.h5 have them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "io/h5_writer.h"
#include "kernels/wall.h"

namespace vfplan {

// All columns of walls in a group, begun for `count` of them; append() adds some.
class WallColumns {
public:
    WallColumns(h5::Writer& file, const std::string& group, std::uint64_t count,
                std::uint64_t chunk);
    void append(const std::vector<Wall>& walls);

private:
    h5::Writer& file_;
    std::string group_;
};

// All at once, with what their codes mean.
void write_walls(h5::Writer& file, const std::string& group, const std::vector<Wall>& walls);
std::vector<Wall> read_walls(const h5::Reader& file, const std::string& group);
// `count` of them from `from` on.
std::vector<Wall> read_walls(const h5::Reader& file, const std::string& group, std::uint64_t from,
                             std::uint64_t count);

}  // namespace vfplan
