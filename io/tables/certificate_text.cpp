#include "io/tables/certificate_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr std::string_view head = "vfplan certificate 1";

class Reader {
public:
    Reader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

    Certificate read() {
        Certificate out;
        next();
        if (line_ != head) fail(fmt::format("does not begin with \"{}\"", head));
        next();
        if (word() != "scale" || number<std::int64_t>() != proof_scale) {
            fail(fmt::format("weights are told in parts of {} only", proof_scale));
        }
        end();
        for (next(); line_ != "end"; next()) add(out);
        if (!rest_.empty()) fail("goes on behind its end");
        return out;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw IoError(
            fmt::format("{}:{}: {}; make it again with vfplan plan", name_, number_, what));
    }

    void next() {
        ++number_;
        const std::size_t at = rest_.find('\n');
        if (at == std::string_view::npos) fail("is cut short");
        line_ = words_ = rest_.substr(0, at);
        rest_.remove_prefix(at + 1);
    }

    std::string_view word() {
        const std::size_t at = std::min(words_.find(' '), words_.size());
        const std::string_view out = words_.substr(0, at);
        words_.remove_prefix(std::min(at + 1, words_.size()));
        return out;
    }

    template <class T>
    T number() {
        const std::string_view text = word();
        T value = 0;
        const auto [to, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (text.empty() || error != std::errc() || to != text.data() + text.size()) {
            fail(fmt::format("\"{}\" is no number here", text));
        }
        return value;
    }

    void expect(std::string_view wanted) {
        if (const std::string_view found = word(); found != wanted) {
            fail(fmt::format("\"{}\" stands where \"{}\" should", found, wanted));
        }
    }

    void end() const {
        if (!words_.empty()) fail(fmt::format("\"{}\" is too much", words_));
    }

    void add(Certificate& out) {
        const std::string_view what = word();
        if (what == "network") {
            if (number<std::size_t>() != out.networks.size()) fail("networks are out of order");
            out.networks.emplace_back();
            expect("bound");
            out.networks.back().bound = number<std::int64_t>();
            return end();
        }
        if (out.networks.empty()) fail("belongs to no network");
        NetworkProof& proof = out.networks.back();
        if (what == "root") {
            const std::string_view of = word();
            if (of != "piece" && of != "station") fail("a root is of a piece or a station");
            (of == "piece" ? proof.root_piece : proof.root_station) = number<std::int32_t>();
        } else if (what == "gone") {
            proof.gone.emplace_back();
            proof.gone.back().gone = number<std::int32_t>();
            expect("by");
            proof.gone.back().by = number<std::int32_t>();
        } else if (what == "line") {
            add_line(proof);
        } else if (what == "case") {
            proof.cases.emplace_back();
            if (words_ != "leaf") {
                expect("branch");
                proof.cases.back().branch = number<std::int32_t>();
            } else {
                words_ = {};
            }
        } else if (what == "weight") {
            if (proof.cases.empty()) fail("a weight belongs to no case");
            LineWeight weight;
            weight.line = number<std::int32_t>();
            weight.weight = number<std::int64_t>();
            proof.cases.back().weights.push_back(weight);
        } else {
            fail(fmt::format("\"{}\" means nothing", what));
        }
        end();
    }

    void add_line(NetworkProof& proof) {
        if (number<std::size_t>() != proof.lines.size()) fail("lines are out of order");
        const std::string_view name = word();
        const auto& names = Names<LineKind>::all;
        const auto kind = std::find(names.begin(), names.end(), name);
        if (kind == names.end()) fail(fmt::format("no line is called \"{}\"", name));
        ProofLine line;
        line.kind = static_cast<LineKind>(kind - names.begin());
        line.of = number<std::int32_t>();
        if (!words_.empty()) {
            expect("in");
            while (!words_.empty()) line.within.push_back(number<std::int32_t>());
        }
        proof.lines.push_back(std::move(line));
    }

    std::string_view rest_;
    const std::string& name_;
    std::string_view line_;
    std::string_view words_;  // what is left of it
    std::int64_t number_ = 0;
};

}  // namespace

std::string text_of(const Certificate& certificate) {
    std::string out = fmt::format("{}\nscale {}\n", head, proof_scale);
    const auto to = std::back_inserter(out);
    for (std::size_t n = 0; n < certificate.networks.size(); ++n) {
        const NetworkProof& proof = certificate.networks[n];
        fmt::format_to(to, "network {} bound {}\n", n, proof.bound);
        if (proof.root_piece >= 0) fmt::format_to(to, "root piece {}\n", proof.root_piece);
        if (proof.root_station >= 0) fmt::format_to(to, "root station {}\n", proof.root_station);
        for (const auto& [gone, by] : proof.gone) fmt::format_to(to, "gone {} by {}\n", gone, by);
        for (std::size_t i = 0; i < proof.lines.size(); ++i) {
            const ProofLine& line = proof.lines[i];
            fmt::format_to(to, "line {} {} {}", i, name_of(line.kind), line.of);
            if (!line.within.empty()) out += " in";
            for (const std::int32_t c : line.within) fmt::format_to(to, " {}", c);
            out += '\n';
        }
        for (const ProofCase& c : proof.cases) {
            if (c.branch >= 0) fmt::format_to(to, "case branch {}\n", c.branch);
            if (c.branch < 0) out += "case leaf\n";
            for (const LineWeight& w : c.weights) {
                fmt::format_to(to, "weight {} {}\n", w.line, w.weight);
            }
        }
    }
    out += "end\n";
    return out;
}

Certificate certificate_of(std::string_view text, const std::string& name) {
    return Reader(text, name).read();
}

}  // namespace vfplan
