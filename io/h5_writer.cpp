#include "io/h5_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <numeric>

#include "io/aside.h"
#include "io/checksum.h"
#include "io/chunks.h"
#include "io/files.h"
#include "io/h5_types.h"
#include "kernels/error.h"

namespace vfplan::h5 {
namespace {

constexpr std::uint64_t plane_side = 512;  // chunks of two dimensions: 512 x 512

hid_t layout_with_filters(const Dims& chunk) {
    const hid_t create = H5Pcreate(H5P_DATASET_CREATE);
    const std::vector<hsize_t> c(chunk.begin(), chunk.end());
    H5Pset_obj_track_times(create, false);
    H5Pset_chunk(create, static_cast<int>(c.size()), c.data());
    H5Pset_shuffle(create);
    H5Pset_deflate(create, deflate_level);
    H5Pset_fletcher32(create);
    return create;
}

// A dataset of one dimension in the making. Full chunks are compressed here, not inside the
// library, which lets one thread at a time do anything.
struct Open {
    hid_t set = -1;
    std::uint64_t count = 0;
    std::uint64_t written = 0;  // values that are in full chunks already
    std::uint64_t chunk = 0;    // values in one
    std::size_t width = 0;      // bytes of a value
    std::vector<std::uint8_t> rest;
};

}  // namespace

struct Writer::Impl {
    std::filesystem::path path;
    Aside aside;
    hid_t file = -1;
    std::map<std::string, Open> open = {};

    void write_chunk(const std::string& name, Open& o, const std::uint8_t* data) const {
        const std::vector<std::uint8_t> packed = pack_chunk(data, o.chunk * o.width, o.width);
        const hsize_t offset = o.written;
        if (H5Dwrite_chunk(o.set, H5P_DEFAULT, 0, &offset, packed.size(), packed.data()) < 0) {
            fail(name);
        }
        o.written += o.chunk;
    }
    void append(const std::string& name, const std::uint8_t* data, std::size_t size) {
        const auto found = open.find(name);
        if (found == open.end()) fail(name + " (not begun)");
        Open& o = found->second;
        const std::size_t whole = o.chunk * o.width;
        while (size > 0) {
            if (o.rest.empty() && size >= whole) {  // straight from the caller
                write_chunk(name, o, data);
                data += whole;
                size -= whole;
                continue;
            }
            const std::size_t part = std::min(size, whole - o.rest.size());
            o.rest.insert(o.rest.end(), data, data + part);
            data += part;
            size -= part;
            if (o.rest.size() < whole) break;
            write_chunk(name, o, o.rest.data());
            o.rest.clear();
        }
        if (o.written + o.rest.size() / o.width < o.count) return;
        if (o.written + o.rest.size() / o.width > o.count) fail(name + " (more than was begun)");
        if (!o.rest.empty()) {
            o.rest.resize(whole, 0);
            write_chunk(name, o, o.rest.data());
        }
        H5Dclose(o.set);
        open.erase(found);
    }

    [[noreturn]] void fail(const std::string& what) const {
        constexpr std::uintmax_t next_to_nothing = 1U << 20U;
        int why = system_error();
        std::error_code error;
        const auto space = std::filesystem::space(path.parent_path(), error);
        if (why == 0 && !error && space.available < next_to_nothing) why = ENOSPC;
        throw IoError(fmt::format("{}: cannot write {}; {}", path.string(), what, advice_on(why)));
    }
    void attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                   const void* value) const {
        const Id on(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose);
        const Id a(H5Acreate2(on, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        if (a < 0 || H5Awrite(a, type, value) < 0) fail("attribute " + name);
    }
};

Writer::Writer(std::filesystem::path path) {
    be_quiet();
    impl_ = new Impl{path, Aside(path)};
    const Id create(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    H5Pset_link_creation_order(create, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110);
    // Exclusively: not through a link, not over what lies there.
    impl_->file = H5Fcreate(impl_->aside.path().c_str(), H5F_ACC_EXCL, create, access);
    if (impl_->file < 0) {
        const std::unique_ptr<Impl> kept(std::exchange(impl_, nullptr));
        kept->fail("the file");
    }
}

Writer::~Writer() {
    if (impl_ == nullptr) return;
    if (impl_->file >= 0) {
        for (auto& [name, o] : impl_->open) H5Dclose(o.set);
        H5Fclose(impl_->file);
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
void Writer::write(const std::string& name, const std::vector<T>& data, Dims dims,
                   std::uint64_t chunk) {
    if (dims.empty()) dims = {data.size()};
    const std::uint64_t count =
        std::accumulate(dims.begin(), dims.end(), std::uint64_t{1}, std::multiplies<>());
    if (count != data.size()) impl_->fail(name + " (its shape does not fit)");
    constexpr std::uint64_t worth_packing = 256;
    if (count >= worth_packing && dims.size() == 1) {
        begin<T>(name, count, chunk);
        append(name, data);
        return;
    }
    const std::vector<hsize_t> shape(dims.begin(), dims.end());
    const Id space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                   H5Sclose);
    const bool plane = count >= worth_packing && dims.size() == 2;
    const Dims block =
        plane ? Dims{std::min(dims[0], plane_side), std::min(dims[1], plane_side)} : Dims{};
    const Id create(plane ? layout_with_filters(block) : H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    const Id set(H5Dcreate2(impl_->file, name.c_str(), type_of<T>(), space, H5P_DEFAULT, create,
                            H5P_DEFAULT),
                 H5Dclose);
    if (set < 0) impl_->fail(name);
    if (count == 0) return;
    if (!plane) {
        if (H5Dwrite(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()) < 0) {
            impl_->fail(name);
        }
        return;
    }
    std::vector<T> values(block[0] * block[1]);
    for (std::uint64_t y = 0; y < dims[0]; y += block[0]) {
        for (std::uint64_t x = 0; x < dims[1]; x += block[1]) {
            std::fill(values.begin(), values.end(), T{});
            const std::uint64_t columns = std::min(block[1], dims[1] - x);
            for (std::uint64_t row = 0; row < std::min(block[0], dims[0] - y); ++row) {
                const T* from = data.data() + (y + row) * dims[1] + x;
                std::copy(from, from + columns, values.data() + row * block[1]);
            }
            const std::vector<std::uint8_t> packed =
                pack_chunk(reinterpret_cast<const std::uint8_t*>(values.data()),
                           values.size() * sizeof(T), sizeof(T));
            const hsize_t offset[2] = {y, x};
            if (H5Dwrite_chunk(set, H5P_DEFAULT, 0, offset, packed.size(), packed.data()) < 0) {
                impl_->fail(name);
            }
        }
    }
}

template <class T>
void Writer::begin(const std::string& name, std::uint64_t count, std::uint64_t chunk) {
    const hsize_t shape = count;
    const Id space(H5Screate_simple(1, &shape, nullptr), H5Sclose);
    chunk = std::max<std::uint64_t>(1, std::min(chunk, count));
    const Id create(count > 0 ? layout_with_filters({chunk}) : H5Pcreate(H5P_DATASET_CREATE),
                    H5Pclose);
    H5Pset_obj_track_times(create, false);
    const hid_t set = H5Dcreate2(impl_->file, name.c_str(), type_of<T>(), space, H5P_DEFAULT,
                                 create, H5P_DEFAULT);
    if (set < 0) impl_->fail(name);
    if (count == 0) {
        H5Dclose(set);
        return;
    }
    impl_->open[name] = {set, count, 0, chunk, sizeof(T), {}};
}

template <class T>
void Writer::append(const std::string& name, const std::vector<T>& data) {
    if (data.empty()) return;
    impl_->append(name, reinterpret_cast<const std::uint8_t*>(data.data()),
                  data.size() * sizeof(T));
}

template <class T>
void Writer::write_virtual(const std::string& name, const Dims& dims,
                           const std::vector<Source>& sources, T fill) {
    const std::vector<hsize_t> shape(dims.begin(), dims.end());
    const Id space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                   H5Sclose);
    const Id create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(create, false);
    H5Pset_fill_value(create, type_of<T>(), &fill);
    if (sources.empty()) H5Pset_layout(create, H5D_VIRTUAL);
    for (const Source& source : sources) {
        const std::vector<hsize_t> offset(source.offset.begin(), source.offset.end());
        const std::vector<hsize_t> part(source.shape.begin(), source.shape.end());
        const Id from(H5Screate_simple(static_cast<int>(part.size()), part.data(), nullptr),
                      H5Sclose);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, offset.data(), nullptr, part.data(), nullptr);
        if (H5Pset_virtual(create, space, source.file.c_str(), source.dataset.c_str(), from) < 0) {
            impl_->fail(name);
        }
    }
    H5Sselect_all(space);
    const Id set(H5Dcreate2(impl_->file, name.c_str(), type_of<T>(), space, H5P_DEFAULT, create,
                            H5P_DEFAULT),
                 H5Dclose);
    if (set < 0) impl_->fail(name);
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
    if (!impl_->open.empty()) impl_->fail(impl_->open.begin()->first + " (not all of it came)");
    if (H5Fclose(impl_->file) < 0) {
        impl_->file = -1;
        impl_->fail("the file to its end");
    }
    impl_->file = -1;
    if (!add_checksum(impl_->aside.path())) impl_->fail("the file to its end");
    impl_->aside.publish();
}

#define VFPLAN_OF_TYPE(T)                                                                        \
    template void Writer::write(const std::string&, const std::vector<T>&, Dims, std::uint64_t); \
    template void Writer::begin<T>(const std::string&, std::uint64_t, std::uint64_t);            \
    template void Writer::append(const std::string&, const std::vector<T>&);                     \
    template void Writer::write_virtual(const std::string&, const Dims&,                         \
                                        const std::vector<Source>&, T);
VFPLAN_EACH_H5_TYPE(VFPLAN_OF_TYPE)
#undef VFPLAN_OF_TYPE

}  // namespace vfplan::h5
