// The door to HDF5. Files are written aside, closed, synced and renamed, so that a file under its
// own name is whole; nothing of the machine or the hour goes into them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vfplan::h5 {

using Dims = std::vector<std::uint64_t>;

// Writes one file. Throws IoError, naming the file, on any failure; without close() nothing
// appears under the final name. Not thread-safe.
class Writer {
public:
    explicit Writer(std::filesystem::path path);
    ~Writer();
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void group(const std::string& name);

    // A dataset of float, double, int8..int64, uint8; large ones chunked and compressed.
    template <class T>
    void write(const std::string& name, const std::vector<T>& data, Dims dims = {});
    void write_strings(const std::string& name, const std::vector<std::string_view>& data);

    // `object` is a group or dataset, "/" for the file.
    void attribute(const std::string& object, const std::string& name, const std::string& value);
    void attribute(const std::string& object, const std::string& name, const char* value) {
        attribute(object, name, std::string(value));
    }
    void attribute(const std::string& object, const std::string& name, double value);
    void attribute(const std::string& object, const std::string& name, float value);
    void attribute(const std::string& object, const std::string& name, std::int64_t value);
    void attribute(const std::string& object, const std::string& name,
                   const std::vector<std::int64_t>& value);
    // Marks `scale` as the scale of dimension `dim` of `dataset`.
    void scale(const std::string& dataset, unsigned dim, const std::string& scale_name);

    void close();

private:
    struct Impl;
    Impl* impl_;
};

// Reads one file. Throws IoError when it cannot be opened, lacks something or is damaged.
class Reader {
public:
    explicit Reader(std::filesystem::path path);
    ~Reader();
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    bool has(const std::string& name) const;
    Dims dims(const std::string& name) const;
    template <class T>
    std::vector<T> read(const std::string& name) const;
    // `count` values of a dataset of one dimension, from `from` on.
    template <class T>
    std::vector<T> read(const std::string& name, std::uint64_t from, std::uint64_t count) const;
    bool has_attribute(const std::string& object, const std::string& name) const;
    std::string text(const std::string& object, const std::string& name) const;
    double number(const std::string& object, const std::string& name) const;

private:
    struct Impl;
    Impl* impl_;
};

}  // namespace vfplan::h5
