#include "io/tables.h"

#include "io/columns.h"
#include "io/tables_parts.h"
#include "kernels/error.h"

namespace vfplan {

void write_plan(const std::filesystem::path& path, const PlanTable& t) {
    h5::Writer file(path);
    write_header(file, path, "stations and links", t.key);
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
