#include "kernels/faces.h"

#include <array>

#include "kernels/index.h"

namespace vfplan {
namespace {

// The areas around the place where a walk through the triangles stands.
class Around {
public:
    Around(const Noded& noded, std::span<const AreaKind> kind_of)
        : noded_(noded), kind_of_(kind_of), inside_(kind_of.size(), 0) {}

    // Over an edge, or back over it.
    void cross(std::int32_t edge) {
        if (edge < 0) return;
        for (const std::int32_t label : noded_.labels_of(idx(edge))) {
            const AreaKind kind = kind_of_[idx(label)];
            if (kind == line_kind) continue;
            inside_[idx(label)] ^= 1;
            areas_[idx(kind)] += inside_[idx(label)] != 0 ? 1 : -1;
            const auto bit = static_cast<Kinds>(1U << static_cast<unsigned>(kind));
            kinds_ = static_cast<Kinds>(areas_[idx(kind)] > 0 ? kinds_ | bit : kinds_ & ~bit);
        }
    }
    Kinds kinds() const { return kinds_; }

private:
    const Noded& noded_;
    std::span<const AreaKind> kind_of_;
    std::vector<std::uint8_t> inside_;  // by label
    std::array<std::int32_t, 16> areas_{};
    Kinds kinds_ = 0;
};

std::int32_t outer_triangle(const Triangulation& t) {
    for (std::size_t i = 0; i < t.triangles.size(); ++i) {
        for (const std::int32_t n : t.triangles[i].neighbour) {
            if (n < 0) return static_cast<std::int32_t>(i);
        }
    }
    return -1;
}

}  // namespace

std::vector<Kinds> kinds_around(const Triangulation& triangles, const Noded& noded,
                                std::span<const AreaKind> kind_of) {
    std::vector<Kinds> out(triangles.triangles.size(), 0);
    if (out.empty()) return out;
    std::vector<bool> seen(out.size(), false);
    Around around(noded, kind_of);
    // Depth first, so that the areas around are those of the way here and need no copies.
    struct Step {
        std::int32_t triangle;
        std::int32_t crossed;  // the edge that led here, -1 for none
        std::uint8_t next = 0;
    };
    std::vector<Step> way = {{outer_triangle(triangles), -1}};
    seen[idx(way.back().triangle)] = true;
    while (!way.empty()) {
        Step& here = way.back();
        if (here.next == 3) {
            around.cross(here.crossed);
            way.pop_back();
            continue;
        }
        const Triangle& t = triangles.triangles[idx(here.triangle)];
        const std::int32_t to = t.neighbour[here.next];
        const std::int32_t edge = t.wall[here.next];
        ++here.next;
        if (to < 0 || seen[idx(to)]) continue;
        seen[idx(to)] = true;
        around.cross(edge);
        out[idx(to)] = around.kinds();
        way.push_back({to, edge});
    }
    return out;
}

}  // namespace vfplan
