#include "io/exports.h"

#include <fmt/format.h>

#include <iterator>

namespace vfplan {
namespace {

const Candidate& candidate_of(const CoverageTables& t, const Station& s) {
    return t.candidates[static_cast<std::size_t>(s.candidate)];
}

}  // namespace

std::string crs_name(const std::string& crs_wkt) {
    // The code of the whole stands last.
    const std::string label = R"(AUTHORITY["EPSG",")";
    const auto at = crs_wkt.rfind(label);
    if (at == std::string::npos) return "";
    const auto from = at + label.size();
    return "EPSG:" + crs_wkt.substr(from, crs_wkt.find('"', from) - from);
}

std::string stations_csv(const CoverageTables& t, const Plan& plan) {
    std::string out = "id,x,y,component,order,new_length_m,seen_length_m\n";
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const Station& s = plan.stations[i];
        const Vec2d p = t.origin + candidate_of(t, s).at;
        fmt::format_to(std::back_inserter(out), "{},{:.4f},{:.4f},{},{},{:.3f},{:.3f}\n", i, p.x(),
                       p.y(), s.network, s.order, s.new_length_m, s.seen_length_m);
    }
    return out;
}

std::string stations_geojson(const CoverageTables& t, const Plan& plan) {
    // Plain metres and projected coordinates need saying so: the format itself means degrees.
    const std::string crs = crs_name(t.crs_wkt);
    std::string out = R"({"type": "FeatureCollection", "name": "stations", "units": "m", )";
    if (!crs.empty()) {
        out += fmt::format(R"("crs": {{"type": "name", "properties": {{"name": "{}"}}}}, )", crs);
    }
    out += "\"features\": [\n";
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const Station& s = plan.stations[i];
        const Candidate& c = candidate_of(t, s);
        const Vec2d p = t.origin + c.at;
        fmt::format_to(
            std::back_inserter(out),
            "{{\"type\": \"Feature\", \"properties\": {{\"id\": {}, \"component\": {}, \"order\": "
            "{}, \"kind\": \"{}\", \"new_length_m\": {:.3f}, \"seen_length_m\": {:.3f}}}, "
            "\"geometry\": {{\"type\": \"Point\", \"coordinates\": [{:.4f}, {:.4f}]}}}}{}\n",
            i, s.network, s.order, candidate_kind_names[static_cast<std::size_t>(c.kind)],
            s.new_length_m, s.seen_length_m, p.x(), p.y(), i + 1 < plan.stations.size() ? "," : "");
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

std::string pieces_csv(const CoverageTables& t, const Plan& plan) {
    std::string out = "id,x0,y0,x1,y1,length_m,status\n";
    for (std::size_t p = 0; p < plan.pieces.size(); ++p) {
        const Wall& wall = t.walls[static_cast<std::size_t>(t.pieces.wall[p])];
        const Vec2d a = t.origin + wall.at(t.pieces.s0_m[p]);
        const Vec2d b = t.origin + wall.at(t.pieces.s1_m[p]);
        fmt::format_to(std::back_inserter(out), "{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{}\n", p,
                       a.x(), a.y(), b.x(), b.y(), t.pieces.s1_m[p] - t.pieces.s0_m[p],
                       piece_status_names[static_cast<std::size_t>(plan.pieces[p])]);
    }
    return out;
}

}  // namespace vfplan
