#include "io/tables/plan_file.h"

#include <algorithm>

#include "io/checksum.h"
#include "io/columns.h"
#include "io/h5_reader.h"
#include "io/tables/certificate_text.h"
#include "io/tables/shard_index.h"
#include "io/tables/sound.h"

namespace vfplan {

void write_plan(const std::filesystem::path& path, const PlanTable& t) {
    h5::Writer file = begin_table(path, "stations and links", t.key);
    file.attribute("/", "overlap_ratio", std::string(name_of(t.overlap.ratio)));
    file.attribute("/", "overlap_threshold", t.overlap.threshold);
    file.attribute("/", "candidates", std::string(name_of(t.pool)));
    file.attribute("/", "survives", t.survives ? 1.0 : 0.0);
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
    file.write("stations/only_length_m",
               column<double>(s, [](const Station& k) { return k.only_length_m; }));
    file.write("stations/articulation",
               column<std::uint8_t>(s, [](const Station& k) { return k.articulation; }));
    file.write("stations/bridge_end",
               column<std::uint8_t>(s, [](const Station& k) { return k.bridge_end; }));
    file.write("stations/needed_overlap",
               column<double>(s, [](const Station& k) { return k.needed_overlap; }));
    const auto& l = t.plan.links;
    file.group("links");
    file.write("links/from", column<std::int32_t>(l, [](const Link& k) { return k.from; }));
    file.write("links/to", column<std::int32_t>(l, [](const Link& k) { return k.to; }));
    file.write("links/overlap", column<double>(l, [](const Link& k) { return k.overlap; }));
    for (std::size_t r = 0; r < overlap_ratio_count; ++r) {
        file.write("links/" + std::string(overlap_ratios[r].name),
                   column<double>(l, [r](const Link& k) { return k.ratios[r]; }));
    }
    write_codes(file, "piece_status", t.plan.pieces);
    file.group("certificate");
    const std::string proof = text_of(t.plan.certificate);
    file.write("certificate/text", std::vector<std::uint8_t>(proof.begin(), proof.end()));
    file.attribute("certificate", "bound", t.plan.certificate.bound());
    file.attribute("certificate", "meaning",
                   "text, in UTF-8, that proves that no plan over these candidates has fewer "
                   "stations than the bound");
    finish_table(file);
}

PlanTable read_plan(const std::filesystem::path& path) {
    constexpr std::int64_t no_end = std::int64_t{1} << 31;
    const h5::Reader file(path);
    check_version(file, path);
    PlanTable t;
    t.key = file.text("/", "key");
    const std::string ratio_name = file.text("/", "overlap_ratio");
    const auto named = [&](const OverlapFormula& f) { return f.name == ratio_name; };
    const auto ratio = std::find_if(overlap_ratios.begin(), overlap_ratios.end(), named);
    if (ratio == overlap_ratios.end()) damaged(path, "no ratio is called " + ratio_name);
    t.overlap = {ratio->ratio, file.number("/", "overlap_threshold")};
    const auto& pools = Names<CandidatePool>::all;
    const auto pool = std::find(pools.begin(), pools.end(), file.text("/", "candidates"));
    if (pool == pools.end()) damaged(path, "no candidates are called so");
    t.pool = static_cast<CandidatePool>(pool - pools.begin());
    // Plans of before this was a wish have it not.
    t.survives = file.has_attribute("/", "survives") && file.number("/", "survives") != 0;
    const auto candidate = file.read<std::int32_t>("stations/candidate");
    const auto network = file.read<std::int32_t>("stations/component");
    const auto order = file.read<std::int32_t>("stations/order");
    const auto fresh = file.read<double>("stations/new_length_m");
    const auto seen = file.read<double>("stations/seen_length_m");
    const auto only = file.read<double>("stations/only_length_m");
    const auto articulation = file.read<std::uint8_t>("stations/articulation");
    const auto bridge_end = file.read<std::uint8_t>("stations/bridge_end");
    const auto needed = file.read<double>("stations/needed_overlap");
    const std::size_t stations = candidate.size();
    const auto end = static_cast<std::int64_t>(stations);
    sound::range(file, "stations/candidate", candidate, 0, no_end);
    sound::count(file, "stations/component", network, stations);
    sound::range(file, "stations/component", network, 0, end);
    sound::count(file, "stations/order", order, stations);
    sound::range(file, "stations/order", order, -1, no_end);
    for (const auto* column : {&fresh, &seen, &only, &needed}) {
        sound::count(file, "stations", *column, stations);
        sound::finite(file, "stations", *column, 1e12);
    }
    sound::count(file, "stations/articulation", articulation, stations);
    sound::count(file, "stations/bridge_end", bridge_end, stations);
    for (std::size_t i = 0; i < stations; ++i) {
        t.plan.stations.push_back({candidate[i], network[i], order[i], fresh[i], seen[i], only[i],
                                   articulation[i] != 0, bridge_end[i] != 0, needed[i]});
    }
    const auto from = file.read<std::int32_t>("links/from");
    const auto to = file.read<std::int32_t>("links/to");
    const auto overlap = file.read<double>("links/overlap");
    sound::range(file, "links/from", from, 0, end);
    sound::count(file, "links/to", to, from.size());
    sound::range(file, "links/to", to, 0, end);
    sound::count(file, "links/overlap", overlap, from.size());
    sound::finite(file, "links/overlap", overlap);
    sound::need(file, std::is_sorted(from.begin(), from.end()), "links/from", "does not ascend");
    for (std::size_t i = 0; i < from.size(); ++i) {
        t.plan.links.push_back({from[i], to[i], overlap[i], {}});
    }
    for (std::size_t r = 0; r < overlap_ratio_count; ++r) {
        const auto values = file.read<double>("links/" + std::string(overlap_ratios[r].name));
        sound::count(file, "links", values, from.size());
        sound::finite(file, "links", values);
        for (std::size_t i = 0; i < from.size(); ++i) t.plan.links[i].ratios[r] = values[i];
    }
    const auto status = file.read<std::uint8_t>("piece_status");
    sound::codes<PieceStatus>(file, "piece_status", status);
    t.plan.pieces = column<PieceStatus>(status, [](std::uint8_t v) { return v; });
    const auto proof = file.read<std::uint8_t>("certificate/text");
    t.plan.certificate =
        certificate_of(std::string(proof.begin(), proof.end()), path.string() + " certificate");
    return t;
}

}  // namespace vfplan
