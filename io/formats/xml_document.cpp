#include "io/formats/xml_document.h"

#include <fmt/format.h>

#include <cctype>
#include <cstring>
#include <string_view>

#include "io/formats/text.h"
#include "kernels/error.h"

namespace vfplan {

std::string root_element(const std::string& head) {
    for (std::size_t at = head.find('<'); at != std::string::npos; at = head.find('<', at + 1)) {
        if (at + 1 == head.size()) return "";
        const char next = head[at + 1];
        if (next == '?' || next == '!') continue;
        std::size_t end = at + 1;
        while (end < head.size() && (std::isalnum(static_cast<unsigned char>(head[end])) != 0 ||
                                     std::strchr("_-.:", head[end]) != nullptr)) {
            ++end;
        }
        return head.substr(at + 1, end - at - 1);
    }
    return "";
}

XmlDocument::XmlDocument(std::string text, const std::filesystem::path& file)
    : text_(std::move(text)), file_(file) {
    const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size());
    if (!result) {
        throw InputError(fmt::format(
            "{}:{}: {}; the file is damaged, export the site again", file_.string(),
            place_in(text_, static_cast<std::size_t>(result.offset)), result.description()));
    }
}

double XmlDocument::parsed(const pugi::xml_node& node, const char* name, const char* value) const {
    std::string_view text = value;
    const auto space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (!text.empty() && space(text.front())) text.remove_prefix(1);
    while (!text.empty() && space(text.back())) text.remove_suffix(1);
    const auto out = number_in<double>(text);
    if (!out) fail(node, fmt::format("{} = '{:.40}' is no number", name, text));
    return *out;
}

double XmlDocument::number(const pugi::xml_node& node, const char* attribute) const {
    const pugi::xml_attribute a = node.attribute(attribute);
    if (!a) fail(node, fmt::format("it has no {}", attribute));
    return parsed(node, attribute, a.value());
}

double XmlDocument::number(const pugi::xml_node& node, const char* attribute,
                           double otherwise) const {
    return node.attribute(attribute) ? number(node, attribute) : otherwise;
}

double XmlDocument::child_number(const pugi::xml_node& node, const char* child) const {
    const pugi::xml_node c = node.child(child);
    if (!c) fail(node, fmt::format("it has no <{}>", child));
    return parsed(c, child, c.text().get());
}

void XmlDocument::fail(const pugi::xml_node& node, const std::string& problem) const {
    const auto at = node.offset_debug();
    throw InputError(fmt::format(
        "{}:{}: <{}>: {}; correct the file, or export the site again", file_.string(),
        at < 0 ? "?" : place_in(text_, static_cast<std::size_t>(at)), node.name(), problem));
}

}  // namespace vfplan
