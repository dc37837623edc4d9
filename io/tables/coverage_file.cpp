#include "io/tables/coverage_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/checksum.h"
#include "io/columns.h"
#include "io/files.h"
#include "io/tables/crs.h"
#include "io/tables/shard.h"
#include "io/tables/shard_index.h"
#include "io/tables/sound.h"
#include "io/tables/wall_columns.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr const char* frame = "m, site frame: input coordinates minus the origin in crs";

void write_candidates(h5::Writer& file, const std::vector<Candidate>& c) {
    file.group("candidates");
    file.attribute("candidates", "units", frame);
    file.write("candidates/x", column<double>(c, [](const Candidate& k) { return k.at.x(); }));
    file.write("candidates/y", column<double>(c, [](const Candidate& k) { return k.at.y(); }));
    file.write("candidates/cell",
               column<std::int64_t>(c, [](const Candidate& k) { return k.cell; }));
    file.write("candidates/vf", column<float>(c, [](const Candidate& k) { return k.vf_rad; }));
    write_codes(file, "candidates/kind",
                column<CandidateKind>(c, [](const Candidate& k) { return k.kind; }));
}

std::vector<Candidate> read_points(const h5::Reader& file) {
    const auto x = file.read<double>("candidates/x");
    const auto y = file.read<double>("candidates/y");
    const auto cell = file.read<std::int64_t>("candidates/cell");
    const auto vf = file.read<float>("candidates/vf");
    const auto kind = file.read<std::uint8_t>("candidates/kind");
    sound::finite(file, "candidates/x", x);
    sound::finite(file, "candidates/y", y);
    sound::count(file, "candidates/y", y, x.size());
    sound::count(file, "candidates/cell", cell, x.size());
    sound::count(file, "candidates/vf", vf, x.size());
    sound::count(file, "candidates/kind", kind, x.size());
    sound::codes<CandidateKind>(file, "candidates/kind", kind);
    std::vector<Candidate> out;
    out.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        out.push_back({{x[i], y[i]}, cell[i], static_cast<CandidateKind>(kind[i]), vf[i]});
    }
    return out;
}

// A county has twenty million pieces: some walls' at a time.
void write_pieces(h5::Writer& file, const std::vector<Wall>& walls, const Pieces& pieces,
                  const std::vector<PieceStatus>& status) {
    const auto count = static_cast<std::uint64_t>(pieces.size());
    file.group("pieces");
    file.begin<std::int32_t>("pieces/wall", count);
    file.begin<std::uint8_t>("pieces/side", count);
    file.begin<double>("pieces/s0_m", count);
    file.begin<double>("pieces/s1_m", count);
    constexpr std::size_t at_once = 1U << 18;
    std::vector<std::int32_t> wall;
    std::vector<std::uint8_t> side;
    std::vector<double> s0;
    std::vector<double> s1;
    std::vector<std::int32_t> on_side[2];
    const auto flush = [&] {
        file.append("pieces/wall", wall);
        file.append("pieces/side", side);
        file.append("pieces/s0_m", s0);
        file.append("pieces/s1_m", s1);
        wall.clear();
        side.clear();
        s0.clear();
        s1.clear();
    };
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const auto number = static_cast<std::int32_t>(w);
        const double length = walls[w].length_m();
        for (const Side s : {left, right}) {
            const std::int32_t n = pieces.count(number, s);
            on_side[s].push_back(n);
            for (std::int32_t k = 0; k < n; ++k) {
                wall.push_back(number);
                side.push_back(s);
                s0.push_back(piece_begin_m(length, k, n));
                s1.push_back(piece_begin_m(length, k + 1, n));
            }
        }
        if (wall.size() >= at_once) flush();
    }
    flush();
    file.attribute("pieces/side", "meaning", "0 left of the wall as it runs, 1 right");
    write_codes(file, "pieces/status", status);
    file.write("walls/pieces_left", on_side[left]);
    file.write("walls/pieces_right", on_side[right]);
}

// What blocks of rows hold together.
struct RowsOfBlocks {
    std::vector<Candidate> candidates;
    std::vector<std::int64_t> begin = {0};
    std::vector<std::uint64_t> entries;  // of each block
};

// Calls covered(piece) for each entry, of so many pieces.
template <class Covered>
RowsOfBlocks rows_of(const std::vector<std::filesystem::path>& blocks, std::int64_t pieces,
                     const Covered& covered) {
    RowsOfBlocks out;
    for (const std::filesystem::path& block : blocks) {
        const h5::Reader file(block);
        const std::vector<Candidate> some = read_points(file);
        out.candidates.insert(out.candidates.end(), some.begin(), some.end());
        const auto indptr = file.read<std::int64_t>("coverage/indptr");
        const auto indices = file.read<std::int32_t>("coverage/indices");
        sound::offsets(file, "coverage/indptr", indptr, some.size(), 0,
                       static_cast<std::int64_t>(indices.size()));
        sound::range(file, "coverage/indices", indices, 0, pieces);
        const std::int64_t before = out.begin.back();
        for (std::size_t i = 1; i < indptr.size(); ++i) out.begin.push_back(before + indptr[i]);
        out.entries.push_back(indices.size());
        for (const std::int32_t p : indices) covered(p);
    }
    return out;
}

// A column of the table as its blocks make it up.
std::vector<h5::Source> sources_of(const std::vector<std::filesystem::path>& blocks,
                                   const std::vector<std::uint64_t>& entries, const char* name) {
    std::vector<h5::Source> out;
    std::uint64_t from = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (entries[b] > 0) {
            out.push_back(
                {name_in_index(blocks[b]), std::string("coverage/") + name, {from}, {entries[b]}});
        }
        from += entries[b];
    }
    return out;
}

// Entries of an index.
std::uint64_t entries_in(const h5::Reader& file) {
    const h5::Dims dims = file.dims("coverage/indices");
    if (dims.size() != 1) file.fail("coverage/indices is no column");
    return dims[0];
}

void write_rows(h5::Writer& file, const RowsOfBlocks& rows,
                const std::vector<std::filesystem::path>& blocks, std::int64_t pieces) {
    write_candidates(file, rows.candidates);
    file.group("coverage");
    file.attribute("coverage", "encoding-type", "csr_matrix");
    file.attribute("coverage", "encoding-version", "0.1.0");
    file.attribute(
        "coverage", "shape",
        std::vector<std::int64_t>{static_cast<std::int64_t>(rows.candidates.size()), pieces});
    file.write("coverage/indptr", rows.begin);
    const auto whole = static_cast<std::uint64_t>(rows.begin.back());
    file.write_virtual<std::int32_t>("coverage/indices", {whole},
                                     sources_of(blocks, rows.entries, "indices"), -1);
    file.write_virtual<float>("coverage/data", {whole}, sources_of(blocks, rows.entries, "data"),
                              0);
    file.write_virtual<float>("coverage/angle_rad", {whole},
                              sources_of(blocks, rows.entries, "angle_rad"), 0);
}

}  // namespace

void write_coverage_block(const std::filesystem::path& path, const std::string& key,
                          const CoverageBlock& block) {
    h5::Writer file = begin_shard(path, key);
    write_candidates(file, block.candidates);
    const CoverageTable& t = block.table;
    file.group("coverage");
    file.write("coverage/indptr", t.begin);
    file.write("coverage/indices",
               column<std::int32_t>(t.seen, [](const Seen& s) { return s.piece; }));
    file.write("coverage/data", column<float>(t.seen, [](const Seen& s) { return s.fraction; }));
    file.write("coverage/angle_rad",
               column<float>(t.seen, [](const Seen& s) { return s.angle_rad; }));
    finish_shard(file);
}

void write_coverage_index(const std::filesystem::path& path, const std::vector<Wall>& walls,
                          const Pieces& pieces, const std::vector<std::filesystem::path>& blocks,
                          const CoverageInfo& info) {
    std::vector<PieceStatus> status(idx(pieces.size()), PieceStatus::no_viewpoint);
    const RowsOfBlocks rows = rows_of(
        blocks, pieces.size(), [&](std::int32_t p) { status[idx(p)] = PieceStatus::covered; });
    h5::Writer file = begin_table(path, "coverage table: candidates x pieces", info.key);
    file.attribute("/", "summary", info.summary);
    write_crs(file, info.crs_wkt, info.origin);
    file.group("walls");
    file.attribute("walls", "units", frame);
    write_walls(file, "walls", walls);
    write_pieces(file, walls, pieces, status);
    write_rows(file, rows, blocks, pieces.size());
    write_apart(file, info.apart);
    write_shard_list(file, blocks);
    finish_table(file);
}

void write_pool_index(const std::filesystem::path& path,
                      const std::vector<std::filesystem::path>& blocks, const std::string& key,
                      std::int64_t pieces) {
    const RowsOfBlocks rows = rows_of(blocks, pieces, [](std::int32_t) {});
    h5::Writer file =
        begin_table(path, "more candidates, off the ridges: candidates x pieces", key);
    write_rows(file, rows, blocks, pieces);
    write_shard_list(file, blocks);
    finish_table(file);
}

namespace {

// Candidates and rows of an index, behind what the tables have already; its parts are looked at.
void add_rows(const h5::Reader& file, const std::filesystem::path& path, CoverageTables& t) {
    check_shards(path);
    const std::vector<Candidate> some = read_points(file);
    t.candidates.insert(t.candidates.end(), some.begin(), some.end());
    const auto indptr = file.read<std::int64_t>("coverage/indptr");
    sound::offsets(file, "coverage/indptr", indptr, some.size(), 0,
                   static_cast<std::int64_t>(entries_in(file)));
    const std::int64_t before = t.begin.back();
    for (std::size_t i = 1; i < indptr.size(); ++i) t.begin.push_back(before + indptr[i]);
}

}  // namespace

CoverageTables read_coverage(const std::filesystem::path& path) {
    const h5::Reader file(path);
    check_version(file, path);
    CoverageTables t;
    t.key = file.text("/", "key");
    t.summary = file.text("/", "summary");
    t.crs_wkt = read_crs(file, t.origin);
    t.walls = read_walls(file, "walls");
    const auto on_left = file.read<std::int32_t>("walls/pieces_left");
    const auto on_right = file.read<std::int32_t>("walls/pieces_right");
    const auto status = file.read<std::uint8_t>("pieces/status");
    sound::count(file, "walls/pieces_left", on_left, t.walls.size());
    sound::count(file, "walls/pieces_right", on_right, t.walls.size());
    sound::codes<PieceStatus>(file, "pieces/status", status);
    std::int64_t pieces = 0;
    for (std::size_t w = 0; w < t.walls.size(); ++w) {
        pieces += std::int64_t{on_left[w]} + on_right[w];
        sound::need(file,
                    on_left[w] >= 0 && on_right[w] >= 0 &&
                        pieces <= static_cast<std::int64_t>(status.size()),
                    "walls/pieces_left", "and pieces_right have other pieces than pieces/status");
        t.pieces.add_wall(t.walls[w].length_m(), on_left[w], on_right[w]);
    }
    sound::count(file, "pieces/status", status, static_cast<std::size_t>(pieces));
    t.status = column<PieceStatus>(status, [](std::uint8_t v) { return v; });
    add_rows(file, path, t);
    t.apart = read_apart(file);
    return t;
}

CoverageEntries::CoverageEntries(const std::filesystem::path& path) {
    pieces_ = static_cast<std::int64_t>(h5::Reader(path).dims("pieces/status").at(0));
    add(path);
}

void CoverageEntries::add(const std::filesystem::path& path) {
    const h5::Reader file(path);
    const std::vector<std::filesystem::path> shards = check_shards(path);
    // Blocks without entries are no parts of the whole, so the parts tell which they are.
    const std::vector<h5::Source> indices = file.sources("coverage/indices");
    std::vector<std::uint64_t> entries(shards.size(), 0);
    std::size_t shard = 0;
    for (const h5::Source& source : indices) {
        while (shard < shards.size() && name_in_index(shards[shard]) != source.file) ++shard;
        if (shard == shards.size()) file.fail("coverage/indices consists of no shards of its own");
        entries[shard] = source.shape.at(0);
    }
    for (const char* name : {"indices", "data", "angle_rad"}) {
        check_sources(file, std::string("coverage/") + name, sources_of(shards, entries, name));
    }
    const auto indptr = file.read<std::int64_t>("coverage/indptr");
    sound::offsets(file, "coverage/indptr", indptr, indptr.empty() ? 0 : indptr.size() - 1, 0,
                   static_cast<std::int64_t>(entries_in(file)));
    std::int64_t from = begin_.back();
    for (std::size_t i = 1; i < indptr.size(); ++i) begin_.push_back(from + indptr[i]);
    for (std::size_t i = 0; i < shards.size(); ++i) {
        const auto count = static_cast<std::int64_t>(entries[i]);
        if (count > 0) parts_.push_back({shards[i], from, count});
        from += count;
    }
}

template <class T, class Check>
std::vector<T> CoverageEntries::read(const char* name, std::int64_t from, std::int64_t count,
                                     const Check& check) const {
    std::vector<T> out;
    out.reserve(idx(count));
    const auto after = std::upper_bound(parts_.begin(), parts_.end(), from,
                                        [](std::int64_t v, const Part& p) { return v < p.begin; });
    for (auto part = after == parts_.begin() ? after : after - 1; part != parts_.end(); ++part) {
        const std::int64_t first = std::max<std::int64_t>(0, from - part->begin);
        const std::int64_t end = std::min(part->count, from + count - part->begin);
        if (part->begin >= from + count) break;
        if (first >= end) continue;
        const h5::Reader file(part->shard);
        const std::vector<T> some =
            file.read<T>(std::string("coverage/") + name, static_cast<std::uint64_t>(first),
                         static_cast<std::uint64_t>(end - first));
        check(file, some);
        out.insert(out.end(), some.begin(), some.end());
    }
    return out;
}

std::vector<std::int32_t> CoverageEntries::pieces(std::int64_t from, std::int64_t count) const {
    const auto out = read<std::int32_t>(
        "indices", from, count, [&](const h5::Reader& file, const std::vector<std::int32_t>& some) {
            sound::range(file, "coverage/indices", some, 0, pieces_);
        });
    auto row = std::upper_bound(begin_.begin(), begin_.end(), from);
    for (std::size_t i = 1; i < out.size(); ++i) {
        const std::int64_t at = from + static_cast<std::int64_t>(i);
        while (row != begin_.end() && *row < at) ++row;
        if (out[i - 1] < out[i] || (row != begin_.end() && *row == at)) continue;
        damaged(parts_.front().shard.parent_path(), "rows whose pieces do not ascend");
    }
    return out;
}

std::vector<float> CoverageEntries::fractions(std::int64_t from, std::int64_t count) const {
    return read<float>("data", from, count, [](const h5::Reader& file, const auto& some) {
        sound::finite(file, "coverage/data", some, 1 + 1e-6);
    });
}

std::vector<float> CoverageEntries::angles_rad(std::int64_t from, std::int64_t count) const {
    return read<float>("angle_rad", from, count, [](const h5::Reader& file, const auto& some) {
        sound::finite(file, "coverage/angle_rad", some, 6.3);  // a whole turn
    });
}

Candidates read_candidates(const std::filesystem::path& dir, CandidatePool pool) {
    const std::filesystem::path axis = dir / coverage_name;
    Candidates out{read_coverage(axis), CoverageEntries(axis)};
    if (pool == CandidatePool::axis) return out;
    const std::filesystem::path more = dir / pool_name;
    if (!is_there(more)) {
        throw IoError(
            fmt::format("{}: missing, and plan.candidates = \"pool\" needs it; run the job "
                        "again and it is made, or plan with plan.candidates=axis",
                        more.string()));
    }
    const h5::Reader file(more);
    check_version(file, more);
    out.tables.pool = pool;
    add_rows(file, more, out.tables);
    out.entries.add(more);
    return out;
}

}  // namespace vfplan
