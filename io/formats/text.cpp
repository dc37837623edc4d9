#include "io/formats/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace vfplan {

std::string place_in(const std::string& text, std::size_t byte) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
    const auto line = std::count(text.begin(), end, '\n') + 1;
    const auto newline = std::find(std::make_reverse_iterator(end), text.rend(), '\n');
    return fmt::format("{}:{}", line, newline - std::make_reverse_iterator(end) + 1);
}

}  // namespace vfplan
