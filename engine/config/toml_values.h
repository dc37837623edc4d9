// Values of parameters in TOML: the door to toml++ beside config.cpp.
#pragma once

#include <cstdint>
#include <string>

#include <toml++/toml.h>

#include "engine/config/parameters.h"

namespace vfplan {

// Where a value stands, for messages.
struct Place {
    std::string name;  // file, or "--set"
    std::uint32_t line = 0;
    std::uint32_t column = 0;

    std::string text() const;
};
Place place_of(const toml::source_region& source, const std::string& name);

// Gives a parameter its value. Throws UsageError, with the place, for a wrong type, a value out of
// range or no choice.
void set_value(const Parameter& parameter, const toml::node& value, const Place& place);

}  // namespace vfplan
