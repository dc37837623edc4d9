// How the features of a layer got their roles, counted for `inspect`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "io/features/feature.h"
#include "io/features/read_options.h"
#include "io/features/roles.h"

namespace vfplan {

class RoleTally {
public:
    // `text` told the role; no role: the feature is left out.
    void count(const std::string& text, std::optional<Role> role, const std::string& why) {
        ++as_[{text, role ? std::string(name_of(*role)) : "left out", why}];
    }
    // The role of what a format calls `text`: the user's word, else the format's own.
    std::optional<Role> settle(const ReadOptions& options, const std::string& text,
                               std::optional<Role> own) {
        const auto ruled = role_by_rules(options.roles, text);
        count(text, ruled ? ruled : own, ruled ? "site.roles" : "format");
        return ruled ? ruled : own;
    }
    // A feature of a format of our own, numbered as it comes, for the caller to give a shape; null
    // when it is left out. It stays where it is until the next.
    Feature* add(FeatureSet& set, const ReadOptions& options, const std::string& text,
                 std::optional<Role> own, const std::string& id = "") {
        const auto role = settle(options, text, own);
        if (!role) return nullptr;
        Feature f;
        f.number = static_cast<std::int64_t>(set.features.size()) + 1;
        f.id = id;
        f.role = *role;
        set.features.push_back(std::move(f));
        return &set.features.back();
    }
    void add_to(FeatureSet& set, const std::string& layer) const {
        for (const auto& [key, count] : as_) {
            const auto& [text, role, why] = key;
            if (role == "left out") set.ignored += count;
            set.how.as.push_back({layer, text, role, why, count});
        }
    }

private:
    std::map<std::tuple<std::string, std::string, std::string>, std::int64_t> as_;
};

}  // namespace vfplan
