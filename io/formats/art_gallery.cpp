#include "io/formats/art_gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>

#include "io/features/role_tally.h"
#include "io/formats/text.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

class Numbers {
public:
    Numbers(const std::string& text, const std::filesystem::path& file)
        : text_(text), file_(file) {}

    bool at_end() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
            ++at_;
        }
        return at_ == text_.size();
    }
    std::size_t count(const char* of_what) {
        const std::string_view word = next(of_what);
        const auto n = number_in<std::size_t>(word);
        if (!n) {
            fail(fmt::format("the number of {} is expected, not '{}'", of_what, shortened(word)));
        }
        return *n;
    }
    double fraction() {
        const std::string_view word = next("coordinates");
        const auto slash = word.find('/');
        Scaled value = number(word.substr(0, slash));
        if (slash != std::string_view::npos) {
            const Scaled below = number(word.substr(slash + 1));
            value = {value.digits / below.digits, value.tens - below.tens};
        }
        const double out = value.digits * std::pow(10.0, value.tens);
        if (!std::isfinite(out)) fail(fmt::format("'{}' is no number", shortened(word)));
        return out;
    }
    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(fmt::format("{}:{}: {}; correct the file or fetch it again",
                                     file_.string(), place_in(text_, before_), problem));
    }

private:
    std::string_view next(const char* of_what) {
        const bool end = at_end();
        before_ = at_;
        if (end) fail(fmt::format("the file ends before all {} are there", of_what));
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) == 0) {
            ++at_;
        }
        return std::string_view(text_).substr(before_, at_ - before_);
    }
    // Numerators and denominators have hundreds of digits, more than fit into a double.
    struct Scaled {
        double digits = 0;
        int tens = 0;
    };
    Scaled number(std::string_view word) const {
        constexpr std::size_t enough = 40;
        const bool whole = std::all_of(word.begin(), word.end(), [](unsigned char c) {
            return std::isdigit(c) != 0 || c == '-';
        });
        const std::string_view kept = whole ? word.substr(0, enough) : word;
        const auto value = number_in<double>(kept);
        if (!value) fail(fmt::format("'{}' is no number", shortened(word)));
        return {*value, static_cast<int>(word.size() - kept.size())};
    }
    static std::string_view shortened(std::string_view word) { return word.substr(0, 40); }

    const std::string& text_;
    const std::filesystem::path& file_;
    std::size_t at_ = 0;
    std::size_t before_ = 0;
};

Ring ring_of(Numbers& in) {
    const std::size_t n = in.count("corners");
    if (n < 3) in.fail("a ring has three corners at least");
    Ring ring;  // not reserved: who knows whether they are there
    for (std::size_t i = 0; i < n; ++i) {
        const double x = in.fraction();
        ring.emplace_back(x, in.fraction());
    }
    return ring;
}

}  // namespace

bool looks_like_art_gallery(const std::string& head) {
    std::istringstream words(head);
    std::string count;
    std::string x;
    std::string y;
    if (!(words >> count >> x >> y)) return false;
    const auto made_of = [](const std::string& word, const char* signs) {
        return std::isdigit(static_cast<unsigned char>(word.back())) != 0 &&
               word.find_first_not_of(signs) == std::string::npos;
    };
    constexpr const char* of_numbers = "0123456789+-./eE";
    return made_of(count, "0123456789") && made_of(x, of_numbers) && made_of(y, of_numbers);
}

Drawing read_art_gallery(const std::string& text, const std::filesystem::path& file,
                         const ReadOptions& options) {
    Numbers in(text, file);
    Polygon gallery;
    gallery.outer = ring_of(in);
    if (!in.at_end()) {
        const std::size_t holes = in.count("holes");
        for (std::size_t i = 0; i < holes; ++i) gallery.holes.push_back(ring_of(in));
    }
    if (!in.at_end()) in.fail("there is more in the file than it says");
    Drawing out;
    RoleTally tally;
    out.set.how.format = "AGPLIB";
    out.set.how.plan = true;
    out.unit.guessed = true;
    if (Feature* f = tally.add(out.set, options, "gallery", Role::outline)) {
        f->polygons.push_back(std::move(gallery));
    }
    tally.add_to(out.set, "");
    return out;
}

}  // namespace vfplan
