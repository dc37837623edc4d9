// SHA-256, for telling jobs and results apart.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vfplan {

// Feed bytes, then ask for the hash in hexadecimal. Not thread-safe.
class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;

    void add(const void* data, std::size_t bytes);
    void add(const std::string& text) { add(text.data(), text.size()); }
    template <class T>
    void add(const std::vector<T>& values) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        add(values.data(), values.size() * sizeof(T));
    }
    std::string hex();

private:
    void* context_;
};

std::string sha256_of(std::string_view text);
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace vfplan
