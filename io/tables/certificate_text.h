// A certificate as text, for programs that check it (docs/file_format.md).
#pragma once

#include <string>
#include <string_view>

#include "kernels/certificate.h"

namespace vfplan {

std::string text_of(const Certificate& certificate);

// Throws IoError with the number of a line that is not as it should be; whether what is said is
// true is another question. `name`: of the file, for messages.
Certificate certificate_of(std::string_view text, const std::string& name);

}  // namespace vfplan
