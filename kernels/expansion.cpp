#include "kernels/expansion.h"

#include <algorithm>
#include <utility>

#include "kernels/index.h"

namespace vfplan {

Behind Expansion::behind(std::int32_t triangle, std::size_t edge) const {
    const Triangle& t = mesh.triangles[idx(triangle)];
    if (t.wall[edge] >= 0) return behind_wall(t.wall[edge]);
    if (t.neighbour[edge] < 0) return behind_hull;
    return 3 * triangle + static_cast<Behind>(edge);
}

Expansion::Expansion(Triangulation triangulation) : mesh(std::move(triangulation)) {
    const auto count = static_cast<std::int32_t>(mesh.triangles.size());
    crossings.reserve(3 * mesh.triangles.size());
    for (std::int32_t t = 0; t < count; ++t) {
        for (const std::int32_t across : mesh.triangles[idx(t)].neighbour) {
            if (across < 0) {
                crossings.push_back({0, 0, behind_hull, behind_hull});
                continue;
            }
            const Triangle& next = mesh.triangles[idx(across)];
            const auto entry = static_cast<std::size_t>(
                std::find(next.neighbour.begin(), next.neighbour.end(), t) -
                next.neighbour.begin());
            const Vec2d& apex = mesh.vertices[idx(next.vertex[entry])];
            crossings.push_back({apex.x(), apex.y(), behind(across, (entry + 1) % 3),
                                 behind(across, (entry + 2) % 3)});
        }
    }
}

}  // namespace vfplan
