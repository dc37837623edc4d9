#include "engine/tile_shards.h"

#include <algorithm>
#include <bit>

#include "io/columns.h"
#include "kernels/index.h"

namespace vfplan {

void write_tile_candidates(const Work& work, const std::filesystem::path& path,
                           const std::vector<TileCandidate>& candidates,
                           const std::vector<std::int32_t>& covered, std::int64_t falls_short) {
    h5::Writer file = shard_writer(path, work.key);
    file.write("cell",
               column<std::int64_t>(candidates, [](const TileCandidate& c) { return c.cell; }));
    file.write("kind",
               column<std::uint8_t>(candidates, [](const TileCandidate& c) { return c.kind; }));
    file.write("covered", covered);
    file.attribute("/", "falls_short", falls_short);
    finish_shard(file);
}

std::vector<TileCandidate> read_tile_candidates(const std::filesystem::path& path) {
    const h5::Reader file(path);
    const auto cell = file.read<std::int64_t>("cell");
    const auto kind = file.read<std::uint8_t>("kind");
    std::vector<TileCandidate> out;
    for (std::size_t i = 0; i < cell.size(); ++i) {
        out.push_back({cell[i], static_cast<CandidateKind>(kind[i])});
    }
    return out;
}

std::vector<std::int32_t> covered_from(const Work& work,
                                       const std::vector<TileCandidate>& candidates,
                                       const std::vector<Vec2d>& points) {
    std::vector<Vec2d> eyes = points;
    for (const TileCandidate& c : candidates) eyes.push_back(work.layout().grid.centre(c.cell));
    // Some hundred eyes at a time, so that their rows need little memory.
    constexpr std::size_t at_once = 512;
    std::vector<std::uint64_t> bits(at(work.store.facts().pieces) / 64 + 1, 0);
    for (std::size_t from = 0; from < eyes.size(); from += at_once) {
        const std::vector<Vec2d> some(
            eyes.begin() + static_cast<std::ptrdiff_t>(from),
            eyes.begin() + static_cast<std::ptrdiff_t>(std::min(eyes.size(), from + at_once)));
        std::vector<std::vector<SeenLength>> seen(some.size());
        work.scenes.each(work.threads, some, [&](std::size_t i, const Scene& scene) {
            seen[i] = scene.look(some[i]).seen;
        });
        for (const auto& row : seen) {
            for (const SeenLength& s : row) bits[at(s.piece) / 64] |= 1ULL << at(s.piece) % 64;
        }
    }
    std::vector<std::int32_t> out;
    for (std::size_t word = 0; word < bits.size(); ++word) {
        for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
            out.push_back(static_cast<std::int32_t>(64 * word) + std::countr_zero(left));
        }
    }
    return out;
}

CoveredPieces covered_pieces(const Work& work, std::initializer_list<const char*> phases) {
    CoveredPieces out(at(work.store.facts().pieces), false);
    for (const char* phase : phases) {
        for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
            const h5::Reader file(work.passing(phase, tile));
            for (const std::int32_t p : file.read<std::int32_t>("covered")) out[at(p)] = true;
        }
    }
    return out;
}

}  // namespace vfplan
