#include "io/exports/outputs.h"

#include <algorithm>

#include "io/exports/plan_map.h"
#include "io/exports/text_tables.h"
#include "io/exports/vector_writer.h"

namespace vfplan {

const std::vector<Output>& outputs() {
    static const std::vector<Output> all = [] {
        const std::span<const Output> texts = text_outputs();
        std::vector<Output> out(texts.begin(), texts.end());
        // The package is filled by one thread, the picture drawn by one.
        out.push_back({"gpkg", "plan.gpkg", write_gpkg, {1.5e5, 190, 120}, {0.05, 1e-5}, {}});
        out.push_back(
            {"png", "map.png", write_map, {0, 0, 0, 0.8}, {0, 1e-6, 0, 2e-7}, {0, 0, 0, 12}});
        return out;
    }();
    return all;
}

bool is_asked(const std::vector<std::string>& formats, std::string_view format) {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
}

std::vector<std::string> output_formats() {
    std::vector<std::string> out;
    for (const Output& o : outputs()) {
        if (!is_asked(out, o.format)) out.emplace_back(o.format);
    }
    return out;
}

}  // namespace vfplan
