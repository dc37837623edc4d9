#include "engine/job/squares.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernels/index.h"

namespace vfplan {
namespace {

double area(const Box& box) { return box.size().x() * box.size().y(); }

double faces_m(const Wall& w) {
    return w.scanned ? (w.free_side[left] + w.free_side[right]) * w.length_m() : 0;
}

// Whether the box of a stretch a-b meets another.
bool meets(const Box& box, const Vec2d& a, const Vec2d& b) {
    return std::min(a.x(), b.x()) <= box.max.x() && std::max(a.x(), b.x()) >= box.min.x() &&
           std::min(a.y(), b.y()) <= box.max.y() && std::max(a.y(), b.y()) >= box.min.y();
}

Box grown(const Box& box, double by_m) {
    const Vec2d by(by_m, by_m);
    return {box.min - by, box.max + by};
}

}  // namespace

Squares::Squares(const Site& site, double side_m) : extent_(site.extent), side_m_(side_m) {
    const auto along = [&](double m) {
        return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(m / side_m)));
    };
    columns_ = along(extent_.size().x());
    const std::int64_t rows = along(extent_.size().y());
    walls_m_.assign(idx(columns_ * rows), 0);
    // What has to be scanned counts; where nothing has, all that stands.
    const bool scanned = std::any_of(site.walls.begin(), site.walls.end(),
                                     [](const Wall& w) { return faces_m(w) > 0; });
    for (const Wall& w : site.walls) {
        const Vec2d p = ((w.a + w.b) / 2 - extent_.min) / side_m_;
        const auto x = std::clamp<std::int64_t>(static_cast<std::int64_t>(p.x()), 0, columns_ - 1);
        const auto y = std::clamp<std::int64_t>(static_cast<std::int64_t>(p.y()), 0, rows - 1);
        const double length_m = scanned ? faces_m(w) : w.length_m();
        walls_m_[idx(y * columns_ + x)] += length_m;
        all_walls_m_ += length_m;
    }
}

std::vector<Squares::Taken> Squares::by_walls(int n) const {
    std::vector<Taken> out;
    double before = 0;
    int hits = 0;
    for (std::size_t i = 0; i < walls_m_.size(); ++i) {
        before += walls_m_[i];
        const int first = hits;
        while (hits < n && before > all_walls_m_ * (hits + 0.5) / n) ++hits;
        if (hits > first) out.push_back({i, static_cast<double>(hits - first)});
    }
    return out;
}

std::vector<Squares::Taken> Squares::without_walls(int n) const {
    const auto empty = std::count(walls_m_.begin(), walls_m_.end(), 0.0);
    std::vector<Taken> out;
    std::int64_t number = 0;
    for (std::size_t i = 0; i < walls_m_.size(); ++i) {
        if (walls_m_[i] > 0) continue;
        const auto hits = static_cast<double>(out.size());
        if (static_cast<double>(++number) >= static_cast<double>(empty) * (hits + 0.5) / n) {
            out.push_back({i, 1});
        }
    }
    return out;
}

Box Squares::box(std::size_t square) const {
    const auto n = static_cast<std::int64_t>(square);
    const Vec2d lo = extent_.min + side_m_ * Vec2d(static_cast<double>(n % columns_),
                                                   static_cast<double>(n / columns_));
    return {lo, (lo + Vec2d(side_m_, side_m_)).cwiseMin(extent_.max)};
}

double Squares::share_with_walls() const {
    double with = 0;
    for (std::size_t i = 0; i < walls_m_.size(); ++i) {
        if (walls_m_[i] > 0) with += area(box(i));
    }
    return std::min(1.0, with / std::max(area(extent_), 1e-12));
}

Site part_of_site(const Site& site, const Box& box, double reach_m, std::size_t walls_most) {
    Site out;
    out.origin = site.origin;
    out.crs_wkt = site.crs_wkt;
    out.extent = box;
    for (;; reach_m *= 0.7) {
        const Box around = grown(box, reach_m);
        const auto near = [&](const Wall& w) { return meets(around, w.a, w.b); };
        const auto walls = std::count_if(site.walls.begin(), site.walls.end(), near);
        constexpr double nothing_m = 1e-3;
        if (idx(walls) > walls_most && reach_m > nothing_m) continue;
        std::copy_if(site.walls.begin(), site.walls.end(), std::back_inserter(out.walls), near);
        break;
    }
    // A piece in the north, south or east of all cells is crossed by no count of theirs.
    const Box around = grown(box, reach_m);
    for (const Border& piece : site.free_border) {
        if (std::min(piece.a.y(), piece.b.y()) > around.max.y() ||
            std::max(piece.a.y(), piece.b.y()) < around.min.y() ||
            std::min(piece.a.x(), piece.b.x()) > around.max.x()) {
            continue;
        }
        out.free_border.push_back(piece);
    }
    return out;
}

}  // namespace vfplan
