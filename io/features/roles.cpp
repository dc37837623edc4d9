#include "io/features/roles.h"

#include <algorithm>
#include <cctype>

namespace vfplan {
namespace {

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

// The words of a text, in lower case: its runs of letters, and those cut where a capital follows a
// small letter.
std::vector<std::string> words_in(const std::string& text) {
    std::vector<std::string> runs(1);
    std::vector<std::string> cut(1);
    bool small = false;  // the letter before
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80 && std::isalpha(byte) == 0) {
            runs.emplace_back();
            cut.emplace_back();
            small = false;
            continue;
        }
        if (byte < 0x80) {
            const bool capital = std::isupper(byte) != 0;
            if (capital && small) cut.emplace_back();
            small = !capital;
        }
        runs.back() += c;
        cut.back() += c;
    }
    runs.insert(runs.end(), cut.begin(), cut.end());
    for (std::string& word : runs) word = lower_case(word);
    return runs;
}

bool matches(const char* pattern, const char* text) {
    if (*pattern == '\0') return *text == '\0';
    if (*pattern == '*') {
        while (*pattern == '*') ++pattern;
        for (;; ++text) {
            if (matches(pattern, text)) return true;
            if (*text == '\0') return false;
        }
    }
    return *text != '\0' && (*pattern == '?' || *pattern == *text) &&
           matches(pattern + 1, text + 1);
}

}  // namespace

std::vector<std::pair<Role, std::vector<std::string>>> words_of_roles() {
    return {
        {Role::ignored,
         {"text", "texts", "dim", "dims", "dimension", "hatch", "title", "label", "anno",
          "annotation", "bbox", "grid", "axis"}},
        {Role::opening, {"opening", "swing", "sill", "threshold", "öffnung"}},
        {Role::window,
         {"window", "glaz", "glazing", "fenster", "fenêtre", "fenetre", "ventana", "finestra",
          "finestre"}},
        {Role::door,
         {"door", "tür", "türen", "tuer", "tueren", "porte", "puerta", "porta", "zimmertür",
          "haustür"}},
        {Role::obstacle,
         {"obstacle", "furniture", "furn", "tree", "möbel", "moebel", "meuble", "mobili", "baum",
          "hindernis"}},
        {Role::wall,
         {"wall",      "wand",    "wände",     "waende", "aussenwand", "außenwand", "innenwand",
          "trennwand", "mauer",   "mur",       "muro",   "muri",       "parete",    "pareti",
          "pared",     "paredes", "cloison",   "column", "cols",       "pillar",    "säule",
          "saeule",    "stütze",  "partition", "fence"}},
        {Role::room, {"room", "space", "raum", "räume", "zimmer", "pièce", "stanza", "habitación"}},
        {Role::outline, {"outline", "boundary", "gallery", "umriss"}},
        {Role::building, {"building", "footprint", "gebäude", "gebaeude", "bâtiment", "edificio"}},
    };
}

std::optional<Role> role_of_word(const std::string& text) {
    static const auto table = words_of_roles();
    const std::vector<std::string> words = words_in(text);
    for (const auto& [role, known] : table) {
        for (const std::string& word : words) {
            const auto is = [&](const std::string& k) { return word == k || word == k + "s"; };
            if (std::any_of(known.begin(), known.end(), is)) return role;
        }
    }
    return std::nullopt;
}

std::optional<Role> role_by_rules(const std::vector<RoleRule>& rules, const std::string& text) {
    const std::string lower = lower_case(text);
    const RoleRule* best = nullptr;
    for (const RoleRule& rule : rules) {
        if (!matches(lower_case(rule.pattern).c_str(), lower.c_str())) continue;
        if (best == nullptr || rule.pattern.size() > best->pattern.size()) best = &rule;
    }
    return best == nullptr ? std::nullopt : std::optional(best->role);
}

Role default_role(SiteKind kind, bool polygon) {
    if (kind == SiteKind::outdoor) return polygon ? Role::building : Role::wall;
    return polygon ? Role::outline : Role::wall;
}

}  // namespace vfplan
