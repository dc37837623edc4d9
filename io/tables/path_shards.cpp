#include "io/tables/path_shards.h"

#include "io/columns.h"
#include "io/h5_reader.h"
#include "kernels/index.h"

namespace vfplan {

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
    const auto both = h5::Reader(path).read<std::int32_t>("pair");
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

std::int64_t Components::count() const {
    return static_cast<std::int64_t>(h5::Reader(file_).number("/", "count"));
}

std::vector<std::int32_t> Components::of(const std::vector<std::int32_t>& numbers) const {
    const h5::Reader file(file_);
    std::vector<std::int32_t> out;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t k = i + 1;  // consecutive ones in one go
        while (k < numbers.size() && numbers[k] == numbers[k - 1] + 1) ++k;
        const auto some = file.read<std::int32_t>("component", idx(numbers[i]), k - i);
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
    std::vector<ShortestPath> out(length.size());
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
