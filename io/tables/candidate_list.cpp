#include "io/tables/candidate_list.h"

#include <algorithm>
#include <tuple>

#include "io/columns.h"
#include "io/h5_reader.h"
#include "io/tables/sound.h"
#include "kernels/index.h"

namespace vfplan {

void write_candidate_list(const std::filesystem::path& path, const std::string& key,
                          const Layout& layout, std::vector<Candidate> candidates,
                          const ListCounts& counts) {
    const auto patch_of = [&](const Candidate& c) { return layout.patch_of(layout.cell_at(c.at)); };
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Candidate& a, const Candidate& b) {
                         return std::tuple(patch_of(a), a.at.y(), a.at.x(), a.kind) <
                                std::tuple(patch_of(b), b.at.y(), b.at.x(), b.kind);
                     });
    candidates.erase(
        std::unique(candidates.begin(), candidates.end(),
                    [](const Candidate& a, const Candidate& b) { return a.at == b.at; }),
        candidates.end());
    std::vector<std::int64_t> begin(idx(layout.patches()) + 1, 0);
    for (const Candidate& c : candidates) ++begin[idx(patch_of(c)) + 1];
    for (std::size_t p = 0; p + 1 < begin.size(); ++p) begin[p + 1] += begin[p];
    constexpr std::uint64_t chunk = 1U << 12;
    h5::Writer file = begin_shard(path, key);
    file.attribute("/", "components", counts.components);
    file.attribute("/", "rescued_pieces", counts.rescued_pieces);
    file.write("patch_begin", begin);
    const auto write = [&](const char* name, auto example, auto&& value) {
        file.write(name, column<decltype(example)>(candidates, value), {}, chunk);
    };
    write("x", double{}, [](const Candidate& c) { return c.at.x(); });
    write("y", double{}, [](const Candidate& c) { return c.at.y(); });
    write("cell", std::int64_t{}, [](const Candidate& c) { return c.cell; });
    write("kind", std::uint8_t{}, [](const Candidate& c) { return c.kind; });
    finish_shard(file);
}

namespace {

std::vector<Candidate> read_some(const h5::Reader& file, std::int64_t from, std::int64_t to) {
    const std::uint64_t count = idx(to - from);
    const auto x = file.read<double>("x", idx(from), count);
    const auto y = file.read<double>("y", idx(from), count);
    const auto cell = file.read<std::int64_t>("cell", idx(from), count);
    const auto kind = file.read<std::uint8_t>("kind", idx(from), count);
    sound::finite(file, "x", x);
    sound::finite(file, "y", y);
    sound::codes<CandidateKind>(file, "kind", kind);
    std::vector<Candidate> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        out.push_back({{x[i], y[i]}, cell[i], static_cast<CandidateKind>(kind[i]), 0});
    }
    return out;
}

}  // namespace

CandidateList::CandidateList(std::filesystem::path file, Layout layout,
                             std::vector<Candidate> of_user)
    : file_(std::move(file)),
      layout_(std::move(layout)),
      of_user_(std::move(of_user)),
      listed_(static_cast<std::int64_t>(h5::Reader(file_).dims("x").at(0))) {}

ListCounts CandidateList::counts() const {
    constexpr std::int64_t most = std::int64_t{1} << 31;
    const h5::Reader file(file_);
    return {file.whole("/", "components", 0, most), file.whole("/", "rescued_pieces", 0, most)};
}

std::vector<Candidate> CandidateList::read(std::int64_t from, std::int64_t to) const {
    std::vector<Candidate> out;
    if (from < listed_) out = read_some(h5::Reader(file_), from, std::min(to, listed_));
    for (std::int64_t i = std::max(from, listed_); i < to; ++i) {
        out.push_back(of_user_[idx(i - listed_)]);
    }
    return out;
}

CandidateList::Part CandidateList::in(const Window& window) const {
    const h5::Reader file(file_);
    const auto begin = file.read<std::int64_t>("patch_begin");
    sound::offsets(file, "patch_begin", begin, idx(layout_.patches()), 0, listed_);
    Part out;
    const std::vector<std::int64_t> patches = layout_.patches_in(window);
    for (std::size_t i = 0; i < patches.size();) {
        std::size_t k = i + 1;  // patches beside each other in one go
        while (k < patches.size() && patches[k] == patches[k - 1] + 1) ++k;
        const std::int64_t from = begin[idx(patches[i])];
        const std::int64_t to = begin[idx(patches[k - 1]) + 1];
        for (std::int64_t n = from; n < to; ++n) {
            out.number.push_back(static_cast<std::int32_t>(n));
        }
        const std::vector<Candidate> some = read_some(file, from, to);
        out.candidates.insert(out.candidates.end(), some.begin(), some.end());
        i = k;
    }
    for (std::size_t i = 0; i < of_user_.size(); ++i) {
        const std::int64_t patch = layout_.patch_of(layout_.cell_at(of_user_[i].at));
        if (!std::binary_search(patches.begin(), patches.end(), patch)) continue;
        out.number.push_back(static_cast<std::int32_t>(listed_ + static_cast<std::int64_t>(i)));
        out.candidates.push_back(of_user_[i]);
    }
    return out;
}

}  // namespace vfplan
