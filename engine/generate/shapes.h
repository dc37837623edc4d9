// The shapes that a town is drawn with: directed rectangles, house outlines, bent lines.
#pragma once

#include <cmath>
#include <vector>

#include "engine/generate/drawing.h"
#include "kernels/vec.h"

namespace vfplan::generate {

// A rectangle with a direction; `along` is half its width, `deep` half its depth.
struct Rect {
    Vec2d c;
    Vec2d d;
    double along = 0;
    double deep = 0;

    double reach(const Vec2d& axis) const {
        return along * std::abs(d.dot(axis)) + deep * std::abs(left_of(d).dot(axis));
    }
    Vec2d half_box() const { return {reach({1, 0}), reach({0, 1})}; }
    Vec2d at(double s, double t) const { return c + s * d + t * left_of(d); }
};

// Whether less than `gap` lies between two rectangles; near corners it may say so a little early.
bool closer_than(const Rect& a, const Rect& b, double gap);

// Outlines of shape r(ectangle), L, T, U or + (a church); they fill their rectangle up to
// notches. Counter-clockwise.
std::vector<Vec2d> house_outline(Random& random, const Rect& r, char shape);

using Line = std::vector<Vec2d>;

// Chaikin's corner cutting: bends become curves without any trigonometry.
Line rounded(Line line);

// `line` as a function: coordinate 1 - axis at the place where coordinate `axis` is v.
double across(const Line& line, int axis, double v);

// The point s metres along the line; beyond its end, straight on.
Vec2d along_line(const Line& line, double s);

}  // namespace vfplan::generate
