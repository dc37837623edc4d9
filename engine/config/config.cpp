#include "engine/config/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/config/parameters.h"
#include "engine/config/toml_depth.h"
#include "engine/config/toml_values.h"
#include "io/files.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr std::size_t most_bytes = std::size_t{16} << 20U;  // no job is a thousandth of it

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            const std::size_t up = row[k];
            row[k] =
                std::min({row[k] + 1, row[k - 1] + 1, diagonal + (a[i - 1] == b[k - 1] ? 0U : 1U)});
            diagonal = up;
        }
    }
    return row.back();
}

// `known`: what could have been meant.
[[noreturn]] void unknown_key(const std::set<std::string>& known, const std::string& key,
                              const Place& place) {
    constexpr std::size_t longest = 100;
    if (key.size() > longest) {
        throw UsageError(fmt::format("{}... ({}): no such parameter; docs/parameters.md lists all",
                                     key.substr(0, longest), place.text()));
    }
    const auto nearest = std::min_element(known.begin(), known.end(),
                                          [&](const std::string& a, const std::string& b) {
                                              return edit_distance(key, a) < edit_distance(key, b);
                                          });
    const bool near = edit_distance(key, *nearest) <= 1 + key.size() / 3;
    throw UsageError(fmt::format(
        "{} ({}): no such parameter; {}", key, place.text(),
        near ? fmt::format("did you mean {}?", *nearest) : "docs/parameters.md lists all"));
}

void apply(const std::vector<Parameter>& all, const std::string& key, const toml::node& value,
           const Place& place) {
    for (const Parameter& e : all) {
        if (e.key() != key) continue;
        set_value(e, value, place);
        return;
    }
    std::set<std::string> known;
    for (const Parameter& e : all) {
        known.insert(value.is_table() && !e.section.empty() ? e.section : e.key());
    }
    unknown_key(known, key, place);
}

void apply_table(const std::vector<Parameter>& all, const toml::table& table,
                 const std::string& prefix, const std::string& name) {
    for (const auto& [key, node] : table) {
        const std::string full =
            prefix.empty() ? std::string(key.str()) : prefix + "." + std::string(key.str());
        const Place place = place_of(key.source(), name);
        const bool section = std::any_of(all.begin(), all.end(),
                                         [&](const Parameter& e) { return e.section == full; });
        if (prefix.empty() && section) {
            if (!node.is_table()) {
                throw UsageError(
                    fmt::format("{} ({}): this is a section; write [{}] on a line of "
                                "its own and its keys below",
                                full, place.text(), full));
            }
            apply_table(all, *node.as_table(), full, name);
        } else {
            apply(all, full, node, place);
        }
    }
}

// "section.key=value", the value as TOML, or as plain text where that is no TOML.
struct Override {
    std::string key;
    toml::table holder;  // keeps the value alive under "v"
};

Override parse_override(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw UsageError(
            fmt::format("--set {}: must be section.key=value, for example --set "
                        "field.cell_m=2",
                        text));
    }
    Override out;
    out.key = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    if (too_deep("v = " + value)) {
        throw UsageError(
            fmt::format("--set {}: the value nests more than {} deep, and no parameter "
                        "has such values; docs/parameters.md has what it may be",
                        out.key, toml_depth_most));
    }
    try {
        out.holder = toml::parse("v = " + value);
    } catch (const toml::parse_error&) {
        out.holder = toml::table{{"v", value}};
    }
    return out;
}

toml::table parse_toml(const std::string& text, const std::string& name) {
    if (text.size() > most_bytes) {
        throw UsageError(fmt::format(
            "{}: larger than 16 MB, so it is no job file; configs/ has some to copy", name));
    }
    if (const auto at = too_deep(text)) {
        throw UsageError(
            fmt::format("{}: brackets or the parts of a key nest more than {} deep, and no "
                        "parameter does; correct the TOML there",
                        Place{name, at->line, at->column}.text(), toml_depth_most));
    }
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& e) {
        throw UsageError(fmt::format("{}: {}; correct the TOML there",
                                     place_of(e.source(), name).text(), e.description()));
    }
}

// The paths that are not absolute yet.
void make_absolute(const std::vector<Parameter>& all, const std::filesystem::path& folder) {
    for (const Parameter& p : all) {
        const auto* path = std::get_if<std::filesystem::path*>(&p.value);
        if (path == nullptr || (*path)->empty()) continue;
        **path = std::filesystem::absolute(folder / **path).lexically_normal();
    }
}

void check_together(const Config& c, const std::string& name) {
    const auto fail = [&](const std::string& what) {
        throw UsageError(fmt::format("{}: {}", name, what));
    };
    if (c.site.input.empty()) {
        fail("site.input is missing; name the site's file under [site], input = \"town.geojson\"");
    }
    if (c.scanner.range_min_m >= c.scanner.range_max_m) {
        fail(
            fmt::format("scanner.range_min_m = {} is not below range_max_m = {}; nothing could "
                        "be observed",
                        c.scanner.range_min_m, c.scanner.range_max_m));
    }
    if (!c.site.crop_m.empty() &&
        (c.site.crop_m.size() != 4 || c.site.crop_m[0] >= c.site.crop_m[2] ||
         c.site.crop_m[1] >= c.site.crop_m[3])) {
        fail("site.crop_m must be x0, y0, x1, y1 with x0 < x1 and y0 < y1");
    }
    const std::int64_t rays = c.visibility.rays;
    if (rays != 0 && (rays < 16 || (rays & (rays - 1)) != 0)) {
        fail(fmt::format("visibility.rays = {} must be 0 or a power of two from 16 on", rays));
    }
    if (c.field.tile_cells % 4 != 0) {
        fail(
            fmt::format("field.tile_cells = {} must be a multiple of 4, as cells are looked at in "
                        "blocks of 4 x 4; {} is one",
                        c.field.tile_cells, c.field.tile_cells / 4 * 4));
    }
}

}  // namespace

Config config_of(Preset preset) {
    Config config;
    config.preset = preset;
    if (preset == Preset::outdoor) return config;
#define SECTION(section)
#define END(section)
#define TEXT(section, name, outdoors, indoors, stale, help) config.section.name = indoors;
#define PATH(section, name, stale, help)
#define NUMBER(section, name, outdoors, indoors, stale, help, limits) config.section.name = indoors;
#define WHOLE(section, name, outdoors, indoors, stale, help, limits) config.section.name = indoors;
#define FLAG(section, name, outdoors, indoors, stale, help) config.section.name = indoors;
#define CHOICE(type, section, name, outdoors, indoors, stale, help) \
    config.section.name = type::indoors;
#define NUMBERS(section, name, stale, help)
#define POINTS(section, name, stale, help)
#define ROLES(section, name, stale, help)
#define FORMATS(section, name, stale, help)
#include "engine/config/parameters.def"
#include "engine/config/undefine.def"
    return config;
}

Config parse_config(const std::string& text, const std::string& name,
                    const std::filesystem::path& folder,
                    const std::vector<std::string>& overrides) {
    const toml::table file = parse_toml(text, name);
    std::vector<Override> sets;
    for (const std::string& s : overrides) sets.push_back(parse_override(s));
    Config config;
    const auto all = parameters(config);
    // The preset first: it sets the defaults that the other keys replace.
    if (const toml::node* preset = file.get("preset")) {
        apply(all, "preset", *preset, place_of(preset->source(), name));
    }
    for (const Override& o : sets) {
        if (o.key == "preset") apply(all, o.key, *o.holder.get("v"), {"--set"});
    }
    config = config_of(config.preset);
    const Preset chosen_preset = config.preset;
    apply_table(all, file, "", name);
    config.preset = chosen_preset;
    make_absolute(all, folder);
    for (const Override& o : sets) apply(all, o.key, *o.holder.get("v"), {"--set"});
    make_absolute(all, ".");
    check_together(config, name);
    return config;
}

Config read_config(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        throw UsageError(
            fmt::format("{}: no such job file; configs/ has some to copy", file.string()));
    }
    if (std::filesystem::is_directory(file, ignored)) {
        throw UsageError(fmt::format("{}: is a folder, not a job file", file.string()));
    }
    const bool plain = std::filesystem::is_regular_file(file, ignored);
    if ((plain && std::filesystem::file_size(file, ignored) > most_bytes) ||
        std::filesystem::is_character_file(file, ignored)) {  // /dev/zero has no end
        throw UsageError(fmt::format("{}: {}, so it is no job file; configs/ has some to copy",
                                     file.string(), plain ? "larger than 16 MB" : "a device"));
    }
    return parse_config(read_text(file), file.string(), file.parent_path(), overrides);
}

std::string to_toml(const Config& config) {
    Config copy = config;
    std::string out;
    std::string section;
    for (const Parameter& p : parameters(copy)) {
        if (p.section != section) {
            section = p.section;
            out += fmt::format("\n[{}]\n", section);
        }
        out +=
            fmt::format("{:<32}  # {}\n", fmt::format("{} = {}", p.name, text_of(p.value)), p.help);
    }
    return out;
}

}  // namespace vfplan
