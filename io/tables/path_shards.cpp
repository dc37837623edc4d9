#include "io/tables/path_shards.h"

#include "io/columns.h"
#include "io/h5_reader.h"
#include "io/tables/sound.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int64_t no_end = std::int64_t{1} << 31;  // of numbers that 32 bits hold

}  // namespace

void write_pairs(const std::filesystem::path& path, const std::string& key,
                 const CandidatePairs& pairs) {
    std::vector<std::int32_t> both;
    for (const auto& [a, b] : pairs) {
        both.push_back(a);
        both.push_back(b);
    }
    h5::Writer file = begin_shard(path, key);
    file.write("pair", both);
    finish_shard(file);
}

CandidatePairs read_pairs(const std::filesystem::path& path) {
    const h5::Reader file(path);
    const auto both = file.read<std::int32_t>("pair");
    sound::range(file, "pair", both, 0, no_end);
    sound::need(file, both.size() % 2 == 0, "pair", "has half a pair");
    CandidatePairs out;
    for (std::size_t i = 0; i + 1 < both.size(); i += 2) out.emplace_back(both[i], both[i + 1]);
    return out;
}

void write_components(const std::filesystem::path& path, const std::string& key,
                      const std::vector<std::int32_t>& component, std::int64_t count) {
    constexpr std::uint64_t chunk = 1U << 12;
    h5::Writer file = begin_shard(path, key);
    file.write("component", component, {}, chunk);
    file.attribute("/", "count", count);
    finish_shard(file);
}

std::int64_t Components::count() const { return h5::Reader(file_).whole("/", "count", 0, no_end); }

std::vector<std::int32_t> Components::of(const std::vector<std::int32_t>& numbers) const {
    const h5::Reader file(file_);
    const std::int64_t components = file.whole("/", "count", 0, no_end);
    std::vector<std::int32_t> out;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t k = i + 1;  // consecutive ones in one go
        while (k < numbers.size() && numbers[k] == numbers[k - 1] + 1) ++k;
        const auto some = file.read<std::int32_t>("component", idx(numbers[i]), k - i);
        sound::range(file, "component", some, 0, components);
        out.insert(out.end(), some.begin(), some.end());
        i = k;
    }
    return out;
}

void write_paths(const std::filesystem::path& path, const std::string& key,
                 const std::vector<ShortestPath>& paths) {
    std::vector<std::int32_t> component;
    std::vector<std::int32_t> candidate;
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int64_t> cells;
    for (const ShortestPath& p : paths) {
        component.insert(component.end(), p.component, p.component + 2);
        candidate.insert(candidate.end(), p.candidate, p.candidate + 2);
        cells.insert(cells.end(), p.cells.begin(), p.cells.end());
        begin.push_back(static_cast<std::int64_t>(cells.size()));
    }
    h5::Writer file = begin_shard(path, key);
    file.write("component", component);
    file.write("candidate", candidate);
    file.write("length",
               column<std::int32_t>(paths, [](const ShortestPath& p) { return p.length; }));
    file.write("meets_at",
               column<std::int64_t>(paths, [](const ShortestPath& p) { return p.meets_at; }));
    file.write("direction",
               column<std::int32_t>(paths, [](const ShortestPath& p) { return p.direction; }));
    file.write("cells_begin", begin);
    file.write("cells", cells);
    finish_shard(file);
}

std::vector<ShortestPath> read_paths(const std::filesystem::path& path) {
    const h5::Reader file(path);
    const auto component = file.read<std::int32_t>("component");
    const auto candidate = file.read<std::int32_t>("candidate");
    const auto length = file.read<std::int32_t>("length");
    const auto meets_at = file.read<std::int64_t>("meets_at");
    const auto direction = file.read<std::int32_t>("direction");
    const auto begin = file.read<std::int64_t>("cells_begin");
    const auto cells = file.read<std::int64_t>("cells");
    const std::size_t paths = length.size();
    sound::count(file, "component", component, 2 * paths);
    sound::count(file, "candidate", candidate, 2 * paths);
    sound::count(file, "meets_at", meets_at, paths);
    sound::count(file, "direction", direction, paths);
    sound::range(file, "component", component, 0, no_end);
    sound::range(file, "candidate", candidate, 0, no_end);
    sound::range(file, "length", length, 0, no_end);
    sound::offsets(file, "cells_begin", begin, paths, 0, static_cast<std::int64_t>(cells.size()));
    std::vector<ShortestPath> out(paths);
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {{component[2 * i], component[2 * i + 1]},
                  {candidate[2 * i], candidate[2 * i + 1]},
                  length[i],
                  meets_at[i],
                  direction[i],
                  {cells.begin() + begin[i], cells.begin() + begin[i + 1]}};
    }
    return out;
}

void write_connections(const std::filesystem::path& path, const std::string& key,
                       const std::vector<Connection>& connections) {
    std::vector<std::int64_t> begin = {0};
    std::vector<double> x;
    std::vector<double> y;
    std::vector<std::int64_t> cell;
    for (const Connection& connection : connections) {
        for (const Connector& c : connection.connectors) {
            x.push_back(c.at.x());
            y.push_back(c.at.y());
            cell.push_back(c.cell);
        }
        begin.push_back(static_cast<std::int64_t>(x.size()));
    }
    h5::Writer file = begin_shard(path, key);
    file.write("good",
               column<std::uint8_t>(connections, [](const Connection& c) { return c.good; }));
    file.write("begin", begin);
    file.write("x", x);
    file.write("y", y);
    file.write("cell", cell);
    finish_shard(file);
}

std::vector<Connection> read_connections(const std::filesystem::path& path) {
    const h5::Reader file(path);
    const auto good = file.read<std::uint8_t>("good");
    const auto begin = file.read<std::int64_t>("begin");
    const auto x = file.read<double>("x");
    const auto y = file.read<double>("y");
    const auto cell = file.read<std::int64_t>("cell");
    sound::offsets(file, "begin", begin, good.size(), 0, static_cast<std::int64_t>(x.size()));
    sound::count(file, "y", y, x.size());
    sound::count(file, "cell", cell, x.size());
    sound::finite(file, "x", x);
    sound::finite(file, "y", y);
    std::vector<Connection> out(good.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i].good = good[i] != 0;
        for (std::size_t k = idx(begin[i]); k < idx(begin[i + 1]); ++k) {
            out[i].connectors.push_back({{x[k], y[k]}, cell[k]});
        }
    }
    return out;
}

}  // namespace vfplan
