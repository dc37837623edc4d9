#include "io/h5_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "io/checksum.h"
#include "io/h5_types.h"

namespace vfplan::h5 {

struct Reader::Impl {
    std::filesystem::path path;
    hid_t file = -1;

    [[noreturn]] void fail(const std::string& what) const { damaged(path, what); }
};

Reader::Reader(std::filesystem::path path) : impl_(new Impl{std::move(path), -1}) {
    be_quiet();
    try {
        checked_hash(impl_->path);
    } catch (...) {
        delete impl_;
        throw;
    }
    impl_->file = H5Fopen(impl_->path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (impl_->file < 0) {
        const Impl kept = *impl_;
        delete impl_;
        kept.fail("cannot be opened as HDF5");
    }
}

Reader::~Reader() {
    H5Fclose(impl_->file);
    delete impl_;
}

Dims Reader::dims(const std::string& name) const {
    const Id set(H5Dopen2(impl_->file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (set < 0) impl_->fail("no dataset " + name);
    const Id space(H5Dget_space(set), H5Sclose);
    std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    return {shape.begin(), shape.end()};
}

template <class T>
std::vector<T> Reader::read(const std::string& name) const {
    const Dims shape = dims(name);
    const std::uint64_t count =
        std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
    std::vector<T> out(count);
    const Id set(H5Dopen2(impl_->file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (count > 0 && H5Dread(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0) {
        impl_->fail("dataset " + name + " cannot be read");
    }
    return out;
}

namespace {

// Reads a selection of a dataset; -1 when that fails.
template <class T>
herr_t read_slab(hid_t file, const std::string& name, const std::vector<hsize_t>& from,
                 const std::vector<hsize_t>& shape, std::vector<T>& out) {
    const Id set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (set < 0) return -1;
    const Id space(H5Dget_space(set), H5Sclose);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, from.data(), nullptr, shape.data(), nullptr) <
        0) {
        return -1;
    }
    const Id memory(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                    H5Sclose);
    return H5Dread(set, type_of<T>(), memory, space, H5P_DEFAULT, out.data());
}

}  // namespace

template <class T>
std::vector<T> Reader::read(const std::string& name, std::uint64_t from,
                            std::uint64_t count) const {
    const Dims shape = dims(name);
    if (shape.size() != 1 || from > shape[0] || count > shape[0] - from) {
        impl_->fail(fmt::format("dataset {} has no values {} to {}", name, from, from + count));
    }
    std::vector<T> out(count);
    if (count > 0 && read_slab(impl_->file, name, {from}, {count}, out) < 0) {
        impl_->fail("dataset " + name + " cannot be read");
    }
    return out;
}

template <class T>
std::vector<T> Reader::read_window(const std::string& name,
                                   const std::array<std::uint64_t, 2>& from,
                                   const std::array<std::uint64_t, 2>& shape) const {
    std::vector<T> out(shape[0] * shape[1]);
    if (!out.empty() &&
        read_slab(impl_->file, name, {from[0], from[1]}, {shape[0], shape[1]}, out) < 0) {
        impl_->fail("dataset " + name + " cannot be read");
    }
    return out;
}

bool Reader::has_attribute(const std::string& object, const std::string& name) const {
    return H5Aexists_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string Reader::text(const std::string& object, const std::string& name) const {
    const Id a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
               H5Aclose);
    if (a < 0) impl_->fail("no attribute " + name);
    const Id type(H5Aget_type(a), H5Tclose);
    std::string out(H5Tget_size(type), '\0');
    if (H5Aread(a, type, out.data()) < 0) impl_->fail("attribute " + name + " cannot be read");
    out.erase(std::find(out.begin(), out.end(), '\0'), out.end());
    return out;
}

double Reader::number(const std::string& object, const std::string& name) const {
    const Id a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
               H5Aclose);
    double out = 0;
    if (a < 0 || H5Aread(a, H5T_IEEE_F64LE, &out) < 0) impl_->fail("no attribute " + name);
    return out;
}

#define VFPLAN_OF_TYPE(T)                                                                         \
    template std::vector<T> Reader::read(const std::string&) const;                               \
    template std::vector<T> Reader::read(const std::string&, std::uint64_t, std::uint64_t) const; \
    template std::vector<T> Reader::read_window(const std::string&,                               \
                                                const std::array<std::uint64_t, 2>&,              \
                                                const std::array<std::uint64_t, 2>&) const;
VFPLAN_EACH_H5_TYPE(VFPLAN_OF_TYPE)
#undef VFPLAN_OF_TYPE

}  // namespace vfplan::h5
