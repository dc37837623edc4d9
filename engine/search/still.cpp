#include "engine/search/still.h"

#include <algorithm>
#include <utility>

#include "engine/graphs/cuts.h"

namespace vfplan {
namespace {

class Outside {
public:
    Outside(const Problem& whole, const Choosing& plan, const std::vector<std::uint8_t>& inside,
            const std::vector<std::uint8_t>& touched)
        : p_(whole), plan_(plan), inside_(inside), touched_(touched), number_(inside.size(), -1) {
        for (const std::int32_t c : plan.chosen()) {
            if (inside[idx(c)] != 0) continue;
            number_[idx(c)] = static_cast<std::int32_t>(station_.size());
            station_.push_back(c);
        }
    }

    // One node for each part that hangs together.
    Still parts() {
        std::vector<std::int32_t> part(station_.size(), -1);
        std::int32_t parts = 0;
        std::vector<std::int32_t> stack;
        for (std::size_t seed = 0; seed < part.size(); ++seed) {
            if (part[seed] >= 0) continue;
            part[seed] = parts;
            stack.assign(1, static_cast<std::int32_t>(seed));
            while (!stack.empty()) {
                const std::int32_t v = stack.back();
                stack.pop_back();
                each_link(v, [&](std::int32_t w) {
                    if (part[idx(w)] >= 0) return;
                    part[idx(w)] = parts;
                    stack.push_back(w);
                });
            }
            ++parts;
        }
        return numbered(part, parts);
    }

    // The tree of blocks of each part, without branches that no cycle through the window can reach,
    // and with what lies between two forks or touched nodes in one.
    Still forest() {
        find_blocks();
        std::vector<std::vector<std::int32_t>>& near = near_;
        std::vector<std::int32_t> degree(near.size(), 0);
        std::vector<std::uint8_t> kept(near.size(), 0);
        for (std::size_t s = 0; s < station_.size(); ++s) {
            if (touched_[idx(station_[s])] != 0) kept[idx(block_[s])] = 1;
        }
        const std::vector<std::uint8_t> gone = bare_branches(near, kept);
        for (std::size_t b = 0; b < near.size(); ++b) {
            std::erase_if(near[b], [&](std::int32_t n) { return gone[idx(n)] != 0; });
            degree[b] = static_cast<std::int32_t>(near[b].size());
        }
        // What has two neighbours and is not touched is drawn together with those like it.
        std::vector<std::int32_t> drawn(near.size(), -1);
        std::int32_t count = 0;
        const auto between = [&](std::int32_t b) {
            return kept[idx(b)] == 0 && degree[idx(b)] == 2;
        };
        for (std::size_t b = 0; b < near.size(); ++b) {
            if (gone[b] != 0 || drawn[b] >= 0) continue;
            drawn[b] = count;
            if (between(static_cast<std::int32_t>(b))) {
                std::vector<std::int32_t> stack = {static_cast<std::int32_t>(b)};
                while (!stack.empty()) {
                    const std::int32_t v = stack.back();
                    stack.pop_back();
                    for (const std::int32_t n : near[idx(v)]) {
                        if (drawn[idx(n)] >= 0 || !between(n)) continue;
                        drawn[idx(n)] = count;
                        stack.push_back(n);
                    }
                }
            }
            ++count;
        }
        std::vector<std::int32_t> of(station_.size());
        for (std::size_t s = 0; s < of.size(); ++s) of[s] = drawn[idx(block_[s])];
        Still out = numbered(of, count);
        for (std::size_t b = 0; b < near.size(); ++b) {
            if (gone[b] != 0) continue;
            for (const std::int32_t n : near[b]) {
                if (drawn[b] < drawn[idx(n)]) out.links.emplace_back(drawn[b], drawn[idx(n)]);
            }
        }
        out.block.assign(idx(count), -1);
        out.loose.assign(idx(count), 0);
        out.closable.assign(idx(count), 0);
        for (std::size_t s = 0; s < station_.size(); ++s) {
            if (of[s] < 0) continue;
            const std::int32_t c = station_[s];
            out.block[idx(of[s])] = p_.block[idx(c)];
            if (size_[idx(block_[s])] > 1) continue;  // on a cycle whatever comes
            const auto& links = plan_.links(c);
            const bool closable =
                (!p_.closable.empty() && p_.closable[idx(c)] != 0) ||
                std::any_of(links.begin(), links.end(), [&](std::int32_t n) {
                    return inside_[idx(n)] == 0 && p_.block[idx(n)] == p_.block[idx(c)];
                });
            const bool alone = kept[idx(block_[s])] != 0 || degree[idx(block_[s])] != 2;
            if (alone || closable) out.loose[idx(of[s])] += p_.loose[idx(c)];
            if (closable) out.closable[idx(of[s])] = 1;
        }
        return out;
    }

private:
    template <class F>
    void each_link(std::int32_t s, F&& f) const {
        for (const std::int32_t n : plan_.links(station_[idx(s)])) {
            if (inside_[idx(n)] == 0) f(number_[idx(n)]);
        }
    }

    // block_, and size_ and the forest near_ of blocks.
    void find_blocks() {
        Graph graph;
        for (std::size_t s = 0; s < station_.size(); ++s) {
            each_link(static_cast<std::int32_t>(s), [&](std::int32_t n) {
                graph.to.push_back(n);
                graph.overlap.push_back(0);  // does not matter
            });
            graph.begin.push_back(static_cast<std::int64_t>(graph.to.size()));
        }
        block_ = find_cuts(graph).block;
        for (std::size_t s = 0; s < station_.size(); ++s) {
            const std::size_t b = idx(block_[s]);
            if (b >= size_.size()) {
                size_.resize(b + 1, 0);
                near_.resize(b + 1);
            }
            ++size_[b];
            each_link(static_cast<std::int32_t>(s), [&](std::int32_t n) {
                if (block_[idx(n)] != block_[s]) near_[b].push_back(block_[idx(n)]);
            });
        }
    }

    // Branches with nothing kept in them.
    static std::vector<std::uint8_t> bare_branches(
        const std::vector<std::vector<std::int32_t>>& near, const std::vector<std::uint8_t>& kept) {
        std::vector<std::uint8_t> gone(near.size(), 0);
        std::vector<std::size_t> left(near.size());
        std::vector<std::int32_t> leaves;
        for (std::size_t b = 0; b < near.size(); ++b) {
            left[b] = near[b].size();
            if (left[b] < 2 && kept[b] == 0) leaves.push_back(static_cast<std::int32_t>(b));
        }
        while (!leaves.empty()) {
            const std::int32_t b = leaves.back();
            leaves.pop_back();
            if (gone[idx(b)] != 0) continue;
            gone[idx(b)] = 1;
            for (const std::int32_t n : near[idx(b)]) {
                if (gone[idx(n)] == 0 && --left[idx(n)] < 2 && kept[idx(n)] == 0) {
                    leaves.push_back(n);
                }
            }
        }
        return gone;
    }

    Still numbered(const std::vector<std::int32_t>& of, std::int32_t count) const {
        Still out;
        out.nodes = count;
        out.node.assign(inside_.size(), -1);
        for (std::size_t s = 0; s < of.size(); ++s) out.node[idx(station_[s])] = of[s];
        return out;
    }

    const Problem& p_;
    const Choosing& plan_;
    const std::vector<std::uint8_t>& inside_;
    const std::vector<std::uint8_t>& touched_;
    std::vector<std::int32_t> number_;             // by column, among the stations outside
    std::vector<std::int32_t> station_;            // outside
    std::vector<std::int32_t> block_;              // by station
    std::vector<std::int32_t> size_;               // by block
    std::vector<std::vector<std::int32_t>> near_;  // by block
};

}  // namespace

Still find_still(const Problem& whole, const Choosing& plan,
                 const std::vector<std::uint8_t>& inside,
                 const std::vector<std::uint8_t>& touched) {
    Outside outside(whole, plan, inside, touched);
    return whole.loose.empty() ? outside.parts() : outside.forest();
}

}  // namespace vfplan
