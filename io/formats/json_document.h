// JSON files, read with the place of everything that is wrong.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace vfplan {

// Throws InputError with line and column.
nlohmann::json parse_json(const std::string& text, const std::filesystem::path& file);

// Whether a text is JSON, read without being kept. Throws InputError with line and column if not.
void check_json(const std::string& text, const std::filesystem::path& file);

// A value on its way from the root, so that errors can say where it stands ("/verts/3/0"). Points
// into the document, which must outlive it. All that it asks for throws InputError when it is not
// there or of another type.
class JsonAt {
public:
    JsonAt(const nlohmann::json& root, const std::filesystem::path& file)
        : value_(&root), file_(&file) {}

    bool has(const char* key) const;
    JsonAt operator[](const char* key) const;
    JsonAt at(std::size_t index) const;
    std::size_t size() const;                    // of an array
    double number() const;                       // finite
    std::size_t index(std::size_t below) const;  // a whole number, 0 to below - 1
    std::string text() const;
    const nlohmann::json& value() const { return *value_; }
    // An error about this value.
    [[noreturn]] void fail(const std::string& problem) const;

private:
    struct Step {
        const char* key = nullptr;
        std::size_t index = 0;
    };
    JsonAt stepped(const nlohmann::json& to, const Step& step) const;

    const nlohmann::json* value_;
    const std::filesystem::path* file_;
    std::array<Step, 10> steps_{};
    std::size_t depth_ = 0;
};

}  // namespace vfplan
