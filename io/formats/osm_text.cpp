#include "io/formats/osm_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "io/formats/text.h"
#include "kernels/error.h"

namespace vfplan {
void check_osm(const PackedFile& packed, const std::filesystem::path& file) {
    constexpr std::size_t longest = 64;  // of an attribute with a coordinate
    std::string text;                    // what was not looked at yet
    std::ptrdiff_t line = 1;
    each_part(packed, file, [&](std::string_view part) {
        text += part;
        std::size_t at = 0;
        std::size_t counted = 0;
        while ((at = text.find(" l", at)) != std::string::npos && at + longest <= text.size()) {
            const std::string_view rest = std::string_view(text).substr(at, longest);
            at += 2;
            if (!rest.starts_with(" lat=") && !rest.starts_with(" lon=")) continue;
            const char quote = rest[5];
            if (quote != '"' && quote != '\'') continue;
            const std::string_view value = rest.substr(6, rest.find(quote, 6) - 6);
            if (number_in<double>(value)) continue;
            line += std::count(text.begin() + static_cast<std::ptrdiff_t>(counted),
                               text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
            throw InputError(
                fmt::format("{}:{}: {} = '{}' is no number; correct or remove the node",
                            file.string(), line, rest.substr(1, 3), value));
        }
        const std::size_t done = at == std::string::npos
                                     ? text.size() - std::min(text.size(), longest)
                                     : std::min(at, text.size());
        line += std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(done), '\n');
        text.erase(0, done);
    });
}

}  // namespace vfplan
