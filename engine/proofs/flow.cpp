#include "engine/proofs/flow.h"

#include <algorithm>
#include <tuple>

#include "kernels/index.h"

namespace vfplan {

std::int32_t Flow::add(std::int32_t from, std::int32_t to, std::int64_t capacity) {
    const auto edge = static_cast<std::int32_t>(to_.size());
    for (const auto& [a, b, c] :
         {std::tuple(from, to, capacity), std::tuple(to, from, std::int64_t{0})}) {
        next_.push_back(first_[idx(a)]);
        first_[idx(a)] = static_cast<std::int32_t>(to_.size());
        to_.push_back(b);
        capacity_.push_back(c);
    }
    return edge;
}

bool Flow::levels(std::int32_t source, std::int32_t sink) {
    level_.assign(first_.size(), -1);
    level_[idx(source)] = 0;
    queue_.assign(1, source);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
        const std::int32_t v = queue_[i];
        if (level_[idx(sink)] >= 0 && level_[idx(v)] >= level_[idx(sink)]) break;
        for (std::int32_t e = first_[idx(v)]; e >= 0; e = next_[idx(e)]) {
            ++work_;
            const std::int32_t n = to_[idx(e)];
            if (capacity_[idx(e)] == 0 || level_[idx(n)] >= 0) continue;
            level_[idx(n)] = level_[idx(v)] + 1;
            queue_.push_back(n);
        }
    }
    return level_[idx(sink)] >= 0;
}

std::int64_t Flow::run(std::int32_t source, std::int32_t sink, std::int64_t enough) {
    std::int64_t flow = 0;
    while (flow < enough && levels(source, sink)) {
        turn_ = first_;
        path_.clear();
        std::int32_t v = source;
        while (flow < enough) {
            if (v == sink) {
                std::int64_t least = endless;
                for (const std::int32_t e : path_) least = std::min(least, capacity_[idx(e)]);
                for (const std::int32_t e : path_) {
                    capacity_[idx(e)] -= least;
                    capacity_[idx(e ^ 1)] += least;
                }
                flow += least;
                // Back to where the path is used up.
                std::size_t i = 0;
                while (capacity_[idx(path_[i])] > 0) ++i;
                v = to_[idx(path_[i] ^ 1)];
                path_.resize(i);
                continue;
            }
            std::int32_t& e = turn_[idx(v)];
            while (e >= 0 &&
                   (capacity_[idx(e)] == 0 || level_[idx(to_[idx(e)])] != level_[idx(v)] + 1)) {
                ++work_;
                e = next_[idx(e)];
            }
            if (e >= 0) {
                path_.push_back(e);
                v = to_[idx(e)];
                continue;
            }
            if (path_.empty()) break;
            level_[idx(v)] = -1;
            v = to_[idx(path_.back() ^ 1)];
            path_.pop_back();
        }
    }
    return flow;
}

std::vector<std::uint8_t> Flow::source_side(std::int32_t source) const {
    std::vector<std::uint8_t> side(first_.size(), 0);
    side[idx(source)] = 1;
    std::vector<std::int32_t> queue = {source};
    for (std::size_t i = 0; i < queue.size(); ++i) {
        for (std::int32_t e = first_[idx(queue[i])]; e >= 0; e = next_[idx(e)]) {
            if (capacity_[idx(e)] == 0 || side[idx(to_[idx(e)])] != 0) continue;
            side[idx(to_[idx(e)])] = 1;
            queue.push_back(to_[idx(e)]);
        }
    }
    return side;
}

std::vector<std::uint8_t> Flow::sink_side(std::int32_t sink) const {
    std::vector<std::uint8_t> side(first_.size(), 0);
    side[idx(sink)] = 1;
    std::vector<std::int32_t> queue = {sink};
    for (std::size_t i = 0; i < queue.size(); ++i) {
        for (std::int32_t e = first_[idx(queue[i])]; e >= 0; e = next_[idx(e)]) {
            if (capacity_[idx(e ^ 1)] == 0 || side[idx(to_[idx(e)])] != 0) continue;
            side[idx(to_[idx(e)])] = 1;
            queue.push_back(to_[idx(e)]);
        }
    }
    return side;
}

}  // namespace vfplan
