#include "io/h5.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <unistd.h>

#include <algorithm>
#include <numeric>

#include "io/files.h"
#include "kernels/error.h"

namespace vfplan::h5 {
namespace {

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
hid_t type_of<float>() {
    return H5T_IEEE_F32LE;
}
template <>
hid_t type_of<double>() {
    return H5T_IEEE_F64LE;
}
template <>
hid_t type_of<std::int8_t>() {
    return H5T_STD_I8LE;
}
template <>
hid_t type_of<std::uint8_t>() {
    return H5T_STD_U8LE;
}
template <>
hid_t type_of<std::int32_t>() {
    return H5T_STD_I32LE;
}
template <>
hid_t type_of<std::int64_t>() {
    return H5T_STD_I64LE;
}

void be_quiet() {
    static const herr_t once = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    (void)once;
}

constexpr std::uint64_t chunk_values = 1U << 18;  // 1-2 MB, a good size for deflate and readers

// Square-ish chunks in two dimensions, runs in one.
Dims chunk_of(const Dims& dims) {
    Dims chunk = dims;
    if (dims.size() == 1) chunk[0] = std::min<std::uint64_t>(dims[0], chunk_values);
    if (dims.size() == 2) {
        chunk[0] = std::min<std::uint64_t>(dims[0], 512);
        chunk[1] = std::min<std::uint64_t>(dims[1], 512);
    }
    return chunk;
}

}  // namespace

struct Writer::Impl {
    std::filesystem::path path;
    std::filesystem::path aside;
    hid_t file = -1;

    [[noreturn]] void fail(const std::string& what) const {
        throw IoError(fmt::format("{}: cannot write {}; check free space and permissions",
                                  path.string(), what));
    }
    void attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                   const void* value) const {
        const Id on(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose);
        const Id a(H5Acreate2(on, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        if (a < 0 || H5Awrite(a, type, value) < 0) fail("attribute " + name);
    }
};

Writer::Writer(std::filesystem::path path) : impl_(new Impl{std::move(path), {}, -1}) {
    be_quiet();
    impl_->aside = impl_->path;
    impl_->aside += ".tmp";
    const Id create(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    H5Pset_link_creation_order(create, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
    impl_->file = H5Fcreate(impl_->aside.c_str(), H5F_ACC_TRUNC, create, access);
    if (impl_->file < 0) {
        const Impl kept = *impl_;
        delete impl_;
        impl_ = nullptr;
        kept.fail("the file");
    }
}

Writer::~Writer() {
    if (impl_->file >= 0) {
        H5Fclose(impl_->file);
        std::error_code ignored;
        std::filesystem::remove(impl_->aside, ignored);
    }
    delete impl_;
}

void Writer::group(const std::string& name) {
    const Id create(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    const Id g(H5Gcreate2(impl_->file, name.c_str(), H5P_DEFAULT, create, H5P_DEFAULT), H5Gclose);
    if (g < 0) impl_->fail("group " + name);
}

template <class T>
void Writer::write(const std::string& name, const std::vector<T>& data, Dims dims) {
    if (dims.empty()) dims = {data.size()};
    const std::uint64_t count =
        std::accumulate(dims.begin(), dims.end(), std::uint64_t{1}, std::multiplies<>());
    if (count != data.size()) impl_->fail(name + " (its shape does not fit)");
    const std::vector<hsize_t> shape(dims.begin(), dims.end());
    const Id space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                   H5Sclose);
    const Id create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    if (count >= 256) {
        const Dims chunk = chunk_of(dims);
        const std::vector<hsize_t> c(chunk.begin(), chunk.end());
        H5Pset_chunk(create, static_cast<int>(c.size()), c.data());
        H5Pset_shuffle(create);
        H5Pset_deflate(create, 1);
        H5Pset_fletcher32(create);
    }
    const Id set(H5Dcreate2(impl_->file, name.c_str(), type_of<T>(), space, H5P_DEFAULT, create,
                            H5P_DEFAULT),
                 H5Dclose);
    if (set < 0) impl_->fail(name);
    if (count > 0 && H5Dwrite(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) < 0) {
        impl_->fail(name);
    }
}

void Writer::write_strings(const std::string& name, const std::vector<std::string_view>& data) {
    std::size_t width = 1;
    for (const auto& s : data) width = std::max(width, s.size());
    std::string flat;
    for (const auto& s : data) {
        flat.append(s);
        flat.append(width - s.size(), '\0');
    }
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, width);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const hsize_t count = data.size();
    const Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const Id create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    const Id set(
        H5Dcreate2(impl_->file, name.c_str(), type, space, H5P_DEFAULT, create, H5P_DEFAULT),
        H5Dclose);
    if (set < 0 ||
        (count > 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, flat.data()) < 0)) {
        impl_->fail(name);
    }
}

void Writer::attribute(const std::string& object, const std::string& name,
                       const std::string& value) {
    const Id type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, std::max<std::size_t>(1, value.size()));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_UTF8);
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    impl_->attribute(object, name, type, space, value.empty() ? "\0" : value.data());
}

void Writer::attribute(const std::string& object, const std::string& name, double value) {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    impl_->attribute(object, name, H5T_IEEE_F64LE, space, &value);
}

void Writer::attribute(const std::string& object, const std::string& name, float value) {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    impl_->attribute(object, name, H5T_IEEE_F32LE, space, &value);
}

void Writer::attribute(const std::string& object, const std::string& name, std::int64_t value) {
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    impl_->attribute(object, name, H5T_STD_I64LE, space, &value);
}

void Writer::attribute(const std::string& object, const std::string& name,
                       const std::vector<std::int64_t>& value) {
    const hsize_t count = value.size();
    const Id space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    impl_->attribute(object, name, H5T_STD_I64LE, space, value.data());
}

void Writer::scale(const std::string& dataset, unsigned dim, const std::string& scale_name) {
    const Id set(H5Dopen2(impl_->file, dataset.c_str(), H5P_DEFAULT), H5Dclose);
    const Id along(H5Dopen2(impl_->file, scale_name.c_str(), H5P_DEFAULT), H5Dclose);
    if (H5DSis_scale(along) <= 0) H5DSset_scale(along, scale_name.c_str());
    if (H5DSattach_scale(set, along, dim) < 0) impl_->fail("scale " + scale_name);
}

void Writer::close() {
    if (H5Fclose(impl_->file) < 0) {
        impl_->file = -1;
        impl_->fail("the file to its end");
    }
    impl_->file = -1;
    publish(impl_->aside, impl_->path);
}

struct Reader::Impl {
    std::filesystem::path path;
    hid_t file = -1;

    [[noreturn]] void fail(const std::string& what) const {
        throw IoError(
            fmt::format("{}: {}; the file is damaged or not one of ours, run the job "
                        "again with --fresh",
                        path.string(), what));
    }
};

Reader::Reader(std::filesystem::path path) : impl_(new Impl{std::move(path), -1}) {
    be_quiet();
    impl_->file = H5Fopen(impl_->path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (impl_->file < 0) {
        const Impl kept = *impl_;
        delete impl_;
        if (!std::filesystem::exists(kept.path)) {
            throw IoError(fmt::format("{}: no such file; is this the folder of a finished run?",
                                      kept.path.string()));
        }
        kept.fail("cannot be opened as HDF5");
    }
}

Reader::~Reader() {
    H5Fclose(impl_->file);
    delete impl_;
}

bool Reader::has(const std::string& name) const {
    return H5Lexists(impl_->file, name.c_str(), H5P_DEFAULT) > 0;
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

template <class T>
std::vector<T> Reader::read(const std::string& name, std::uint64_t from,
                            std::uint64_t count) const {
    const Dims shape = dims(name);
    if (shape.size() != 1 || from > shape[0] || count > shape[0] - from) {
        impl_->fail("dataset " + name + " is too short");
    }
    std::vector<T> out(count);
    if (count == 0) return out;
    const Id set(H5Dopen2(impl_->file, name.c_str(), H5P_DEFAULT), H5Dclose);
    const Id part(H5Dget_space(set), H5Sclose);
    const hsize_t start = from;
    const hsize_t length = count;
    H5Sselect_hyperslab(part, H5S_SELECT_SET, &start, nullptr, &length, nullptr);
    const Id memory(H5Screate_simple(1, &length, nullptr), H5Sclose);
    if (H5Dread(set, type_of<T>(), memory, part, H5P_DEFAULT, out.data()) < 0) {
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

template void Writer::write(const std::string&, const std::vector<float>&, Dims);
template void Writer::write(const std::string&, const std::vector<double>&, Dims);
template void Writer::write(const std::string&, const std::vector<std::int8_t>&, Dims);
template void Writer::write(const std::string&, const std::vector<std::uint8_t>&, Dims);
template void Writer::write(const std::string&, const std::vector<std::int32_t>&, Dims);
template void Writer::write(const std::string&, const std::vector<std::int64_t>&, Dims);
template std::vector<float> Reader::read(const std::string&) const;
template std::vector<float> Reader::read(const std::string&, std::uint64_t, std::uint64_t) const;
template std::vector<double> Reader::read(const std::string&) const;
template std::vector<double> Reader::read(const std::string&, std::uint64_t, std::uint64_t) const;
template std::vector<std::uint8_t> Reader::read(const std::string&) const;
template std::vector<std::uint8_t> Reader::read(const std::string&, std::uint64_t,
                                                std::uint64_t) const;
template std::vector<std::int32_t> Reader::read(const std::string&) const;
template std::vector<std::int32_t> Reader::read(const std::string&, std::uint64_t,
                                                std::uint64_t) const;
template std::vector<std::int64_t> Reader::read(const std::string&) const;
template std::vector<std::int64_t> Reader::read(const std::string&, std::uint64_t,
                                                std::uint64_t) const;

}  // namespace vfplan::h5
