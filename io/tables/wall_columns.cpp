#include "io/tables/wall_columns.h"

#include "io/columns.h"
#include "io/tables/sound.h"

namespace vfplan {

WallColumns::WallColumns(h5::Writer& file, const std::string& group, std::uint64_t count,
                         std::uint64_t chunk)
    : file_(file), group_(group + "/") {
    for (const char* name : {"x0", "y0", "x1", "y1"}) {
        file.begin<double>(group_ + name, count, chunk);
    }
    for (const char* name : {"class", "scanned", "free_left", "free_right"}) {
        file.begin<std::uint8_t>(group_ + name, count, chunk);
    }
}

void WallColumns::append(const std::vector<Wall>& w) {
    const auto metres = [&](const char* name, auto&& value) {
        file_.append(group_ + name, column<double>(w, value));
    };
    const auto code = [&](const char* name, auto&& value) {
        file_.append(group_ + name, column<std::uint8_t>(w, value));
    };
    metres("x0", [](const Wall& k) { return k.a.x(); });
    metres("y0", [](const Wall& k) { return k.a.y(); });
    metres("x1", [](const Wall& k) { return k.b.x(); });
    metres("y1", [](const Wall& k) { return k.b.y(); });
    code("class", [](const Wall& k) { return k.cls; });
    code("scanned", [](const Wall& k) { return k.scanned; });
    code("free_left", [](const Wall& k) { return k.free_side[left]; });
    code("free_right", [](const Wall& k) { return k.free_side[right]; });
}

void write_walls(h5::Writer& file, const std::string& group, const std::vector<Wall>& walls) {
    WallColumns columns(file, group, walls.size(), h5::Writer::default_chunk);
    columns.append(walls);
    for (const char* name : {"scanned", "free_left", "free_right"}) {
        file.attribute(group + "/" + name, "meaning", "0 no, 1 yes");
    }
    write_code_names(file, group + "/class", names_of<WallClass>());
}

std::vector<Wall> read_walls(const h5::Reader& file, const std::string& group, std::uint64_t from,
                             std::uint64_t count) {
    const auto metres = [&](const char* name) {
        return file.read<double>(group + "/" + name, from, count);
    };
    const auto code = [&](const char* name) {
        return file.read<std::uint8_t>(group + "/" + name, from, count);
    };
    const auto x0 = metres("x0");
    const auto y0 = metres("y0");
    const auto x1 = metres("x1");
    const auto y1 = metres("y1");
    const auto cls = code("class");
    const auto scanned = code("scanned");
    const auto on_left = code("free_left");
    const auto on_right = code("free_right");
    for (const auto* ends : {&x0, &y0, &x1, &y1}) sound::finite(file, group, *ends);
    sound::codes<WallClass>(file, group + "/class", cls);
    std::vector<Wall> walls;
    walls.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        walls.push_back({{x0[i], y0[i]},
                         {x1[i], y1[i]},
                         static_cast<WallClass>(cls[i]),
                         scanned[i] != 0,
                         {on_left[i] != 0, on_right[i] != 0}});
    }
    return walls;
}

std::vector<Wall> read_walls(const h5::Reader& file, const std::string& group) {
    return read_walls(file, group, 0, file.dims(group + "/x0").at(0));
}

}  // namespace vfplan
