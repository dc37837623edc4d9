#include "io/h5_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "io/checksum.h"
#include "io/h5_types.h"

namespace vfplan::h5 {

struct Reader::Impl {
    std::filesystem::path path;
    hid_t file = -1;

    [[noreturn]] void fail(const std::string& what) const { damaged(path, what); }

    // Whatever lies on the way to an object lies in this file: links to others are refused.
    void check_way(const std::string& name) const {
        if (name == "/") return;
        for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
            const std::string part = name.substr(0, end);
            H5L_info_t info;
            if (H5Lget_info(file, part.c_str(), &info, H5P_DEFAULT) < 0) fail("no " + part);
            if (info.type != H5L_TYPE_HARD) fail(part + " is a link");
            if (end == std::string::npos) return;
        }
    }

    hid_t open_set(const std::string& name) const {
        check_way(name);
        const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
        if (set < 0) fail("no dataset " + name);
        return set;
    }

    static Dims dims_of(hid_t set) {
        const Id space(H5Dget_space(set), H5Sclose);
        const int rank = space < 0 ? 0 : H5Sget_simple_extent_ndims(space);
        std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(0, rank)));
        if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
        return {shape.begin(), shape.end()};
    }

    // That the values of a dataset lie in the file, and may be as many as it says: deflate packs a
    // thousand to one at the most.
    void check_room(hid_t set, const std::string& name, std::uint64_t width) const {
        constexpr std::uint64_t packed = 1100;
        constexpr std::uint64_t rest = 1U << 24;  // bytes of chunks that are not full
        const Id create(H5Dget_create_plist(set), H5Pclose);
        if (create < 0 || H5Pget_layout(create) == H5D_VIRTUAL ||
            H5Pget_external_count(create) != 0) {
            fail("dataset " + name + " lies in other files");
        }
        std::uint64_t bytes = width;
        for (const std::uint64_t n : dims_of(set)) {
            if (n > 0 && bytes > std::numeric_limits<std::uint64_t>::max() / n) {
                fail("dataset " + name + " is larger than any file");
            }
            bytes *= n;
        }
        if (bytes / packed > H5Dget_storage_size(set) + rest / packed) {
            fail("dataset " + name + " is larger than what the file holds");
        }
    }

    // An attribute of one value.
    hid_t open_attribute(const std::string& object, const std::string& name) const {
        check_way(object);
        const hid_t a =
            H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
        if (a < 0) fail("no attribute " + name);
        const Id space(H5Aget_space(a), H5Sclose);
        if (space >= 0 && H5Sget_simple_extent_npoints(space) == 1) return a;
        H5Aclose(a);
        fail("attribute " + name + " has not one value");
    }
};

Reader::Reader(std::filesystem::path path) : impl_(new Impl{std::move(path), -1}) {
    be_quiet();
    try {
        checked_hash(impl_->path);
        impl_->file = H5Fopen(impl_->path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
        if (impl_->file < 0) impl_->fail("cannot be opened as HDF5");
    } catch (...) {
        delete impl_;
        throw;
    }
}

Reader::~Reader() {
    H5Fclose(impl_->file);
    delete impl_;
}

void Reader::fail(const std::string& what) const { impl_->fail(what); }

Dims Reader::dims(const std::string& name) const {
    return Impl::dims_of(Id(impl_->open_set(name), H5Dclose));
}

template <class T>
std::vector<T> Reader::read(const std::string& name) const {
    const Id set(impl_->open_set(name), H5Dclose);
    impl_->check_room(set, name, sizeof(T));
    std::uint64_t count = 1;
    for (const std::uint64_t n : Impl::dims_of(set)) count *= n;
    std::vector<T> out(count);
    if (count > 0 && H5Dread(set, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0) {
        impl_->fail("dataset " + name + " cannot be read");
    }
    return out;
}

namespace {

// Reads a selection of a dataset; -1 when that fails.
template <class T>
herr_t read_slab(hid_t set, const std::vector<hsize_t>& from, const std::vector<hsize_t>& shape,
                 std::vector<T>& out) {
    const Id space(H5Dget_space(set), H5Sclose);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, from.data(), nullptr, shape.data(), nullptr) <
        0) {
        return -1;
    }
    const Id memory(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                    H5Sclose);
    return H5Dread(set, type_of<T>(), memory, space, H5P_DEFAULT, out.data());
}

bool within(std::uint64_t from, std::uint64_t count, std::uint64_t end) {
    return from <= end && count <= end - from;
}

}  // namespace

template <class T>
std::vector<T> Reader::read(const std::string& name, std::uint64_t from,
                            std::uint64_t count) const {
    const Id set(impl_->open_set(name), H5Dclose);
    const Dims shape = Impl::dims_of(set);
    if (shape.size() != 1 || !within(from, count, shape[0])) {
        impl_->fail(fmt::format("dataset {} has no values {} to {}", name, from, from + count));
    }
    impl_->check_room(set, name, sizeof(T));
    std::vector<T> out(count);
    if (count > 0 && read_slab(set, {from}, {count}, out) < 0) {
        impl_->fail("dataset " + name + " cannot be read");
    }
    return out;
}

template <class T>
std::vector<T> Reader::read_window(const std::string& name,
                                   const std::array<std::uint64_t, 2>& from,
                                   const std::array<std::uint64_t, 2>& shape) const {
    const Id set(impl_->open_set(name), H5Dclose);
    const Dims whole = Impl::dims_of(set);
    if (whole.size() != 2 || !within(from[0], shape[0], whole[0]) ||
        !within(from[1], shape[1], whole[1])) {
        impl_->fail(fmt::format("dataset {} has no {} x {} values from {}, {} on", name, shape[0],
                                shape[1], from[0], from[1]));
    }
    impl_->check_room(set, name, sizeof(T));
    std::vector<T> out(shape[0] * shape[1]);
    if (!out.empty() && read_slab(set, {from[0], from[1]}, {shape[0], shape[1]}, out) < 0) {
        impl_->fail("dataset " + name + " cannot be read");
    }
    return out;
}

std::vector<Source> Reader::sources(const std::string& name) const {
    const Id set(impl_->open_set(name), H5Dclose);
    const std::size_t rank = Impl::dims_of(set).size();
    const Id create(H5Dget_create_plist(set), H5Pclose);
    if (create < 0 || H5Pget_layout(create) != H5D_VIRTUAL) {
        impl_->fail("dataset " + name + " is no index over others");
    }
    std::size_t count = 0;
    H5Pget_virtual_count(create, &count);
    std::vector<Source> out;
    for (std::size_t i = 0; i < count; ++i) {
        const auto text = [&](auto&& get) {
            const ssize_t size = get(create, i, static_cast<char*>(nullptr), std::size_t{0});
            std::string value(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
            if (!value.empty()) get(create, i, value.data(), value.size() + 1);
            return value;
        };
        const Id part(H5Pget_virtual_vspace(create, i), H5Sclose);
        std::vector<hsize_t> begin(rank);
        std::vector<hsize_t> last(rank);
        if (part < 0 || H5Sget_select_bounds(part, begin.data(), last.data()) < 0) {
            impl_->fail("dataset " + name + " is an index that cannot be read");
        }
        Source source{text(H5Pget_virtual_filename), text(H5Pget_virtual_dsetname), {}, {}};
        std::uint64_t points = 1;
        for (std::size_t d = 0; d < rank; ++d) {
            source.offset.push_back(begin[d]);
            source.shape.push_back(last[d] - begin[d] + 1);
            points *= source.shape.back();
        }
        const Id from(H5Pget_virtual_srcspace(create, i), H5Sclose);
        if (H5Sget_select_npoints(part) != static_cast<hssize_t>(points) || from < 0 ||
            (H5Sget_select_type(from) != H5S_SEL_ALL &&
             H5Sget_select_npoints(from) != static_cast<hssize_t>(points))) {
            impl_->fail("dataset " + name + " is an index over parts of others");
        }
        out.push_back(std::move(source));
    }
    return out;
}

bool Reader::has_attribute(const std::string& object, const std::string& name) const {
    impl_->check_way(object);
    return H5Aexists_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string Reader::text(const std::string& object, const std::string& name) const {
    constexpr std::size_t most = 1U << 24;
    const Id a(impl_->open_attribute(object, name), H5Aclose);
    const Id type(H5Aget_type(a), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
        H5Tget_size(type) > most) {
        impl_->fail("attribute " + name + " is no text");
    }
    std::string out(H5Tget_size(type), '\0');
    if (H5Aread(a, type, out.data()) < 0) impl_->fail("attribute " + name + " cannot be read");
    out.erase(std::find(out.begin(), out.end(), '\0'), out.end());
    return out;
}

double Reader::number(const std::string& object, const std::string& name) const {
    const Id a(impl_->open_attribute(object, name), H5Aclose);
    double out = 0;
    if (H5Aread(a, H5T_IEEE_F64LE, &out) < 0) impl_->fail("attribute " + name + " is no number");
    return out;
}

std::int64_t Reader::whole(const std::string& object, const std::string& name, std::int64_t least,
                           std::int64_t most) const {
    const double value = number(object, name);
    if (!(value >= static_cast<double>(least) && value <= static_cast<double>(most))) {
        impl_->fail(fmt::format("attribute {} is {}, not from {} to {}", name, value, least, most));
    }
    return static_cast<std::int64_t>(value);
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
