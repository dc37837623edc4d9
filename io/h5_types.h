// What writing and reading HDF5 share: the door to the library, for h5_writer.cpp and
// h5_reader.cpp.
#pragma once

#include <hdf5.h>
#include <hdf5_hl.h>

#include <cstdint>

namespace vfplan::h5 {

// A handle that closes itself.
class Id {
public:
    Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Id() {
        if (id_ >= 0) close_(id_);
    }
    Id(const Id&) = delete;
    Id& operator=(const Id&) = delete;
    operator hid_t() const { return id_; }  // NOLINT: reads like the C calls it is used in

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

template <class T>
hid_t type_of();
template <>
inline hid_t type_of<float>() {
    return H5T_IEEE_F32LE;
}
template <>
inline hid_t type_of<double>() {
    return H5T_IEEE_F64LE;
}
template <>
inline hid_t type_of<std::uint8_t>() {
    return H5T_STD_U8LE;
}
template <>
inline hid_t type_of<std::int32_t>() {
    return H5T_STD_I32LE;
}
template <>
inline hid_t type_of<std::int64_t>() {
    return H5T_STD_I64LE;
}

// No messages of the library's own, which it would print for each thread; and nothing of it at the
// program's end, where it would fall over a file that could not be closed because the disk is full;
// and no code from elsewhere, which a file may ask for as a filter.
// To be called before anything else in each thread.
void be_quiet();

// What the system said when the library's last call failed, as errno has it; 0 where it said
// nothing.
int system_error();

// The types that datasets have.
#define VFPLAN_EACH_H5_TYPE(DO) \
    DO(float)                   \
    DO(double)                  \
    DO(std::uint8_t)            \
    DO(std::int32_t)            \
    DO(std::int64_t)

}  // namespace vfplan::h5
