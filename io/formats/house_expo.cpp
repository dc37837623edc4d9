#include "io/formats/house_expo.h"

#include "io/features/role_tally.h"

namespace vfplan {

Drawing read_house_expo(const JsonAt& root, const ReadOptions& options) {
    Drawing out;
    RoleTally tally;
    out.set.how.format = "HouseExpo";
    out.set.how.plan = true;
    out.unit = {1, "metres (HouseExpo)"};
    const JsonAt verts = root["verts"];
    Polygon outline;
    for (std::size_t i = 0; i < verts.size(); ++i) {
        const JsonAt v = verts.at(i);
        outline.outer.emplace_back(v.at(0).number(), v.at(1).number());
    }
    if (outline.outer.size() > 1 && outline.outer.front() == outline.outer.back()) {
        outline.outer.pop_back();
    }
    if (outline.outer.size() < 3) verts.fail("an outline has three corners at least");
    const std::string id = root.has("id") ? root["id"].text() : "";
    if (Feature* f = tally.add(out.set, options, "verts", Role::outline, id)) {
        f->polygons.push_back(std::move(outline));
    }
    if (root.has("room_category")) {
        for (const auto& [name, boxes] : root["room_category"].value().items()) {
            for (std::size_t i = 0; i < boxes.size(); ++i) tally.count(name, {}, "format");
        }
    }
    tally.add_to(out.set, "");
    return out;
}

}  // namespace vfplan
