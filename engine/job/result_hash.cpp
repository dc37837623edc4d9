#include "engine/job/result_hash.h"

#include <algorithm>

#include "io/sha256.h"

namespace vfplan {
namespace {

template <class T>
void add_number(Sha256& hash, T value) {
    hash.add(&value, sizeof value);
}

}  // namespace

std::string result_hash(const FieldFile& field, const CoverageTables& t,
                        const CoverageEntries& entries, const Plan& plan) {
    Sha256 h;
    field.each_band([&](const Window&, const Raster<float>& vf_rad) { h.add(vf_rad); });
    for (const Candidate& c : t.candidates) {
        add_number(h, c.at.x());
        add_number(h, c.at.y());
        add_number(h, c.cell);
        add_number(h, c.kind);
    }
    h.add(t.begin);
    constexpr std::int64_t at_once = 1 << 20;
    for (std::int64_t from = 0; from < t.entries(); from += at_once) {
        const std::int64_t count = std::min(at_once, t.entries() - from);
        h.add(entries.pieces(from, count));
        h.add(entries.fractions(from, count));
        h.add(entries.angles_rad(from, count));
    }
    for (const Wall& w : t.walls) {
        for (const double v : {w.a.x(), w.a.y(), w.b.x(), w.b.y()}) add_number(h, v);
    }
    h.add(t.status);
    for (const Station& s : plan.stations) {
        add_number(h, s.candidate);
        add_number(h, s.network);
        add_number(h, s.new_length_m);
    }
    for (const Link& l : plan.links) {
        add_number(h, l.from);
        add_number(h, l.to);
        add_number(h, l.overlap);
    }
    h.add(plan.pieces);
    return h.hex();
}

}  // namespace vfplan
