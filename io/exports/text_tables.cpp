#include "io/exports/text_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "io/features/crs.h"
#include "io/files.h"
#include "io/tables/certificate_text.h"
#include "io/tables/coverage_file.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

const Candidate& candidate_of(const CoverageTables& t, const Station& s) {
    return t.candidates[idx(s.candidate)];
}

// A file of many like lines: `format` adds those of some rows to a text. Blocks of rows are
// formatted at once and written in their order.
void write_lines(
    const std::filesystem::path& path, const EachBlock& each_block, const std::string& head,
    std::int64_t rows,
    const std::function<void(std::string& text, std::int64_t from, std::int64_t to)>& format,
    const std::string& tail = "") {
    constexpr std::int64_t in_block = 1 << 14;
    constexpr std::int64_t at_once = 64;  // blocks, of some megabytes each
    TextFile out(path);
    out.add(head);
    const std::int64_t blocks = (rows + in_block - 1) / in_block;
    for (std::int64_t first = 0; first < blocks; first += at_once) {
        std::vector<std::string> texts(idx(std::min(at_once, blocks - first)));
        each_block(static_cast<std::int64_t>(texts.size()), [&](std::int64_t b) {
            const std::int64_t from = (first + b) * in_block;
            format(texts[idx(b)], from, std::min(rows, from + in_block));
        });
        for (const std::string& text : texts) out.add(text);
    }
    out.add(tail);
    out.close();
}

void write_stations_csv(const std::filesystem::path& path, const Results& r) {
    write_lines(path, r.each_block,
                "id,x,y,component,order,new_length_m,seen_length_m,kind,only_length_m,"
                "articulation,bridge_end,needed_overlap\n",
                static_cast<std::int64_t>(r.plan.stations.size()),
                [&](std::string& out, std::int64_t from, std::int64_t to) {
                    for (std::int64_t i = from; i < to; ++i) {
                        const Station& s = r.plan.stations[idx(i)];
                        const Candidate& c = candidate_of(r.tables, s);
                        const Vec2d p = r.tables.origin + c.at;
                        fmt::format_to(
                            std::back_inserter(out),
                            "{},{:.4f},{:.4f},{},{},{:.3f},{:.3f},{},{:.3f},{:d},{:d},{:.6f}\n", i,
                            p.x(), p.y(), s.network, s.order, s.new_length_m, s.seen_length_m,
                            name_of(c.kind), s.only_length_m, s.articulation, s.bridge_end,
                            s.needed_overlap);
                    }
                });
}

// In longitude and latitude, as RFC 7946 wants it, wherever the site's CRS is known; else in plain
// metres.
void write_stations_geojson(const std::filesystem::path& path, const Results& r) {
    const bool degrees = static_cast<bool>(to_degrees(r.tables.crs_wkt));
    const auto rows = static_cast<std::int64_t>(r.plan.stations.size());
    write_lines(
        path, r.each_block,
        fmt::format(
            "{{\"type\": \"FeatureCollection\", \"name\": \"stations\", {}\"features\": [\n",
            degrees ? "" : "\"units\": \"m\", "),
        rows,
        [&](std::string& out, std::int64_t from, std::int64_t to) {
            const auto way = to_degrees(r.tables.crs_wkt);  // not thread-safe
            for (std::int64_t i = from; i < to; ++i) {
                const Station& s = r.plan.stations[idx(i)];
                const Candidate& c = candidate_of(r.tables, s);
                const Vec2d p = r.tables.origin + c.at;
                const Vec2d shown = way ? way(p) : p;
                fmt::format_to(
                    std::back_inserter(out),
                    "{{\"type\": \"Feature\", \"properties\": {{\"id\": {}, \"x_m\": {:.4f}, "
                    "\"y_m\": {:.4f}, \"component\": {}, \"order\": {}, \"kind\": \"{}\", "
                    "\"new_length_m\": {:.3f}, \"seen_length_m\": {:.3f}, \"only_length_m\": "
                    "{:.3f}, \"articulation\": {}, \"bridge_end\": {}, \"needed_overlap\": "
                    "{:.6f}}}, \"geometry\": {{\"type\": \"Point\", \"coordinates\": "
                    "[{:.{}f}, {:.{}f}]}}}}{}\n",
                    i, p.x(), p.y(), s.network, s.order, name_of(c.kind), s.new_length_m,
                    s.seen_length_m, s.only_length_m, s.articulation, s.bridge_end,
                    s.needed_overlap, shown.x(), degrees ? 9 : 4, shown.y(), degrees ? 9 : 4,
                    i + 1 < rows ? "," : "");
            }
        },
        "]}\n");
}

void write_links_csv(const std::filesystem::path& path, const Results& r) {
    write_lines(
        path, r.each_block, "from,to,overlap\n", static_cast<std::int64_t>(r.plan.links.size()),
        [&](std::string& out, std::int64_t from, std::int64_t to) {
            for (std::int64_t i = from; i < to; ++i) {
                const Link& l = r.plan.links[idx(i)];
                fmt::format_to(std::back_inserter(out), "{},{},{:.6f}\n", l.from, l.to, l.overlap);
            }
        });
}

// Wall by wall, as pieces are numbered: of a county twenty million.
void write_pieces_csv(const std::filesystem::path& path, const Results& r) {
    const CoverageTables& t = r.tables;
    write_lines(path, r.each_block, "id,x0,y0,x1,y1,length_m,status\n",
                static_cast<std::int64_t>(t.walls.size()),
                [&](std::string& out, std::int64_t from, std::int64_t to) {
                    for (std::int64_t w = from; w < to; ++w) {
                        const Wall& wall = t.walls[idx(w)];
                        const auto number = static_cast<std::int32_t>(w);
                        const double length = wall.length_m();
                        for (const Side side : {left, right}) {
                            const std::int32_t n = t.pieces.count(number, side);
                            const std::int64_t first = t.pieces.first(number, side);
                            for (std::int32_t k = 0; k < n; ++k) {
                                const PieceStatus status = r.plan.pieces[idx(first + k)];
                                if (!r.all_pieces && status == PieceStatus::covered) continue;
                                const double s0 = piece_begin_m(length, k, n);
                                const double s1 = piece_begin_m(length, k + 1, n);
                                const Vec2d a = t.origin + wall.at(s0);
                                const Vec2d b = t.origin + wall.at(s1);
                                fmt::format_to(std::back_inserter(out),
                                               "{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{}\n",
                                               first + k, a.x(), a.y(), b.x(), b.y(), s1 - s0,
                                               name_of(status));
                            }
                        }
                    }
                });
}

constexpr Output all[] = {
    {"geojson", "stations.geojson", write_stations_geojson, {0, 0, 280}, {}, {}},
    {"csv", "stations.csv", write_stations_csv, {0, 0, 15}, {}, {}},
    {"csv", "links.csv", write_links_csv, {0, 0, 15}, {}, {}},
    {"csv", "pieces.csv", write_pieces_csv, {0, 62}, {}, {}},
    {"certificate",
     "certificate.txt",
     [](const std::filesystem::path& path, const Results& r) {
         write_text(path, text_of(r.plan.certificate));
     },
     {200, 0, 40},
     {},
     {}},
};

}  // namespace

std::span<const Output> text_outputs() { return all; }

}  // namespace vfplan
