#include "engine/compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/config/parameters.h"
#include "engine/folder/run_dir.h"
#include "io/exports/bars_png.h"
#include "io/files.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;

// summary.json of a folder with a plan.
nlohmann::ordered_json summary_in(const fs::path& dir) {
    const fs::path file = dir / "summary.json";
    const bool there = fs::exists(file);
    const auto json = there ? nlohmann::ordered_json::parse(read_text(file), nullptr, false)
                            : nlohmann::ordered_json::object();
    if (json.is_discarded() || !json.is_object()) {
        throw IoError(fmt::format("{}: is no JSON; make it again with vfplan plan {}",
                                  file.string(), dir.string()));
    }
    if (!json.contains("stations")) {
        throw UsageError(fmt::format(
            "{}: holds no plan to compare; make one with vfplan plan {}, or name a folder that "
            "vfplan run has finished",
            dir.string(), dir.string()));
    }
    return json;
}

std::string shown(const Parameter& p) {
    if (const auto* path = std::get_if<fs::path*>(&p.value)) return (*path)->filename().string();
    std::string text = text_of(p.value);
    const bool quoted = text.size() > 1 && text.front() == text.back() &&
                        (text.front() == '"' || text.front() == '\'');
    return quoted ? text.substr(1, text.size() - 2) : text;
}

// What paths have in common at their ends and beginnings is left away.
std::vector<std::string> names_of(const std::vector<fs::path>& dirs) {
    std::vector<fs::path> whole;
    for (const fs::path& d : dirs) {
        fs::path p = fs::absolute(d).lexically_normal();
        whole.push_back(p.has_filename() ? p : p.parent_path());
    }
    std::set<std::string> last;
    for (const fs::path& p : whole) last.insert(p.filename().string());
    std::vector<std::string> names;
    for (std::size_t i = 0; i < dirs.size(); ++i) {
        names.push_back(last.size() == dirs.size() ? whole[i].filename().string()
                                                   : dirs[i].string());
    }
    return names;
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    return out + '"';
}

// How many columns a terminal shows, where each character is one.
std::size_t width_of(const std::string& text) {
    return idx(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0U) != 0x80;
    }));
}

}  // namespace

Comparison compare(const std::vector<fs::path>& dirs) {
    Comparison out;
    out.names = names_of(dirs);
    std::vector<Config> jobs;
    for (const fs::path& dir : dirs) {
        const auto summary = summary_in(dir);
        // A plan that was made anew may have been made with more than its folder's job says.
        const auto plan = summary.value("plan", nlohmann::ordered_json::object());
        jobs.push_back(RunDir(dir).config(plan.value("set", std::vector<std::string>())));
        out.plans.push_back(figures_of(summary));
    }
    std::vector<std::vector<Parameter>> lists;
    for (Config& job : jobs) lists.push_back(parameters(job));
    for (std::size_t k = 0; k < lists.front().size(); ++k) {
        const Parameter& first = lists.front()[k];
        if (first.section == "output") continue;
        const bool differ = std::any_of(lists.begin(), lists.end(), [&](const auto& list) {
            return text_of(list[k].value) != text_of(first.value);
        });
        if (!differ) continue;
        std::vector<std::string> values;
        for (const auto& list : lists) values.push_back(shown(list[k]));
        out.differences.emplace_back(first.key(), std::move(values));
    }
    return out;
}

std::string text_of(const Comparison& c, bool parameters) {
    std::vector<std::vector<std::string>> columns = {{"plan"}};
    columns[0].insert(columns[0].end(), c.names.begin(), c.names.end());
    if (parameters) {
        for (const auto& [key, values] : c.differences) {
            columns.push_back({key});
            columns.back().insert(columns.back().end(), values.begin(), values.end());
        }
    }
    for (const FigureColumn& figure : figure_columns()) {
        if (*figure.title == '\0') continue;
        columns.push_back({figure.title});
        for (const PlanFigures& plan : c.plans) columns.back().push_back(text_of(figure, plan));
    }
    std::vector<std::size_t> widths;
    for (const auto& column : columns) {
        std::size_t most = 0;
        for (const std::string& text : column) most = std::max(most, width_of(text));
        widths.push_back(most);
    }
    std::string out;
    for (std::size_t row = 0; row <= c.plans.size(); ++row) {
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const std::string& text = columns[k][row];
            const std::string space(widths[k] - width_of(text), ' ');
            out += k == 0 ? text + space : fmt::format("  {}{}", space, text);
        }
        out += '\n';
    }
    return out;
}

std::string csv_of(const Comparison& c) {
    std::string out = "plan";
    for (const auto& [key, values] : c.differences) out += fmt::format(",{}", csv_field(key));
    for (const FigureColumn& figure : figure_columns()) out += fmt::format(",{}", figure.name);
    out += "\r\n";
    for (std::size_t i = 0; i < c.plans.size(); ++i) {
        out += csv_field(c.names[i]);
        for (const auto& [key, values] : c.differences)
            out += fmt::format(",{}", csv_field(values[i]));
        for (const FigureColumn& figure : figure_columns()) {
            const double v = c.plans[i].*figure.value;
            out += std::isnan(v) ? std::string(",") : fmt::format(",{}", v);
        }
        out += "\r\n";
    }
    return out;
}

std::string picture_of(const Comparison& c) {
    std::vector<Bars> columns;
    for (const FigureColumn& figure : figure_columns()) {
        // These stand beside the stations, as a line and as their difference.
        const bool beside =
            figure.value == &PlanFigures::bound || figure.value == &PlanFigures::gap;
        if (*figure.title == '\0' || beside) continue;
        Bars b{figure.title, {}, {}, {}};
        const bool stations = figure.value == &PlanFigures::stations;
        if (stations) b.title += " (line: at least)";
        for (const PlanFigures& plan : c.plans) {
            b.value.push_back(plan.*figure.value);
            if (stations) b.mark.push_back(plan.bound);
            b.text.push_back(text_of(figure, plan));
        }
        // What is the same everywhere is in the table.
        const bool differ = std::any_of(b.text.begin(), b.text.end(),
                                        [&](const std::string& t) { return t != b.text.front(); });
        if (differ || stations) columns.push_back(std::move(b));
    }
    return bars_png("Plans side by side", c.names, columns);
}

}  // namespace vfplan
