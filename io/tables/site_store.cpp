#include "io/tables/site_store.h"

#include <limits>

#include "io/columns.h"
#include "io/tables/shard.h"
#include "io/tables/sound.h"
#include "io/tables/wall_columns.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::uint64_t short_chunk = 1U << 13;  // patches are read one by one
constexpr std::size_t at_once = 1U << 20;        // walls that are gathered before they are written

constexpr std::int64_t no_end = std::int64_t{1} << 31;
constexpr std::int32_t largest_side = 1 << 30;

std::vector<double> flat(const std::vector<Vec2d>& points) {
    std::vector<double> out;
    for (const Vec2d& p : points) out.insert(out.end(), {p.x(), p.y()});
    return out;
}

std::vector<Vec2d> points(const std::vector<double>& flat) {
    std::vector<Vec2d> out;
    for (std::size_t i = 0; i + 1 < flat.size(); i += 2) out.emplace_back(flat[i], flat[i + 1]);
    return out;
}

}  // namespace

std::filesystem::path site_store_path(const std::filesystem::path& dir) {
    return dir / "work" / "site.h5";
}

void write_site_store(const std::filesystem::path& path, const std::string& key,
                      const Layout& layout, const SiteFacts& facts, const std::vector<Wall>& walls,
                      const Pieces& pieces, const NearWalls& near,
                      const std::vector<CellBits>& free_bits) {
    h5::Writer file = begin_shard(path, key);
    file.attribute("/", "crs_wkt", facts.crs_wkt);
    file.attribute("/", "summary", facts.summary);
    for (const auto& [name, value] : {std::pair{"buildings", facts.buildings},
                                      {"walls", facts.walls},
                                      {"pieces", facts.pieces},
                                      {"free_cells", facts.free_cells}}) {
        file.attribute("/", name, value);
    }
    file.write("frame", std::vector<double>{
                            facts.origin.x(), facts.origin.y(), facts.extent.min.x(),
                            facts.extent.min.y(), facts.extent.max.x(), facts.extent.max.y(),
                            layout.grid.origin.x(), layout.grid.origin.y(), layout.grid.cell_m});
    file.write("required", flat(facts.required));
    file.write("existing", flat(facts.existing));
    file.write("layout",
               std::vector<std::int32_t>{layout.grid.nx, layout.grid.ny, layout.patch_cells});
    file.group("walls");
    write_walls(file, "walls", walls);
    std::vector<std::int32_t> per_side(walls.size());
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const auto wall = static_cast<std::int32_t>(w);
        per_side[w] = std::max(pieces.count(wall, left), pieces.count(wall, right));
    }
    file.write("walls/pieces_per_side", per_side);

    file.group("patches");
    file.write("patches/wall_begin", near.begin);
    const auto count = static_cast<std::uint64_t>(near.wall.size());
    file.begin<std::int32_t>("patches/number", count, short_chunk);
    file.begin<std::int32_t>("patches/first_left", count, short_chunk);
    file.begin<std::int32_t>("patches/first_right", count, short_chunk);
    file.begin<std::int32_t>("patches/pieces_per_side", count, short_chunk);
    WallColumns columns(file, "patches", count, short_chunk);
    for (std::size_t from = 0; from < near.wall.size(); from += at_once) {
        const std::size_t to = std::min(near.wall.size(), from + at_once);
        const std::vector<std::int32_t> some(near.wall.begin() + static_cast<std::ptrdiff_t>(from),
                                             near.wall.begin() + static_cast<std::ptrdiff_t>(to));
        file.append("patches/number", some);
        const auto first = [&](Side side) {
            return column<std::int32_t>(some, [&](std::int32_t w) {
                return pieces.count(w, side) > 0 ? pieces.first(w, side) : -1;
            });
        };
        file.append("patches/first_left", first(left));
        file.append("patches/first_right", first(right));
        file.append("patches/pieces_per_side",
                    column<std::int32_t>(some, [&](std::int32_t w) { return per_side[idx(w)]; }));
        std::vector<Wall> of_them;
        of_them.reserve(some.size());
        for (const std::int32_t w : some) of_them.push_back(walls[idx(w)]);
        columns.append(of_them);
    }
    std::vector<std::int64_t> bits_begin = {0};
    for (const CellBits& bits : free_bits) {
        bits_begin.push_back(bits_begin.back() + static_cast<std::int64_t>(bits.size()));
    }
    file.write("patches/bits_begin", bits_begin);
    file.begin<std::uint8_t>("patches/standable", static_cast<std::uint64_t>(bits_begin.back()),
                             short_chunk);
    for (const CellBits& bits : free_bits) file.append("patches/standable", bits);
    finish_shard(file);
}

SiteStore::SiteStore(const std::filesystem::path& path, std::int64_t tile_cells) : file_(path) {
    const auto frame = file_.read<double>("frame");
    const auto sizes = file_.read<std::int32_t>("layout");
    if (frame.size() != 9 || sizes.size() != 3) {
        throw IoError(path.string() + ": not a site of this version; run the job with --fresh");
    }
    const auto whole = [&](const char* name) { return file_.whole("/", name, 0, no_end); };
    sound::finite(file_, "frame", frame);
    sound::need(
        file_,
        frame[8] > 0 && sizes[0] > 0 && sizes[1] > 0 && sizes[2] > 0 &&
            std::max(sizes[0], sizes[1]) <= std::numeric_limits<std::int32_t>::max() - sizes[2],
        "layout", "is no grid");
    facts_.origin = {frame[0], frame[1]};
    facts_.extent = {{frame[2], frame[3]}, {frame[4], frame[5]}};
    for (auto&& [name, to] :
         {std::pair{"required", &facts_.required}, {"existing", &facts_.existing}}) {
        const auto flat = file_.read<double>(name);
        sound::finite(file_, name, flat);
        *to = points(flat);
    }
    layout_ = {{{frame[6], frame[7]}, frame[8], sizes[0], sizes[1]},
               sizes[2],
               static_cast<std::int32_t>(tile_cells)};
    facts_.crs_wkt = file_.text("/", "crs_wkt");
    facts_.summary = file_.text("/", "summary");
    facts_.buildings = whole("buildings");
    facts_.walls = whole("walls");
    facts_.pieces = whole("pieces");
    facts_.free_cells = file_.whole("/", "free_cells");
    const auto patches = idx(layout_.patches());
    const auto end = [&](const char* name) {
        return static_cast<std::int64_t>(file_.dims(name).at(0));
    };
    wall_begin_ = file_.read<std::int64_t>("patches/wall_begin");
    bits_begin_ = file_.read<std::int64_t>("patches/bits_begin");
    sound::offsets(file_, "patches/wall_begin", wall_begin_, patches, 0, end("patches/number"));
    sound::offsets(file_, "patches/bits_begin", bits_begin_, patches, 0, end("patches/standable"));
    for (std::size_t p = 0; p < patches; ++p) {
        const std::int64_t cells = layout_.patch_window(static_cast<std::int64_t>(p)).size();
        sound::need(file_, 8 * (bits_begin_[p + 1] - bits_begin_[p]) >= cells, "patches/standable",
                    "has too few cells");
    }
}

bool SiteStore::has_walls(std::int64_t patch) const {
    return wall_begin_[idx(patch) + 1] > wall_begin_[idx(patch)];
}

PatchSite SiteStore::patch(std::int64_t patch) const {
    const auto from = static_cast<std::uint64_t>(wall_begin_[idx(patch)]);
    const auto count = static_cast<std::uint64_t>(wall_begin_[idx(patch) + 1]) - from;
    PatchSite out;
    out.walls = read_walls(file_, "patches", from, count);
    out.number = file_.read<std::int32_t>("patches/number", from, count);
    out.first[left] = file_.read<std::int32_t>("patches/first_left", from, count);
    out.first[right] = file_.read<std::int32_t>("patches/first_right", from, count);
    out.count = file_.read<std::int32_t>("patches/pieces_per_side", from, count);
    sound::range(file_, "patches/number", out.number, 0, facts_.walls);
    sound::range(file_, "patches/pieces_per_side", out.count, 0, facts_.pieces + 1);
    for (const Side side : {left, right}) {
        sound::range(file_, "patches/first", out.first[side], -1, facts_.pieces);
        for (std::size_t i = 0; i < count; ++i) {
            sound::need(file_, out.first[side][i] + out.count[i] <= facts_.pieces,
                        "patches/pieces_per_side", "goes beyond the pieces");
        }
    }
    return out;
}

Raster<std::uint8_t> SiteStore::standable(std::int64_t patch) const {
    const auto from = static_cast<std::uint64_t>(bits_begin_[idx(patch)]);
    const auto count = static_cast<std::uint64_t>(bits_begin_[idx(patch) + 1]) - from;
    const auto bits = file_.read<std::uint8_t>("patches/standable", from, count);
    Raster<std::uint8_t> out(idx(layout_.patch_window(patch).size()));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = bits[i / 8] >> (i % 8) & 1U;
    return out;
}

Raster<std::uint8_t> SiteStore::standable(const Window& window) const {
    Raster<std::uint8_t> out(idx(window.size()), 0);
    const auto width = idx(window.x_end - window.x_begin);
    for (const std::int64_t patch : layout_.patches_in(window)) {
        const Raster<std::uint8_t> cells = standable(patch);
        const Window p = layout_.patch_window(patch);
        for (std::int32_t y = std::max(p.y_begin, window.y_begin);
             y < std::min(p.y_end, window.y_end); ++y) {
            const std::int32_t x0 = std::max(p.x_begin, window.x_begin);
            const std::int32_t x1 = std::min(p.x_end, window.x_end);
            const auto from = cells.begin() +
                              static_cast<std::ptrdiff_t>(y - p.y_begin) * (p.x_end - p.x_begin) +
                              (x0 - p.x_begin);
            std::copy(from, from + (x1 - x0),
                      out.begin() + static_cast<std::ptrdiff_t>(idx(y - window.y_begin) * width) +
                          (x0 - window.x_begin));
        }
    }
    return out;
}

std::vector<Wall> SiteStore::all_walls() const { return read_walls(file_, "walls"); }

Pieces SiteStore::all_pieces(const std::vector<Wall>& walls) const {
    const auto per_side = file_.read<std::int32_t>("walls/pieces_per_side");
    sound::count(file_, "walls/pieces_per_side", per_side, walls.size());
    sound::range(file_, "walls/pieces_per_side", per_side, 0, facts_.pieces + 1);
    Pieces out;
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const std::int32_t n = walls[w].scanned ? per_side[w] : 0;
        out.add_wall(walls[w].length_m(), walls[w].free_side[left] ? n : 0,
                     walls[w].free_side[right] ? n : 0);
    }
    return out;
}

}  // namespace vfplan
