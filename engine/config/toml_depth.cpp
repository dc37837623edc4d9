#include "engine/config/toml_depth.h"

#include <string>

namespace vfplan {
namespace {

class Scan {
public:
    explicit Scan(std::string_view text) : text_(text) {}

    std::optional<TextPlace> run() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"' || c == '\'') {
                string(c);
                continue;
            }
            if (c == '#') {
                while (at_ < text_.size() && text_[at_] != '\n') ++at_;
                continue;
            }
            if (too_deep_after(c)) return place();
            ++at_;
        }
        return {};
    }

private:
    bool too_deep_after(char c) {
        if (c == '\n') {
            // A table's header ends with its line, whatever it left open.
            if (open_.empty() || in_key_) begin_key();
            if (in_key_) open_.clear();
        } else if (c == '[' || c == '{') {
            open_ += c;
            if (c == '{') begin_key();
            return static_cast<int>(open_.size()) > toml_depth_most;
        } else if (c == ']' || c == '}') {
            if (!open_.empty()) open_.pop_back();
            if (open_.empty()) in_key_ = false;
        } else if (c == ',') {
            if (!open_.empty() && open_.back() == '{') begin_key();
        } else if (c == '=') {
            in_key_ = false;
        } else if (c == '.' && in_key_) {
            return ++dots_ > toml_depth_most;
        }
        return false;
    }

    void begin_key() {
        in_key_ = true;
        dots_ = 0;
    }

    // Behind a string: of one line, or of several between three signs.
    void string(char quote) {
        const std::string three(3, quote);
        const bool lines = text_.substr(at_, 3) == three;
        at_ += lines ? 3 : 1;
        while (at_ < text_.size()) {
            if (quote == '"' && text_[at_] == '\\') {
                at_ += 2;
            } else if (lines ? text_.substr(at_, 3) == three : text_[at_] == quote) {
                at_ += lines ? 3 : 1;
                return;
            } else if (!lines && text_[at_] == '\n') {
                return;  // the parser complains of it
            } else {
                ++at_;
            }
        }
    }

    TextPlace place() const {
        TextPlace out;
        for (std::size_t i = 0; i < at_; ++i) {
            out.column = text_[i] == '\n' ? 1 : out.column + 1;
            out.line += text_[i] == '\n' ? 1 : 0;
        }
        return out;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::string open_;    // brackets
    bool in_key_ = true;  // what stands here may be a key
    int dots_ = 0;        // in it
};

}  // namespace

std::optional<TextPlace> too_deep(std::string_view toml) { return Scan(toml).run(); }

}  // namespace vfplan
