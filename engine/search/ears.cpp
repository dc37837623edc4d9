#include "engine/search/ears.h"

#include <algorithm>

namespace vfplan {

std::int64_t Ears::close(double most_columns) {
    const bool at_any_cost = most_columns >= any_cost;
    std::int64_t loose = structure_.find_cycles();
    if (loose == 0) return loose;
    std::vector<std::int32_t> waiting;
    for (const std::int32_t c : c_.chosen()) {
        if (structure_.is_loose(c)) waiting.push_back(c);
    }
    std::sort(waiting.begin(), waiting.end());
    dice_.shuffle(waiting);
    for (const std::int32_t v : waiting) {
        if (structure_.on_cycle(v)) continue;
        std::vector<std::int32_t> links = c_.links(v);
        if (p_.closable.empty() || p_.closable[idx(v)] == 0) {
            std::erase_if(links,
                          [&](std::int32_t n) { return p_.block[idx(n)] != p_.block[idx(v)]; });
        }
        if (links.empty()) continue;  // a node of a window that lost all else
        ear_.clear();
        if (at_any_cost) {
            for (const std::int32_t n : links) find(v, n);
        } else {
            find(v, links[idx(dice_.below(static_cast<std::int64_t>(links.size())))]);
        }
        if (ear_.empty()) continue;
        const std::size_t mark = c_.changes();
        for (const std::int32_t c : ear_) c_.add(c);
        const std::int64_t then = structure_.find_cycles();
        if (static_cast<double>(ear_.size()) > most_columns * static_cast<double>(loose - then)) {
            c_.back_to(mark);
            structure_.find_cycles();
        } else {
            loose = then;
        }
    }
    return loose;
}

// Keeps the ear in ear_ where it is shorter than what that holds, or that is empty.
void Ears::find(std::int32_t a, std::int32_t b) {
    // From both ends in turn, so that it costs what the lesser side holds.
    ++now_;
    sides_[0].assign(1, a);
    sides_[1].assign(1, b);
    side_[idx(a)] = side_[idx(b)] = now_;
    std::size_t lesser = 2;
    for (std::size_t i = 0; lesser > 1; ++i) {
        lesser = 0;
        while (lesser < 2 && i < sides_[lesser].size()) ++lesser;
        if (lesser < 2) break;
        for (std::vector<std::int32_t>& side : sides_) {
            for (const std::int32_t n : c_.links(side[i])) {
                if (side_[idx(n)] == now_) continue;
                side_[idx(n)] = now_;
                side.push_back(n);
            }
        }
    }
    ++now_;
    for (const std::int32_t c : sides_[lesser]) side_[idx(c)] = now_;
    const std::vector<std::int32_t>& ear = ways_.from(sides_[lesser], [&](std::int32_t n) {
        const std::vector<std::int32_t>& links = c_.links(n);
        return std::any_of(links.begin(), links.end(),
                           [&](std::int32_t s) { return side_[idx(s)] != now_; })
                   ? 1
                   : 0;
    });
    if (ear_.empty() || (!ear.empty() && ear.size() < ear_.size())) ear_ = ear;
}

}  // namespace vfplan
