// Writing HDF5. Files are written aside, closed, synced and renamed, so that a file under its own
// name is whole; nothing of the machine or the hour goes into them. Behind the HDF5 content stands
// a line with its checksum (io/checksum.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/h5_reader.h"

namespace vfplan::h5 {

// Writes one file. Throws IoError, naming the file, on any failure; without close() nothing
// appears under the final name. One file belongs to one thread; several may be written at once, and
// compress at once.
class Writer {
public:
    explicit Writer(std::filesystem::path path);
    ~Writer();
    Writer(Writer&& other) noexcept : impl_(std::exchange(other.impl_, nullptr)) {}
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void group(const std::string& name);

    // A dataset of float, double, uint8, int32 or int64; large ones chunked and compressed.
    // `chunk`: values in a chunk of one dimension, small where short stretches will be read.
    template <class T>
    void write(const std::string& name, const std::vector<T>& data, Dims dims = {},
               std::uint64_t chunk = default_chunk);

    // A dataset of one dimension that comes bit by bit: begin, append until `count` values are
    // there, end. Several may be open at once.
    template <class T>
    void begin(const std::string& name, std::uint64_t count, std::uint64_t chunk = default_chunk);
    template <class T>
    void append(const std::string& name, const std::vector<T>& data);

    // A dataset that consists of others. What no source covers reads as `fill`.
    template <class T>
    void write_virtual(const std::string& name, const Dims& dims,
                       const std::vector<Source>& sources, T fill);

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

    static constexpr std::uint64_t default_chunk = 1U << 18;  // 1-2 MB: deflate and readers like it

private:
    struct Impl;
    Impl* impl_;
};

}  // namespace vfplan::h5
