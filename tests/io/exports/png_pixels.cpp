#include "tests/io/exports/png_pixels.h"

#include <cstdlib>
#include <stdexcept>

namespace vfplan::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

void demand(bool good, const char* what) {
    if (!good) throw std::runtime_error(std::string("not a PNG that map_png writes: ") + what);
}

// Canonical Huffman code, decoded bit by bit.
struct Huffman {
    std::array<int, 16> count{};
    std::vector<int> symbols;

    explicit Huffman(const std::vector<int>& lengths) {
        for (const int l : lengths) ++count[static_cast<std::size_t>(l)];
        count[0] = 0;
        for (int l = 1; l < 16; ++l) {
            for (std::size_t s = 0; s < lengths.size(); ++s) {
                if (lengths[s] == l) symbols.push_back(static_cast<int>(s));
            }
        }
    }
};

// Inflate (RFC 1951).
class Inflater {
public:
    explicit Inflater(const Bytes& in) : in_(in) {}

    Bytes run() {
        bool last = false;
        while (!last) {
            last = bits(1) == 1;
            const int type = bits(2);
            if (type == 0) {
                stored();
            } else if (type == 1) {
                std::vector<int> lengths(288, 8);
                for (std::size_t i = 144; i < 256; ++i) lengths[i] = 9;
                for (std::size_t i = 256; i < 280; ++i) lengths[i] = 7;
                block(Huffman(lengths), Huffman(std::vector<int>(30, 5)));
            } else {
                demand(type == 2, "block type");
                dynamic();
            }
        }
        return out_;
    }

private:
    int bits(int n) {
        int value = 0;
        for (int i = 0; i < n; ++i, ++at_) {
            demand(at_ / 8 < in_.size(), "truncated data");
            value |= ((in_[at_ / 8] >> (at_ % 8)) & 1) << i;
        }
        return value;
    }

    int symbol(const Huffman& h) {
        int code = 0;
        int first = 0;
        int index = 0;
        for (std::size_t l = 1; l < 16; ++l) {
            code |= bits(1);
            if (code - h.count[l] < first) {
                return h.symbols[static_cast<std::size_t>(index + code - first)];
            }
            index += h.count[l];
            first = (first + h.count[l]) << 1;
            code <<= 1;
        }
        demand(false, "Huffman code");
        return 0;
    }

    void stored() {
        at_ = (at_ + 7) / 8 * 8;
        const int n = bits(16);
        bits(16);
        for (int i = 0; i < n; ++i) out_.push_back(static_cast<std::uint8_t>(bits(8)));
    }

    void dynamic() {
        constexpr std::array<std::size_t, 19> order{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                    11, 4,  12, 3, 13, 2, 14, 1, 15};
        const auto literals = 257 + static_cast<std::size_t>(bits(5));
        const auto distances = 1 + static_cast<std::size_t>(bits(5));
        const auto codes = 4 + static_cast<std::size_t>(bits(4));
        std::vector<int> lengths(19, 0);
        for (std::size_t i = 0; i < codes; ++i) lengths[order[i]] = bits(3);
        const Huffman code_lengths(lengths);
        lengths.clear();
        while (lengths.size() < literals + distances) {
            const int s = symbol(code_lengths);
            if (s < 16) {
                lengths.push_back(s);
                continue;
            }
            const int value = s == 16 ? lengths.back() : 0;
            const int times = s == 16 ? 3 + bits(2) : s == 17 ? 3 + bits(3) : 11 + bits(7);
            lengths.insert(lengths.end(), static_cast<std::size_t>(times), value);
        }
        const auto split = lengths.begin() + static_cast<std::ptrdiff_t>(literals);
        block(Huffman({lengths.begin(), split}), Huffman({split, lengths.end()}));
    }

    void block(const Huffman& literals, const Huffman& distances) {
        for (int s = symbol(literals); s != 256; s = symbol(literals)) {
            if (s < 256) {
                out_.push_back(static_cast<std::uint8_t>(s));
                continue;
            }
            s -= 257;
            const int extra = s < 8 || s == 28 ? 0 : s / 4 - 1;
            const int length =
                s == 28 ? 258 : (s < 8 ? s : ((4 + s % 4) << extra)) + 3 + bits(extra);
            const int d = symbol(distances);
            const int d_extra = d < 4 ? 0 : d / 2 - 1;
            const int distance = (d < 4 ? d : ((2 + d % 2) << d_extra)) + 1 + bits(d_extra);
            demand(distance <= static_cast<int>(out_.size()), "distance");
            for (int i = 0; i < length; ++i) {
                out_.push_back(out_[out_.size() - static_cast<std::size_t>(distance)]);
            }
        }
    }

    const Bytes& in_;
    std::size_t at_ = 16;  // after the two bytes of the zlib header
    Bytes out_;
};

// Undoes the PNG line filters in place.
void unfilter(Bytes& raw, int width, int height) {
    const auto line = static_cast<std::size_t>(width) * 3;
    const auto value = [&](std::size_t y, std::size_t x) {
        return static_cast<int>(raw[y * (line + 1) + 1 + x]);
    };
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        const int filter = raw[y * (line + 1)];
        for (std::size_t x = 0; x < line; ++x) {
            const int a = x >= 3 ? value(y, x - 3) : 0;
            const int b = y > 0 ? value(y - 1, x) : 0;
            const int c = x >= 3 && y > 0 ? value(y - 1, x - 3) : 0;
            const int pa = std::abs(b - c);
            const int pb = std::abs(a - c);
            const int pc = std::abs(a + b - 2 * c);
            const int paeth = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
            const std::array<int, 5> predicted{0, a, b, (a + b) / 2, paeth};
            demand(filter < 5, "line filter");
            raw[y * (line + 1) + 1 + x] = static_cast<std::uint8_t>(
                value(y, x) + predicted[static_cast<std::size_t>(filter)]);
        }
    }
}

}  // namespace

std::array<int, 3> PngPixels::at(int x, int y) const {
    const std::size_t i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(x)) *
                          3;
    return {rgb.at(i), rgb.at(i + 1), rgb.at(i + 2)};
}

PngPixels read_png(const std::string& bytes) {
    demand(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n", "signature");
    const auto number = [&](std::size_t at) {
        std::uint32_t v = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            v = v << 8 | static_cast<std::uint8_t>(bytes.at(at + i));
        }
        return v;
    };
    PngPixels out;
    Bytes data;
    for (std::size_t at = 8; at + 8 <= bytes.size();) {
        const std::size_t length = number(at);
        const std::string type = bytes.substr(at + 4, 4);
        if (type == "IHDR") {
            out.width = static_cast<int>(number(at + 8));
            out.height = static_cast<int>(number(at + 12));
            demand(bytes.substr(at + 16, 5) == std::string("\x08\x02\x00\x00\x00", 5),
                   "pixel type");
        }
        if (type == "IDAT")
            data.insert(data.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at + 8),
                        bytes.begin() + static_cast<std::ptrdiff_t>(at + 8 + length));
        at += length + 12;
    }
    Bytes raw = Inflater(data).run();
    const auto line = static_cast<std::size_t>(out.width) * 3 + 1;
    demand(raw.size() == line * static_cast<std::size_t>(out.height), "size");
    unfilter(raw, out.width, out.height);
    for (std::size_t y = 0; y < static_cast<std::size_t>(out.height); ++y) {
        const auto from = raw.begin() + static_cast<std::ptrdiff_t>(y * line + 1);
        out.rgb.insert(out.rgb.end(), from, from + static_cast<std::ptrdiff_t>(line - 1));
    }
    return out;
}

}  // namespace vfplan::testing
