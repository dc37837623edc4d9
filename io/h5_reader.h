// Reading HDF5.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vfplan::h5 {

using Dims = std::vector<std::uint64_t>;

// A dataset of another file as a part of a virtual one.
struct Source {
    std::string file;  // relative to the file with the virtual dataset
    std::string dataset;
    Dims offset;  // where in the virtual dataset it stands
    Dims shape;

    bool operator==(const Source&) const = default;
};

// Reads one file. Throws IoError when it cannot be opened, lacks something or is damaged; the
// whole file's hash is checked first, once in a process for each state of a file. A file need not
// be what it says: nothing outside it is read (links, external and virtual data are refused),
// nothing larger than what it can hold is made room for, and text and numbers are what they are
// read as. What its numbers mean is for the caller to check. Thread-safe.
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
    // What a virtual dataset consists of. The data themselves are read from there, by names of
    // ours.
    std::vector<Source> sources(const std::string& name) const;
    // Throws the IoError of a damaged file.
    [[noreturn]] void fail(const std::string& what) const;
    bool has_attribute(const std::string& object, const std::string& name) const;
    std::string text(const std::string& object, const std::string& name) const;
    double number(const std::string& object, const std::string& name) const;
    // A whole number that is `least` to `most`.
    std::int64_t whole(const std::string& object, const std::string& name, std::int64_t least = 0,
                       std::int64_t most = std::int64_t{1} << 53) const;

private:
    struct Impl;
    Impl* impl_;
};

}  // namespace vfplan::h5
