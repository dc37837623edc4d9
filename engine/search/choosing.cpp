#include "engine/search/choosing.h"

#include <algorithm>
#include <cassert>

namespace vfplan {

Choosing::Choosing(const Problem& problem)
    : p_(problem),
      place_(idx(p_.columns()), -1),
      cover_(idx(p_.rows()), 0),
      owner_(idx(p_.rows()), 0),
      alone_(idx(p_.columns()), 0),
      links_(idx(p_.columns())) {}

std::int64_t Choosing::chosen_beside(std::int32_t column) const {
    if (p_.beside.size() == 0) return 0;
    const auto list = p_.beside.of(column);
    return std::count_if(list.begin(), list.end(), [&](std::int32_t n) { return is_chosen(n); });
}

void Choosing::put(std::int32_t column) {
    assert(!is_chosen(column));
    pairs_beside_ += chosen_beside(column);
    place_[idx(column)] = static_cast<std::int32_t>(chosen_.size());
    chosen_.push_back(column);
    for (const std::int32_t r : p_.rows_of.of(column)) {
        const std::int32_t before = cover_[idx(r)]++;
        if (before == 0) {
            ++alone_[idx(column)];
        } else if (before == 1) {
            if (--alone_[idx(owner_[idx(r)])] == 0) spared_.push_back(owner_[idx(r)]);
        }
        owner_[idx(r)] ^= column;
    }
    for (const std::int32_t n : p_.near.of(column)) links_[idx(n)].push_back(column);
}

void Choosing::take(std::int32_t column) {
    assert(is_chosen(column));
    pairs_beside_ -= chosen_beside(column);
    const std::int32_t last = chosen_.back();
    chosen_[idx(place_[idx(column)])] = last;
    place_[idx(last)] = place_[idx(column)];
    chosen_.pop_back();
    place_[idx(column)] = -1;
    for (const std::int32_t r : p_.rows_of.of(column)) {
        owner_[idx(r)] ^= column;
        const std::int32_t left = --cover_[idx(r)];
        if (left == 0) {
            bared_.push_back(r);
        } else if (left == 1) {
            ++alone_[idx(owner_[idx(r)])];
        }
    }
    alone_[idx(column)] = 0;
    for (const std::int32_t n : p_.near.of(column)) {
        std::vector<std::int32_t>& list = links_[idx(n)];
        *std::find(list.begin(), list.end(), column) = list.back();
        list.pop_back();
    }
}

void Choosing::add(std::int32_t column) {
    put(column);
    changes_.push_back(column);
}

void Choosing::remove(std::int32_t column) {
    take(column);
    changes_.push_back(column);
}

void Choosing::back_to(std::size_t mark) {
    while (changes_.size() > mark) {
        const std::int32_t column = changes_.back();
        changes_.pop_back();
        if (is_chosen(column)) {
            take(column);
        } else {
            put(column);
        }
    }
}

Choice Choosing::choice() const {
    Choice out = chosen_;
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace vfplan
