#include "kernels/printable.h"

#include <cstddef>

namespace vfplan {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

// Bytes of the character that begins at `at`; 0 where none does.
std::size_t character(std::string_view text, std::size_t at) {
    const unsigned first = byte_at(text, at);
    if (first < 0x80) return 1;
    const std::size_t n = first >= 0xc2 && first <= 0xdf   ? 2
                          : first >= 0xe0 && first <= 0xef ? 3
                          : first >= 0xf0 && first <= 0xf4 ? 4
                                                           : 0;
    if (n == 0 || at + n > text.size()) return 0;
    for (std::size_t i = 1; i < n; ++i) {
        if ((byte_at(text, at + i) & 0xc0U) != 0x80) return 0;
    }
    const unsigned second = byte_at(text, at + 1);
    const bool wrong = (first == 0xe0 && second < 0xa0) ||   // too long
                       (first == 0xed && second >= 0xa0) ||  // surrogates
                       (first == 0xf0 && second < 0x90) ||   // too long
                       (first == 0xf4 && second >= 0x90);    // beyond U+10FFFF
    return wrong ? 0 : n;
}

bool controls(std::string_view c) {
    const unsigned first = byte_at(c, 0);
    if (c.size() == 1) return (first < 0x20 && first != '\n') || first == 0x7f;
    return first == 0xc2 && byte_at(c, 1) < 0xa0;  // U+0080 to U+009F
}

}  // namespace

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t n = character(text, i);
        if (n == 0) return false;
        i += n;
    }
    return true;
}

std::string printable(std::string_view text) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t n = character(text, i);
        const std::string_view bytes = text.substr(i, n == 0 ? 1 : n);
        if (n > 0 && !controls(bytes)) {
            out += bytes;
        } else {
            for (std::size_t k = 0; k < bytes.size(); ++k) {
                out += "\\x";
                out += digits[byte_at(bytes, k) / 16];
                out += digits[byte_at(bytes, k) % 16];
            }
        }
        i += bytes.size();
    }
    return out;
}

}  // namespace vfplan
