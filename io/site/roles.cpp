#include "io/site/roles.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace vfplan {
namespace {

struct WordRole {
    std::string_view part;
    Role role;
};

// Parts of layer names and class values. Among the parts found in a word the longest decides, so
// "room_bbox" is a drawing although it has "room" in it.
constexpr std::array<WordRole, 49> words = {{
    {"building", Role::building},  {"gallery", Role::outline},
    {"footprint", Role::building}, {"wall", Role::wall},
    {"wand", Role::wall},          {"mur", Role::wall},
    {"muro", Role::wall},          {"parete", Role::wall},
    {"pared", Role::wall},         {"column", Role::wall},
    {"pillar", Role::wall},        {"a-cols", Role::wall},
    {"partition", Role::wall},     {"fence", Role::wall},
    {"window", Role::window},      {"glaz", Role::window},
    {"fenster", Role::window},     {"fenetre", Role::window},
    {"ventana", Role::window},     {"finestra", Role::window},
    {"door", Role::door},          {"tuer", Role::door},
    {"porte", Role::door},         {"puerta", Role::door},
    {"porta", Role::door},         {"obstacle", Role::obstacle},
    {"furniture", Role::obstacle}, {"furn", Role::obstacle},
    {"tree", Role::obstacle},      {"room", Role::room},
    {"space", Role::room},         {"raum", Role::room},
    {"outline", Role::outline},    {"boundary", Role::outline},
    {"opening", Role::opening},    {"room_bbox", Role::drawing},
    {"swing", Role::opening},      {"text", Role::drawing},
    {"dim", Role::drawing},        {"hatch", Role::drawing},
    {"title", Role::drawing},      {"label", Role::drawing},
    {"annotation", Role::drawing}, {"furniture_text", Role::drawing},
    {"tür", Role::door},           {"fenêtre", Role::window},
    {"cloison", Role::wall},       {"säule", Role::wall},
    {"möbel", Role::obstacle},
}};

// Lower case of ASCII and of the Latin letters with accents, which UTF-8 writes as 0xC3 and a
// second byte.
std::string lower_case(const std::string& word) {
    std::string out = word;
    bool after_c3 = false;
    for (char& c : out) {
        const auto byte = static_cast<unsigned char>(c);
        if (after_c3 && byte >= 0x80 && byte <= 0x9E && byte != 0x97) {
            c = static_cast<char>(byte + 0x20);
        } else if (byte < 0x80) {
            c = static_cast<char>(std::tolower(byte));
        }
        after_c3 = byte == 0xC3;
    }
    return out;
}

}  // namespace

std::optional<Role> role_of_word(const std::string& word) {
    const std::string lower = lower_case(word);
    const WordRole* best = nullptr;
    for (const WordRole& w : words) {
        if (lower.find(w.part) == std::string::npos) continue;
        if (best == nullptr || w.part.size() > best->part.size()) best = &w;
    }
    if (best == nullptr) return std::nullopt;
    return best->role;
}

Role default_role(SiteKind kind, bool polygon) {
    if (kind == SiteKind::outdoor) return polygon ? Role::building : Role::wall;
    return polygon ? Role::outline : Role::wall;
}

}  // namespace vfplan
