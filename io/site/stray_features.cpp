#include "io/site/stray_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/stray.h"

namespace vfplan {
namespace {

bool makes_walls(Role role, const SiteOptions& options) {
    switch (role) {
        case Role::ignored:
        case Role::opening:
        case Role::room:
            return false;
        case Role::door:
            return options.kind == SiteKind::outdoor || options.doors == DoorMode::closed;
        case Role::window:
            return options.kind == SiteKind::outdoor || options.windows != WindowMode::opening;
        default:
            return true;
    }
}

std::string length_text(double m) {
    return m < 1e4 ? fmt::format("{:.0f} m", m) : fmt::format("{:.3g} km", m / 1e3);
}

std::string size_text(const Box& box, double margin) {
    return length_text(box.size().x() + 2 * margin) + " x " +
           length_text(box.size().y() + 2 * margin);
}

// The crop that keeps what is no stray; empty where it would keep a stray too.
std::string crop_text(const std::vector<Box>& boxes, const Strays& strays) {
    const Box crop{strays.rest.min.array().floor().matrix(),
                   strays.rest.max.array().ceil().matrix()};
    for (const std::size_t i : strays.boxes) {
        if (crop.contains((boxes[i].min + boxes[i].max) / 2)) return "";
    }
    return fmt::format(", or leave it out with site.crop_m = [{:.0f}, {:.0f}, {:.0f}, {:.0f}]",
                       crop.min.x(), crop.min.y(), crop.max.x(), crop.max.y());
}

}  // namespace

std::string stray_warning(const FeatureSet& set, const SiteOptions& options) {
    constexpr std::size_t named_most = 5;
    std::vector<Box> boxes;
    for (const Feature& f : set.features) {
        boxes.push_back(makes_walls(f.role, options) ? bounds(f) : Box{});
    }
    const double margin = options.kind == SiteKind::outdoor ? options.margin_m : 0;
    const Strays strays = find_strays(boxes, margin);
    // On a small site the ground between costs nothing.
    constexpr double far_m = 500;
    if (strays.boxes.empty() || strays.whole.size().maxCoeff() < far_m) return "";
    const bool one = strays.boxes.size() == 1;
    std::string text = one ? "" : fmt::format("{} features far off: ", strays.boxes.size());
    for (std::size_t k = 0; k < std::min(named_most, strays.boxes.size()); ++k) {
        const Feature& f = set.features[strays.boxes[k]];
        const Box& box = boxes[strays.boxes[k]];
        const Vec2d at = (box.min + box.max) / 2;
        text += fmt::format("{}feature {}{}{} at ({:.2f}, {:.2f})", k > 0 ? ", " : "", f.number,
                            f.id.empty() ? "" : ", id ", f.id, at.x(), at.y());
        if (const Vec2d beyond = box.size() - strays.rest.size(); beyond.maxCoeff() > 0) {
            text += fmt::format(" of {}", size_text(box, 0));
        }
    }
    if (strays.boxes.size() > named_most) text += ", ...";
    return text + fmt::format(
                      "{}: through {} the site takes {}, {:.3g} times the {} of the rest; "
                      "correct the file{}",
                      one ? " lies far off" : "", one ? "it" : "them",
                      size_text(strays.whole, margin), strays.times, size_text(strays.rest, margin),
                      crop_text(boxes, strays));
}

}  // namespace vfplan
