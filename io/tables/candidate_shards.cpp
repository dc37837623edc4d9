#include "io/tables/candidate_shards.h"

#include "io/columns.h"
#include "io/h5_reader.h"
#include "kernels/index.h"

namespace vfplan {

void write_found_tile(const std::filesystem::path& path, const std::string& key,
                      const FoundTile& tile) {
    h5::Writer file = begin_shard(path, key);
    file.write("cell", column<std::int64_t>(tile.candidates,
                                            [](const FoundCandidate& c) { return c.cell; }));
    file.write("kind", column<std::uint8_t>(tile.candidates,
                                            [](const FoundCandidate& c) { return c.kind; }));
    file.write("covered", tile.covered);
    file.attribute("/", "short_of_overlap", tile.short_of_overlap);
    finish_shard(file);
}

std::vector<FoundCandidate> FoundTiles::candidates() const {
    std::vector<FoundCandidate> out;
    for (std::int64_t tile = 0; tile < tiles_; ++tile) {
        const h5::Reader file(names_.one(tile));
        const auto cell = file.read<std::int64_t>("cell");
        const auto kind = file.read<std::uint8_t>("kind");
        for (std::size_t i = 0; i < cell.size(); ++i) {
            out.push_back({cell[i], static_cast<CandidateKind>(kind[i])});
        }
    }
    return out;
}

void FoundTiles::mark_covered(std::vector<bool>& pieces) const {
    for (std::int64_t tile = 0; tile < tiles_; ++tile) {
        const h5::Reader file(names_.one(tile));
        for (const std::int32_t p : file.read<std::int32_t>("covered")) pieces[idx(p)] = true;
    }
}

std::int64_t FoundTiles::short_of_overlap() const {
    std::int64_t sum = 0;
    for (std::int64_t tile = 0; tile < tiles_; ++tile) {
        sum +=
            static_cast<std::int64_t>(h5::Reader(names_.one(tile)).number("/", "short_of_overlap"));
    }
    return sum;
}

void write_rescue_tile(const std::filesystem::path& path, const std::string& key,
                       const RescueTile& tile) {
    std::vector<std::int64_t> covers_begin = {0};
    std::vector<std::int32_t> covers_piece;
    for (const std::vector<std::int32_t>& row : tile.covers) {
        covers_piece.insert(covers_piece.end(), row.begin(), row.end());
        covers_begin.push_back(static_cast<std::int64_t>(covers_piece.size()));
    }
    h5::Writer file = begin_shard(path, key);
    file.write("piece", tile.piece);
    file.write("piece_cell", tile.piece_cell);
    file.write("cell", tile.cell);
    file.write("covers_begin", covers_begin);
    file.write("covers_piece", covers_piece);
    finish_shard(file);
}

RescueTile read_rescue_tile(const std::filesystem::path& path) {
    const h5::Reader file(path);
    RescueTile tile;
    tile.piece = file.read<std::int32_t>("piece");
    tile.piece_cell = file.read<std::int64_t>("piece_cell");
    tile.cell = file.read<std::int64_t>("cell");
    const auto begin = file.read<std::int64_t>("covers_begin");
    const auto piece = file.read<std::int32_t>("covers_piece");
    for (std::size_t i = 0; i < tile.cell.size(); ++i) {
        tile.covers.emplace_back(piece.begin() + begin[i], piece.begin() + begin[i + 1]);
    }
    return tile;
}

}  // namespace vfplan
