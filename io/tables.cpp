#include "io/tables.h"

#include <limits>

#include "io/h5.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

// Turns a member of every element into a column.
template <class T, class Items, class F>
std::vector<T> column(const Items& items, F&& value) {
    std::vector<T> out;
    out.reserve(items.size());
    for (const auto& item : items) out.push_back(static_cast<T>(value(item)));
    return out;
}

template <class E, std::size_t N>
void write_codes(h5::Writer& file, const std::string& name, const std::vector<E>& codes,
                 const std::array<std::string_view, N>& names) {
    file.write(name, column<std::uint8_t>(codes, [](E e) { return e; }));
    std::string meaning;
    for (std::size_t i = 0; i < N; ++i) {
        meaning += (i > 0 ? ", " : "") + std::to_string(i) + " " + std::string(names[i]);
    }
    file.attribute(name, "meaning", meaning);
}

constexpr const char* frame = "m, site frame: input coordinates minus the origin in crs";

void write_header(h5::Writer& file, const std::string& title, const std::string& key) {
    file.attribute("/", "title", title);
    file.attribute("/", "format_version", std::int64_t{1});
    file.attribute("/", "key", key);
}

void finish(h5::Writer& file) {
    file.attribute("/", "complete", std::int64_t{1});
    file.close();
}

void write_crs(h5::Writer& file, const std::string& crs_wkt, const Vec2d& origin) {
    file.write("crs", std::vector<std::int32_t>{0});
    if (!crs_wkt.empty()) {
        file.attribute("crs", "crs_wkt", crs_wkt);
        file.attribute("crs", "spatial_ref", crs_wkt);
    }
    file.attribute("crs", "origin_x_m", origin.x());
    file.attribute("crs", "origin_y_m", origin.y());
}

std::string read_crs(const h5::Reader& file, Vec2d& origin) {
    origin = {file.number("crs", "origin_x_m"), file.number("crs", "origin_y_m")};
    return file.has_attribute("crs", "crs_wkt") ? file.text("crs", "crs_wkt") : "";
}

}  // namespace

void write_field(const std::filesystem::path& path, const FieldTable& t) {
    h5::Writer file(path);
    write_header(file, "visibility field", t.key);
    file.attribute("/", "Conventions", "CF-1.8");
    write_crs(file, t.crs_wkt, t.origin);
    const Grid& g = t.grid;
    std::vector<double> x(static_cast<std::size_t>(g.nx));
    std::vector<double> y(static_cast<std::size_t>(g.ny));
    for (std::int32_t i = 0; i < g.nx; ++i) {
        x[static_cast<std::size_t>(i)] = t.origin.x() + g.centre(g.id(i, 0)).x();
    }
    for (std::int32_t i = 0; i < g.ny; ++i) {
        y[static_cast<std::size_t>(i)] = t.origin.y() + g.centre(g.id(0, i)).y();
    }
    file.write("x", x);
    file.write("y", y);
    for (const char* axis : {"x", "y"}) {
        file.attribute(axis, "units", "m");
        file.attribute(axis, "standard_name", std::string("projection_") + axis + "_coordinate");
    }
    file.write("vf", t.vf_rad,
               {static_cast<std::uint64_t>(g.ny), static_cast<std::uint64_t>(g.nx)});
    file.attribute("vf", "long_name", "observed angle");
    file.attribute("vf", "units", "radian");
    file.attribute("vf", "grid_mapping", "crs");
    file.attribute("vf", "_FillValue", std::numeric_limits<float>::quiet_NaN());
    file.scale("vf", 0, "y");
    file.scale("vf", 1, "x");
    file.attribute("vf", "cell_m", g.cell_m);
    file.attribute("vf", "grid_origin_x_m", g.origin.x());
    file.attribute("vf", "grid_origin_y_m", g.origin.y());
    finish(file);
}

FieldTable read_field(const std::filesystem::path& path) {
    const h5::Reader file(path);
    FieldTable t;
    t.key = file.text("/", "key");
    t.crs_wkt = read_crs(file, t.origin);
    const h5::Dims dims = file.dims("vf");
    t.grid.ny = static_cast<std::int32_t>(dims.at(0));
    t.grid.nx = static_cast<std::int32_t>(dims.at(1));
    t.grid.cell_m = file.number("vf", "cell_m");
    t.grid.origin = {file.number("vf", "grid_origin_x_m"), file.number("vf", "grid_origin_y_m")};
    t.vf_rad = file.read<float>("vf");
    return t;
}

void write_coverage(const std::filesystem::path& path, const CoverageTables& t) {
    h5::Writer file(path);
    write_header(file, "coverage table: candidates x pieces", t.key);
    write_crs(file, t.crs_wkt, t.origin);

    file.group("walls");
    file.write("walls/x0", column<double>(t.walls, [](const Wall& w) { return w.a.x(); }));
    file.write("walls/y0", column<double>(t.walls, [](const Wall& w) { return w.a.y(); }));
    file.write("walls/x1", column<double>(t.walls, [](const Wall& w) { return w.b.x(); }));
    file.write("walls/y1", column<double>(t.walls, [](const Wall& w) { return w.b.y(); }));
    write_codes(file, "walls/class",
                column<WallClass>(t.walls, [](const Wall& w) { return w.cls; }),
                std::array<std::string_view, 4>{"wall", "window", "door", "obstacle"});
    file.write("walls/scanned",
               column<std::uint8_t>(t.walls, [](const Wall& w) { return w.scanned; }));
    file.write("walls/free_left",
               column<std::uint8_t>(t.walls, [](const Wall& w) { return w.free_side[left]; }));
    file.write("walls/free_right",
               column<std::uint8_t>(t.walls, [](const Wall& w) { return w.free_side[right]; }));
    file.attribute("walls", "units", frame);

    file.group("pieces");
    file.write("pieces/wall", t.pieces.wall);
    file.write("pieces/side", t.pieces.side);
    file.write("pieces/s0_m", t.pieces.s0_m);
    file.write("pieces/s1_m", t.pieces.s1_m);
    file.write("pieces/first_of", t.pieces.first_of);
    file.write("pieces/count_of", t.pieces.count_of);
    write_codes(file, "pieces/reach", t.reach, piece_status_names);

    file.group("candidates");
    file.attribute("candidates", "units", frame);
    const auto& c = t.candidates;
    file.write("candidates/x", column<double>(c, [](const Candidate& k) { return k.at.x(); }));
    file.write("candidates/y", column<double>(c, [](const Candidate& k) { return k.at.y(); }));
    file.write("candidates/cell",
               column<std::int64_t>(c, [](const Candidate& k) { return k.cell; }));
    file.write("candidates/vf", column<float>(c, [](const Candidate& k) { return k.vf_rad; }));
    write_codes(file, "candidates/kind",
                column<CandidateKind>(c, [](const Candidate& k) { return k.kind; }),
                candidate_kind_names);

    file.group("coverage");
    file.attribute("coverage", "encoding-type", "csr_matrix");
    file.attribute("coverage", "encoding-version", "0.1.0");
    file.attribute("coverage", "shape", std::vector<std::int64_t>{t.table.rows(), t.pieces.size()});
    file.write("coverage/indptr", t.table.begin);
    file.write("coverage/indices",
               column<std::int32_t>(t.table.seen, [](const Seen& s) { return s.piece; }));
    file.write("coverage/data",
               column<float>(t.table.seen, [](const Seen& s) { return s.fraction; }));
    file.write("coverage/angle_rad",
               column<float>(t.table.seen, [](const Seen& s) { return s.angle_rad; }));
    finish(file);
}

CoverageTables read_coverage(const std::filesystem::path& path) {
    const h5::Reader file(path);
    CoverageTables t;
    t.key = file.text("/", "key");
    t.crs_wkt = read_crs(file, t.origin);
    {
        const auto x0 = file.read<double>("walls/x0");
        const auto y0 = file.read<double>("walls/y0");
        const auto x1 = file.read<double>("walls/x1");
        const auto y1 = file.read<double>("walls/y1");
        const auto cls = file.read<std::uint8_t>("walls/class");
        const auto scanned = file.read<std::uint8_t>("walls/scanned");
        const auto on_left = file.read<std::uint8_t>("walls/free_left");
        const auto on_right = file.read<std::uint8_t>("walls/free_right");
        for (std::size_t i = 0; i < x0.size(); ++i) {
            t.walls.push_back({{x0[i], y0[i]},
                               {x1[i], y1[i]},
                               static_cast<WallClass>(cls[i]),
                               scanned[i] != 0,
                               {on_left[i] != 0, on_right[i] != 0}});
        }
    }
    t.pieces.wall = file.read<std::int32_t>("pieces/wall");
    t.pieces.side = file.read<std::uint8_t>("pieces/side");
    t.pieces.s0_m = file.read<double>("pieces/s0_m");
    t.pieces.s1_m = file.read<double>("pieces/s1_m");
    t.pieces.first_of = file.read<std::int32_t>("pieces/first_of");
    t.pieces.count_of = file.read<std::int32_t>("pieces/count_of");
    t.reach = column<PieceStatus>(file.read<std::uint8_t>("pieces/reach"),
                                  [](std::uint8_t v) { return v; });
    {
        const auto x = file.read<double>("candidates/x");
        const auto y = file.read<double>("candidates/y");
        const auto cell = file.read<std::int64_t>("candidates/cell");
        const auto vf = file.read<float>("candidates/vf");
        const auto kind = file.read<std::uint8_t>("candidates/kind");
        for (std::size_t i = 0; i < x.size(); ++i) {
            t.candidates.push_back(
                {{x[i], y[i]}, cell[i], static_cast<CandidateKind>(kind[i]), vf[i]});
        }
    }
    t.table.begin = file.read<std::int64_t>("coverage/indptr");
    const auto piece = file.read<std::int32_t>("coverage/indices");
    const auto fraction = file.read<float>("coverage/data");
    const auto angle = file.read<float>("coverage/angle_rad");
    t.table.seen.reserve(piece.size());
    for (std::size_t i = 0; i < piece.size(); ++i) {
        t.table.seen.push_back({piece[i], fraction[i], angle[i]});
    }
    return t;
}

void write_plan(const std::filesystem::path& path, const PlanTable& t) {
    h5::Writer file(path);
    write_header(file, "stations and links", t.key);
    file.attribute("/", "overlap_ratio", t.overlap_ratio);
    file.attribute("/", "overlap_threshold", t.threshold);
    const auto& s = t.plan.stations;
    file.group("stations");
    file.write("stations/candidate",
               column<std::int32_t>(s, [](const Station& k) { return k.candidate; }));
    file.write("stations/component",
               column<std::int32_t>(s, [](const Station& k) { return k.network; }));
    file.write("stations/order", column<std::int32_t>(s, [](const Station& k) { return k.order; }));
    file.write("stations/new_length_m",
               column<double>(s, [](const Station& k) { return k.new_length_m; }));
    file.write("stations/seen_length_m",
               column<double>(s, [](const Station& k) { return k.seen_length_m; }));
    const auto& l = t.plan.links;
    file.group("links");
    file.write("links/from", column<std::int32_t>(l, [](const Link& k) { return k.from; }));
    file.write("links/to", column<std::int32_t>(l, [](const Link& k) { return k.to; }));
    file.write("links/overlap", column<double>(l, [](const Link& k) { return k.overlap; }));
    for (std::size_t r = 0; r < overlap_ratio_names.size(); ++r) {
        file.write("links/" + std::string(overlap_ratio_names[r]),
                   column<double>(l, [r](const Link& k) { return k.ratios[r]; }));
    }
    write_codes(file, "piece_status", t.plan.pieces, piece_status_names);
    file.group("certificate");
    file.write("certificate/pieces", t.plan.bound_pieces);
    file.attribute("certificate", "meaning",
                   "no candidate covers two of these pieces, so every plan over these candidates "
                   "that covers them has at least as many stations");
    finish(file);
}

PlanTable read_plan(const std::filesystem::path& path) {
    const h5::Reader file(path);
    PlanTable t;
    t.key = file.text("/", "key");
    t.overlap_ratio = file.text("/", "overlap_ratio");
    t.threshold = file.number("/", "overlap_threshold");
    const auto candidate = file.read<std::int32_t>("stations/candidate");
    const auto network = file.read<std::int32_t>("stations/component");
    const auto order = file.read<std::int32_t>("stations/order");
    const auto fresh = file.read<double>("stations/new_length_m");
    const auto seen = file.read<double>("stations/seen_length_m");
    for (std::size_t i = 0; i < candidate.size(); ++i) {
        t.plan.stations.push_back({candidate[i], network[i], order[i], fresh[i], seen[i]});
    }
    const auto from = file.read<std::int32_t>("links/from");
    const auto to = file.read<std::int32_t>("links/to");
    const auto overlap = file.read<double>("links/overlap");
    for (std::size_t i = 0; i < from.size(); ++i) {
        t.plan.links.push_back({from[i], to[i], overlap[i], {}});
    }
    for (std::size_t r = 0; r < overlap_ratio_names.size(); ++r) {
        const auto ratio = file.read<double>("links/" + std::string(overlap_ratio_names[r]));
        for (std::size_t i = 0; i < from.size(); ++i) t.plan.links[i].ratios[r] = ratio[i];
    }
    t.plan.pieces = column<PieceStatus>(file.read<std::uint8_t>("piece_status"),
                                        [](std::uint8_t v) { return v; });
    t.plan.bound_pieces = file.read<std::int32_t>("certificate/pieces");
    return t;
}

std::string key_of(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) return "";
    try {
        const h5::Reader file(path);
        return file.has_attribute("/", "complete") ? file.text("/", "key") : "";
    } catch (const IoError&) {
        return "";  // damaged: made again
    }
}

}  // namespace vfplan
