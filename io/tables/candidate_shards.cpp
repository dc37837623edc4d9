#include "io/tables/candidate_shards.h"

#include <numeric>

#include "io/columns.h"
#include "io/h5_reader.h"
#include "io/tables/sound.h"
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
        sound::count(file, "kind", kind, cell.size());
        sound::codes<CandidateKind>(file, "kind", kind);
        for (std::size_t i = 0; i < cell.size(); ++i) {
            out.push_back({cell[i], static_cast<CandidateKind>(kind[i])});
        }
    }
    return out;
}

void FoundTiles::mark_covered(std::vector<bool>& pieces) const {
    for (std::int64_t tile = 0; tile < tiles_; ++tile) {
        const h5::Reader file(names_.one(tile));
        const auto covered = file.read<std::int32_t>("covered");
        sound::range(file, "covered", covered, 0, static_cast<std::int64_t>(pieces.size()));
        for (const std::int32_t p : covered) pieces[idx(p)] = true;
    }
}

std::int64_t FoundTiles::short_of_overlap() const {
    std::int64_t sum = 0;
    for (std::int64_t tile = 0; tile < tiles_; ++tile) {
        sum += h5::Reader(names_.one(tile)).whole("/", "short_of_overlap");
    }
    return sum;
}

namespace {

void add_rows(h5::Writer& file, const CellRows& rows, const std::string& group = "") {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> piece;
    for (const std::vector<std::int32_t>& row : rows.covers) {
        piece.insert(piece.end(), row.begin(), row.end());
        begin.push_back(static_cast<std::int64_t>(piece.size()));
    }
    file.write(group + "cell", rows.cell);
    file.write(group + "covers_begin", begin);
    file.write(group + "covers_piece", piece);
}

CellRows rows_in(const h5::Reader& file, const std::string& group = "") {
    CellRows out;
    out.cell = file.read<std::int64_t>(group + "cell");
    const auto begin = file.read<std::int64_t>(group + "covers_begin");
    const auto piece = file.read<std::int32_t>(group + "covers_piece");
    sound::offsets(file, group + "covers_begin", begin, out.cell.size(), 0,
                   static_cast<std::int64_t>(piece.size()));
    sound::range(file, group + "covers_piece", piece, 0, std::int64_t{1} << 31);
    for (std::size_t i = 0; i < out.cell.size(); ++i) {
        out.covers.emplace_back(piece.begin() + begin[i], piece.begin() + begin[i + 1]);
    }
    return out;
}

}  // namespace

void write_pool_squares(const std::filesystem::path& path, const std::string& key,
                        const std::vector<PoolSquare>& squares) {
    h5::Writer file = begin_shard(path, key);
    for (CellRows PoolSquare::*const part : {&PoolSquare::taken, &PoolSquare::again}) {
        CellRows all;
        std::vector<std::int64_t> count;
        for (const PoolSquare& square : squares) {
            const CellRows& some = square.*part;
            all.cell.insert(all.cell.end(), some.cell.begin(), some.cell.end());
            all.covers.insert(all.covers.end(), some.covers.begin(), some.covers.end());
            count.push_back(static_cast<std::int64_t>(some.cell.size()));
        }
        const std::string group = part == &PoolSquare::taken ? "taken" : "again";
        file.group(group);
        file.write(group + "/count", count);
        add_rows(file, all, group + "/");
    }
    finish_shard(file);
}

std::vector<PoolSquare> read_pool_squares(const std::filesystem::path& path) {
    const h5::Reader file(path);
    std::vector<PoolSquare> out;
    for (CellRows PoolSquare::*const part : {&PoolSquare::taken, &PoolSquare::again}) {
        const std::string group = part == &PoolSquare::taken ? "taken/" : "again/";
        const auto count = file.read<std::int64_t>(group + "count");
        CellRows all = rows_in(file, group);
        sound::range(file, group + "count", count, 0,
                     static_cast<std::int64_t>(all.cell.size()) + 1);
        sound::need(file,
                    std::accumulate(count.begin(), count.end(), std::int64_t{0}) ==
                            static_cast<std::int64_t>(all.cell.size()) &&
                        (out.empty() || out.size() == count.size()),
                    group + "count", "has other cells than there are");
        out.resize(count.size());
        std::size_t i = 0;
        for (std::size_t square = 0; square < count.size(); ++square) {
            CellRows& some = out[square].*part;
            for (std::int64_t k = 0; k < count[square]; ++k, ++i) {
                some.cell.push_back(all.cell[i]);
                some.covers.push_back(std::move(all.covers[i]));
            }
        }
    }
    return out;
}

CellRows read_taken(const std::filesystem::path& path) {
    return rows_in(h5::Reader(path), "taken/");
}

void write_weights(const std::filesystem::path& path, const std::string& key,
                   const std::vector<std::int64_t>& weight) {
    h5::Writer file = begin_shard(path, key);
    file.write("weight", weight);
    finish_shard(file);
}

std::vector<std::int64_t> read_weights(const std::filesystem::path& path) {
    return h5::Reader(path).read<std::int64_t>("weight");
}

void write_rescue_tile(const std::filesystem::path& path, const std::string& key,
                       const RescueTile& tile) {
    h5::Writer file = begin_shard(path, key);
    file.write("piece", tile.piece);
    file.write("piece_cell", tile.piece_cell);
    add_rows(file, tile.cells);
    finish_shard(file);
}

RescueTile read_rescue_tile(const std::filesystem::path& path) {
    const h5::Reader file(path);
    RescueTile out{file.read<std::int32_t>("piece"), file.read<std::int64_t>("piece_cell"),
                   rows_in(file)};
    sound::range(file, "piece", out.piece, 0, std::int64_t{1} << 31);
    sound::count(file, "piece_cell", out.piece_cell, out.piece.size());
    return out;
}

}  // namespace vfplan
