// Reading HDF5.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vfplan::h5 {

using Dims = std::vector<std::uint64_t>;

// Reads one file. Throws IoError when it cannot be opened, lacks something or is damaged; the
// whole file's hash is checked first, once in a process for each state of a file. Thread-safe.
class Reader {
public:
    explicit Reader(std::filesystem::path path);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    Dims dims(const std::string& name) const;
    template <class T>
    std::vector<T> read(const std::string& name) const;
    // `count` values of a dataset of one dimension.
    template <class T>
    std::vector<T> read(const std::string& name, std::uint64_t from, std::uint64_t count) const;
    // A rectangle of a dataset of two dimensions, row by row.
    template <class T>
    std::vector<T> read_window(const std::string& name, const std::array<std::uint64_t, 2>& from,
                               const std::array<std::uint64_t, 2>& shape) const;
    bool has_attribute(const std::string& object, const std::string& name) const;
    std::string text(const std::string& object, const std::string& name) const;
    double number(const std::string& object, const std::string& name) const;

private:
    struct Impl;
    Impl* impl_;
};

}  // namespace vfplan::h5
