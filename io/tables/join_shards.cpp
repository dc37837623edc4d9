#include "io/tables/join_shards.h"

#include <algorithm>

#include "io/columns.h"
#include "io/h5_reader.h"
#include "io/tables/sound.h"

namespace vfplan {

void write_dispute_round(const std::filesystem::path& path, const std::string& key,
                         const DisputeRound& round) {
    constexpr std::uint64_t chunk = 1U << 16;
    h5::Writer file = begin_shard(path, key);
    file.attribute("/", "open", std::int64_t{round.open ? 1 : 0});
    file.attribute("/", "spaces", round.spaces);
    file.write("role", column<std::uint8_t>(round.role, [](PieceRole r) { return r; }), {}, chunk);
    file.write("set", round.set, {}, chunk);
    finish_shard(file);
}

DisputeRound read_dispute_round(const std::filesystem::path& path) {
    const h5::Reader file(path);
    DisputeRound out;
    out.open = file.number("/", "open") > 0;
    out.spaces = static_cast<std::int64_t>(file.number("/", "spaces"));
    if (!out.open) return out;
    const auto role = file.read<std::uint8_t>("role");
    out.set = file.read<std::int32_t>("set");
    sound::range(file, "role", role, 0, static_cast<std::int64_t>(PieceRole::look) + 1);
    sound::count(file, "set", out.set, role.size());
    sound::range(file, "set", out.set, -1, std::int64_t{1} << 31);
    out.role = column<PieceRole>(role, [](std::uint8_t r) { return r; });
    return out;
}

void write_disputed_cells(const std::filesystem::path& path, const std::string& key,
                          const std::vector<std::int64_t>& cells) {
    h5::Writer file = begin_shard(path, key);
    file.write("cell", cells);
    finish_shard(file);
}

std::vector<std::int64_t> read_disputed_cells(const std::filesystem::path& path) {
    return h5::Reader(path).read<std::int64_t>("cell");
}

void write_apart(h5::Writer& file, const Apart& apart) {
    if (apart.free_cells == 0) return;
    file.group("apart");
    file.attribute("/", "apart_free_cells", apart.free_cells);
    file.attribute("apart", "disputed_cells", apart.disputed_cells);
    file.attribute("apart", "ratio", std::string(name_of(apart.rule.ratio)));
    file.attribute("apart", "threshold", apart.rule.threshold);
    const auto write = [&](const char* name, auto example, auto&& value) {
        file.write(name, column<decltype(example)>(apart.pairs, value));
    };
    write("apart/a", std::int32_t{}, [](const SetPair& p) { return p.a; });
    write("apart/b", std::int32_t{}, [](const SetPair& p) { return p.b; });
    write("apart/overlap", double{}, [](const SetPair& p) { return p.overlap; });
}

Apart read_apart(const h5::Reader& file) {
    Apart out;
    if (!file.has_attribute("/", "apart_free_cells")) return out;
    out.free_cells = static_cast<std::int64_t>(file.number("/", "apart_free_cells"));
    const auto& names = Names<OverlapRatio>::all;
    const auto ratio = std::find(names.begin(), names.end(), file.text("apart", "ratio"));
    sound::need(file, ratio != names.end(), "apart", "is by a ratio that is none");
    out.rule.ratio = static_cast<OverlapRatio>(ratio - names.begin());
    out.rule.threshold = file.number("apart", "threshold");
    out.disputed_cells = static_cast<std::int64_t>(file.number("apart", "disputed_cells"));
    const auto a = file.read<std::int32_t>("apart/a");
    const auto b = file.read<std::int32_t>("apart/b");
    const auto overlap = file.read<double>("apart/overlap");
    sound::count(file, "apart/b", b, a.size());
    sound::count(file, "apart/overlap", overlap, a.size());
    sound::finite(file, "apart/overlap", overlap);
    for (std::size_t i = 0; i < a.size(); ++i) out.pairs.push_back({a[i], b[i], overlap[i]});
    return out;
}

void write_apart(const std::filesystem::path& path, const std::string& key, const Apart& apart) {
    h5::Writer file = begin_shard(path, key);
    write_apart(file, apart);
    finish_shard(file);
}

Apart read_apart(const std::filesystem::path& path) { return read_apart(h5::Reader(path)); }

}  // namespace vfplan
