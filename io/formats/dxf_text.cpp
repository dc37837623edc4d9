#include "io/formats/dxf_text.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>
#include <unsupported/Eigen/Splines>
#include <vector>

#include "io/formats/text.h"
#include "kernels/error.h"
#include "kernels/vec.h"

namespace vfplan {
namespace {

struct Group {
    std::string_view number;  // its code as it stands there
    int code = 0;
    std::string_view value;
    std::string_view text;  // both lines
};

std::string_view trimmed(std::string_view s) {
    const auto from = s.find_first_not_of(" \t\r");
    if (from == std::string_view::npos) return {};
    return s.substr(from, s.find_last_not_of(" \t\r") - from + 1);
}

// The groups of a drawing, two lines each, one after the other.
class Groups {
public:
    explicit Groups(std::string_view text) : rest_(text) {}
    bool next(Group& out) {
        const std::string_view begin = rest_;
        const std::string_view code = line();
        if (rest_.empty()) return false;
        out.value = trimmed(line());
        out.number = trimmed(code);
        out.code = std::atoi(std::string(out.number).c_str());
        out.text = begin.substr(0, begin.size() - rest_.size());
        return true;
    }

private:
    std::string_view line() {
        const auto end = rest_.find('\n');
        const std::string_view out = rest_.substr(0, end);
        rest_ = end == std::string_view::npos ? std::string_view() : rest_.substr(end + 1);
        return out;
    }
    std::string_view rest_;
};

std::vector<Vec2d> drawn_through(const std::vector<Vec2d>& points) {
    constexpr std::size_t most = 400;  // the fit is by a full matrix
    if (points.size() < 3 || points.size() > most) return points;
    using Spline = Eigen::Spline<double, 2>;
    Eigen::Matrix<double, 2, Eigen::Dynamic> columns(2, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    const Eigen::Index degree = points.size() > 3 ? 3 : 2;
    Spline::KnotVectorType chords;
    Eigen::ChordLengths(columns, chords);
    const Spline spline = Eigen::SplineFitting<Spline>::Interpolate(columns, degree, chords);
    constexpr int steps = 16;
    std::vector<Vec2d> out;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double from = chords(static_cast<Eigen::Index>(i));
        const double to = chords(static_cast<Eigen::Index>(i) + 1);
        for (int k = 0; k < steps; ++k) {
            out.emplace_back(spline(from + (to - from) * k / steps).matrix());
        }
    }
    out.push_back(points.back());
    return out;
}

// An entity as it is read, group by group.
struct Entity {
    std::string text;
    std::string layer = "0";
    std::vector<double> x;  // of the points it leads through
    std::vector<double> y;
    bool control_points = false;
    bool spline = false;

    bool by_points() const {
        return spline && !control_points && x.size() > 1 && x.size() == y.size();
    }
    std::string written() const {
        if (!by_points()) return text;
        std::vector<Vec2d> points;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const Vec2d p(x[i], y[i]);
            if (points.empty() || p != points.back()) points.push_back(p);
        }
        std::string out =
            fmt::format("0\nLWPOLYLINE\n8\n{}\n100\nAcDbEntity\n100\nAcDbPolyline\n", layer);
        const std::vector<Vec2d> line = drawn_through(points);
        out += fmt::format("90\n{}\n70\n0\n", line.size());
        for (const Vec2d& p : line) out += fmt::format("10\n{:.17g}\n20\n{:.17g}\n", p.x(), p.y());
        return out;
    }
};

bool in_binary(const std::string& dxf) { return dxf.rfind("AutoCAD Binary DXF", 0) == 0; }

// As AutoCAD writes numbers, with a sign or without.
template <class Number>
bool is_number(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    return number_in<Number>(text).has_value();
}

}  // namespace

void check_dxf(const std::string& dxf, const std::filesystem::path& file) {
    if (in_binary(dxf)) return;
    Groups groups(dxf);
    Group g;
    for (std::size_t line = 1; groups.next(g); line += 2) {
        if (!is_number<int>(g.number)) {
            throw InputError(fmt::format(
                "{}:{}: '{:.40}' is no group code; the drawing is damaged, export it again",
                file.string(), line, g.number));
        }
        const bool place = g.code >= 10 && g.code <= 39;
        if (place && !is_number<double>(g.value)) {
            throw InputError(fmt::format(
                "{}:{}: the coordinate '{:.40}' is no number; correct the drawing, or export it "
                "again",
                file.string(), line + 1, g.value));
        }
    }
}

std::optional<std::string> with_splines_drawn(const std::string& dxf) {
    if (dxf.find("SPLINE") == std::string::npos || in_binary(dxf)) return {};
    std::string out;
    bool any = false;
    Entity now;
    Groups groups(dxf);
    Group g;
    std::size_t read = 0;
    while (groups.next(g)) {
        read += g.text.size();
        if (g.code == 0) {
            any = any || now.by_points();
            out += now.written();
            now = {};
            now.spline = g.value == "SPLINE";
        }
        now.text += g.text;
        if (!now.spline) continue;
        const auto number = [&] { return std::strtod(std::string(g.value).c_str(), nullptr); };
        if (g.code == 8) now.layer = g.value;
        if (g.code == 10) now.control_points = true;
        if (g.code == 11) now.x.push_back(number());
        if (g.code == 21) now.y.push_back(number());
    }
    if (!any && !now.by_points()) return {};
    out += now.written();
    return out + dxf.substr(read);
}

}  // namespace vfplan
