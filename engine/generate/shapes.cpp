#include "engine/generate/shapes.h"

#include <algorithm>
#include <array>

namespace vfplan::generate {

bool closer_than(const Rect& a, const Rect& b, double gap) {
    const Vec2d v = b.c - a.c;
    const double far = a.along + a.deep + b.along + b.deep + gap;
    if (std::abs(v.x()) > far || std::abs(v.y()) > far) return false;
    const std::array<Vec2d, 4> axes{a.d, left_of(a.d), b.d, left_of(b.d)};
    return std::none_of(axes.begin(), axes.end(), [&](const Vec2d& axis) {
        return std::abs(v.dot(axis)) >= a.reach(axis) + b.reach(axis) + gap;
    });
}

std::vector<Vec2d> house_outline(Random& random, const Rect& r, char shape) {
    const double a = r.along;
    const double d = r.deep;
    std::vector<Vec2d> local;
    if (shape == 'L') {
        const double x = a * random.range(-0.1, 0.35);
        const double y = d * random.range(-0.1, 0.35);
        local = {{-a, -d}, {a, -d}, {a, y}, {x, y}, {x, d}, {-a, d}};
        if (random.chance(0.5)) {  // mirrored
            for (Vec2d& p : local) p.x() = -p.x();
            std::reverse(local.begin(), local.end());
        }
    } else if (shape == 'T') {
        const double x0 = a * random.range(-0.6, -0.3);
        const double x1 = a * random.range(0.3, 0.6);
        const double y = d * random.range(0.0, 0.35);
        local = {{-a, -d}, {a, -d}, {a, y}, {x1, y}, {x1, d}, {x0, d}, {x0, y}, {-a, y}};
    } else if (shape == 'U') {
        const double x = a * random.range(0.5, 0.62);
        const double y = d * random.range(-0.35, -0.15);
        local = {{-a, -d}, {a, -d}, {a, d}, {x, d}, {x, y}, {-x, y}, {-x, d}, {-a, d}};
    } else if (shape == '+') {  // nave, transept, apse
        const double y = d * 0.45;
        const double x0 = a * 0.25;
        const double x1 = a * 0.62;
        local = {{-a, -y},       {x0, -y},      {x0, -d},     {x1, -d},      {x1, -y},
                 {0.88 * a, -y}, {a, -0.5 * y}, {a, 0.5 * y}, {0.88 * a, y}, {x1, y},
                 {x1, d},        {x0, d},       {x0, y},      {-a, y}};
    } else {
        local = {{-a, -d}, {a, -d}, {a, d}, {-a, d}};
    }
    for (Vec2d& p : local) p = r.at(p.x(), p.y());
    return local;
}

Line rounded(Line line) {
    for (int pass = 0; pass < 3; ++pass) {
        Line next{line.front()};
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            next.emplace_back(0.75 * line[i] + 0.25 * line[i + 1]);
            next.emplace_back(0.25 * line[i] + 0.75 * line[i + 1]);
        }
        next.push_back(line.back());
        line = std::move(next);
    }
    return line;
}

double across(const Line& line, int axis, double v) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double a = line[i][axis];
        const double b = line[i + 1][axis];
        if (v <= b || i + 2 == line.size()) {
            return line[i][1 - axis] +
                   (line[i + 1][1 - axis] - line[i][1 - axis]) * (v - a) / (b - a);
        }
    }
    return 0;
}

Vec2d along_line(const Line& line, double s) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const Vec2d v = line[i + 1] - line[i];
        const double length = v.norm();
        if (s <= length || i + 2 == line.size()) return line[i] + v * (s / length);
        s -= length;
    }
    return line.front();
}

}  // namespace vfplan::generate
