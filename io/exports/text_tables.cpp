#include "io/exports/text_tables.h"

#include <fmt/format.h>

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

std::string stations_csv(const CoverageTables& t, const Plan& plan) {
    std::string out =
        "id,x,y,component,order,new_length_m,seen_length_m,kind,only_length_m,"
        "articulation,bridge_end,needed_overlap\n";
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const Station& s = plan.stations[i];
        const Candidate& c = candidate_of(t, s);
        const Vec2d p = t.origin + c.at;
        fmt::format_to(std::back_inserter(out),
                       "{},{:.4f},{:.4f},{},{},{:.3f},{:.3f},{},{:.3f},{:d},{:d},{:.6f}\n", i,
                       p.x(), p.y(), s.network, s.order, s.new_length_m, s.seen_length_m,
                       name_of(c.kind), s.only_length_m, s.articulation, s.bridge_end,
                       s.needed_overlap);
    }
    return out;
}

// In longitude and latitude, as RFC 7946 wants it, wherever the site's CRS is known; else in plain
// metres.
std::string stations_geojson(const CoverageTables& t, const Plan& plan) {
    const auto degrees = to_degrees(t.crs_wkt);
    std::string out = R"({"type": "FeatureCollection", "name": "stations", )";
    if (!degrees) out += R"("units": "m", )";
    out += "\"features\": [\n";
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const Station& s = plan.stations[i];
        const Candidate& c = candidate_of(t, s);
        const Vec2d p = t.origin + c.at;
        const Vec2d shown = degrees ? degrees(p) : p;
        fmt::format_to(
            std::back_inserter(out),
            "{{\"type\": \"Feature\", \"properties\": {{\"id\": {}, \"x_m\": {:.4f}, \"y_m\": "
            "{:.4f}, "
            "\"component\": {}, \"order\": {}, \"kind\": \"{}\", \"new_length_m\": {:.3f}, "
            "\"seen_length_m\": {:.3f}, \"only_length_m\": {:.3f}, \"articulation\": {}, "
            "\"bridge_end\": {}, \"needed_overlap\": {:.6f}}}, \"geometry\": {{\"type\": "
            "\"Point\", \"coordinates\": "
            "[{:.{}f}, {:.{}f}]}}}}{}\n",
            i, p.x(), p.y(), s.network, s.order, name_of(c.kind), s.new_length_m, s.seen_length_m,
            s.only_length_m, s.articulation, s.bridge_end, s.needed_overlap, shown.x(),
            degrees ? 9 : 4, shown.y(), degrees ? 9 : 4, i + 1 < plan.stations.size() ? "," : "");
    }
    return out + "]}\n";
}

std::string links_csv(const Plan& plan) {
    std::string out = "from,to,overlap\n";
    for (const Link& l : plan.links) {
        fmt::format_to(std::back_inserter(out), "{},{},{:.6f}\n", l.from, l.to, l.overlap);
    }
    return out;
}

// Line by line: a county's is a gigabyte.
void write_pieces_csv(const std::filesystem::path& file, const CoverageTables& t,
                      const Plan& plan) {
    constexpr std::size_t at_once = 1U << 20;  // bytes
    TextFile out(file);
    std::string text = "id,x0,y0,x1,y1,length_m,status\n";
    std::size_t p = 0;
    for (std::size_t w = 0; w < t.walls.size(); ++w) {
        const Wall& wall = t.walls[w];
        const double length = wall.length_m();
        for (const Side side : {left, right}) {
            const std::int32_t n = t.pieces.count(static_cast<std::int32_t>(w), side);
            for (std::int32_t k = 0; k < n; ++k, ++p) {
                const double s0 = piece_begin_m(length, k, n);
                const double s1 = piece_begin_m(length, k + 1, n);
                const Vec2d a = t.origin + wall.at(s0);
                const Vec2d b = t.origin + wall.at(s1);
                fmt::format_to(std::back_inserter(text),
                               "{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{}\n", p, a.x(), a.y(), b.x(),
                               b.y(), s1 - s0, name_of(plan.pieces[p]));
            }
        }
        if (text.size() >= at_once) {
            out.add(text);
            text.clear();
        }
    }
    out.add(text);
    out.close();
}

constexpr Output all[] = {
    {"geojson",
     "stations.geojson",
     [](const std::filesystem::path& path, const Results& r) {
         write_text(path, stations_geojson(r.tables, r.plan));
     },
     {0, 0, 280},
     {},
     {}},
    {"csv",
     "stations.csv",
     [](const std::filesystem::path& path, const Results& r) {
         write_text(path, stations_csv(r.tables, r.plan));
     },
     {0, 0, 15},
     {},
     {}},
    {"csv",
     "links.csv",
     [](const std::filesystem::path& path, const Results& r) {
         write_text(path, links_csv(r.plan));
     },
     {0, 0, 15},
     {},
     {}},
    {"csv",
     "pieces.csv",
     [](const std::filesystem::path& path, const Results& r) {
         write_pieces_csv(path, r.tables, r.plan);
     },
     {0, 62},
     {},
     {}},
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
