// Words of a shell's command line.
#pragma once

#include <string>

namespace vfplan {

// What bash reads back as `text`.
std::string shell_word(const std::string& text);

}  // namespace vfplan
