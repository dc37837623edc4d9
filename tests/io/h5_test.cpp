#include "io/h5_reader.h"
#include "io/h5_writer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "io/files.h"
#include "kernels/error.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

std::vector<double> ramp(std::size_t count) {
    std::vector<double> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = 0.25 * static_cast<double>(i);
    return out;
}

void write_sample(const std::filesystem::path& path) {
    h5::Writer file(path);
    file.group("g");
    file.write("g/large", ramp(900000), {900, 1000});
    file.write("g/run", ramp(3000));
    file.write("small", std::vector<std::int32_t>{3, -1, 4});
    file.write("none", std::vector<float>{});
    file.write("bytes", std::vector<std::uint8_t>{0, 255});
    file.write("long", std::vector<std::int64_t>{std::int64_t{1} << 60, -7});
    file.attribute("/", "title", "a title");
    file.attribute("g", "number", 2.5);
    file.attribute("g", "count", std::int64_t{12});
    file.attribute("small", "empty", "");
    file.close();
}

TEST(H5, ReadsBackWhatWasWritten) {
    const test::TemporaryFile file("sample.h5");
    write_sample(file.path());
    const h5::Reader in(file.path());
    EXPECT_EQ(in.read<double>("g/large"), ramp(900000));
    EXPECT_EQ(in.dims("g/large"), (h5::Dims{900, 1000}));
    EXPECT_EQ(in.read<double>("g/run"), ramp(3000));
    EXPECT_EQ(in.read<std::int32_t>("small"), (std::vector<std::int32_t>{3, -1, 4}));
    EXPECT_TRUE(in.read<float>("none").empty());
    EXPECT_EQ(in.read<std::uint8_t>("bytes"), (std::vector<std::uint8_t>{0, 255}));
    EXPECT_EQ(in.read<std::int64_t>("long"),
              (std::vector<std::int64_t>{std::int64_t{1} << 60, -7}));
    EXPECT_EQ(in.text("/", "title"), "a title");
    EXPECT_EQ(in.text("small", "empty"), "");
    EXPECT_EQ(in.number("g", "number"), 2.5);
    EXPECT_EQ(in.number("g", "count"), 12);
    EXPECT_TRUE(in.has_attribute("/", "title"));
    EXPECT_FALSE(in.has_attribute("/", "author"));
}

TEST(H5, ReadsAPartOfARun) {
    const test::TemporaryFile file("part.h5");
    {
        h5::Writer out(file.path());
        out.write("run", ramp(700000));  // several chunks
        out.write("none", std::vector<float>{});
        out.write("square", ramp(100), {10, 10});
        out.close();
    }
    const h5::Reader in(file.path());
    const std::vector<double> all = ramp(700000);
    for (const auto& [from, count] : std::vector<std::pair<int, int>>{
             {0, 700000}, {0, 1}, {699999, 1}, {262000, 300000}, {262144, 262144}, {5, 0}}) {
        EXPECT_EQ(in.read<double>("run", static_cast<std::uint64_t>(from),
                                  static_cast<std::uint64_t>(count)),
                  std::vector<double>(all.begin() + from, all.begin() + from + count));
    }
    EXPECT_TRUE(in.read<float>("none", 0, 0).empty());
    EXPECT_THROW(in.read<double>("run", 699999, 2), IoError);
    EXPECT_THROW(in.read<double>("run", 700001, 0), IoError);
    EXPECT_THROW(in.read<double>("square", 0, 5), IoError);
    EXPECT_THROW(in.read<double>("nothing", 0, 1), IoError);
}

TEST(H5, EqualContentsGiveEqualBytes) {
    const test::TemporaryFile a("a.h5");
    const test::TemporaryFile b("b.h5");
    write_sample(a.path());
    write_sample(b.path());
    const std::string first = read_text(a.path());
    EXPECT_EQ(first, read_text(b.path()));
    write_sample(a.path());  // over the old one
    EXPECT_EQ(first, read_text(a.path()));
}

// Object headers of version 2 begin with OHDR, the version and flags; flag 32 says that times of
// change are kept. Two writes within one second would not show them.
TEST(H5, KeepsNoTimes) {
    const test::TemporaryFile file("times.h5");
    write_sample(file.path());
    const std::string bytes = read_text(file.path());
    int headers = 0;
    for (std::size_t i = bytes.find("OHDR\2"); i != std::string::npos;
         i = bytes.find("OHDR\2", i + 1)) {
        ++headers;
        EXPECT_EQ(static_cast<unsigned char>(bytes[i + 5]) & 32U, 0U) << "object " << headers;
    }
    EXPECT_GT(headers, 5);
}

TEST(H5, NothingAppearsWithoutClose) {
    const test::TemporaryFile file("open.h5");
    std::filesystem::path aside = file.path();
    aside += ".tmp";
    {
        h5::Writer out(file.path());
        out.write("x", ramp(10));
        EXPECT_FALSE(std::filesystem::exists(file.path()));
    }
    EXPECT_FALSE(std::filesystem::exists(file.path()));
    EXPECT_FALSE(std::filesystem::exists(aside));
}

TEST(H5, AFailedRewriteLeavesTheOldFile) {
    const test::TemporaryFile file("old.h5");
    write_sample(file.path());
    const std::string before = read_text(file.path());
    {
        h5::Writer out(file.path());
        out.write("x", ramp(10));
    }
    EXPECT_EQ(read_text(file.path()), before);
}

TEST(H5, FailuresNameTheFile) {
    const test::TemporaryFile file("failures.h5");
    const auto message_of = [&](auto&& f) -> std::string {
        try {
            f();
        } catch (const IoError& e) {
            return e.what();
        }
        ADD_FAILURE() << "no IoError";
        return "";
    };
    const auto names_it = [&](const std::string& message) {
        return message.find("failures.h5") != std::string::npos;
    };
    EXPECT_TRUE(names_it(message_of([&] { h5::Reader in(file.path()); })));
    write_text(file.path(), "this is no HDF5 file");
    EXPECT_TRUE(names_it(message_of([&] { h5::Reader in(file.path()); })));
    write_sample(file.path());
    const h5::Reader in(file.path());
    EXPECT_TRUE(names_it(message_of([&] { in.read<double>("nothing"); })));
    EXPECT_TRUE(names_it(message_of([&] { in.text("/", "nothing"); })));
    EXPECT_TRUE(names_it(message_of([&] { in.number("/", "nothing"); })));
    EXPECT_THROW(h5::Writer("no/such/folder/x.h5"), IoError);
    const test::TemporaryFile other("shape.h5");
    h5::Writer out(other.path());
    EXPECT_THROW(out.write("x", ramp(10), {3, 4}), IoError);
}

TEST(H5, DamageIsNoticed) {
    const test::TemporaryFile file("damaged.h5");
    {
        h5::Writer out(file.path());
        std::vector<double> noise(20000);  // so that compression leaves most of it
        double v = 0.5;
        for (double& n : noise) n = v = 3.99 * v * (1 - v);
        out.write("noise", noise);
        out.close();
    }
    std::string bytes = read_text(file.path());
    for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 16; ++i) {
        bytes[i] = static_cast<char>(~bytes[i]);
    }
    test::overwrite(file.path(), bytes);
    EXPECT_THROW(h5::Reader(file.path()).read<double>("noise"), IoError);
}

// Values that compress neither well nor not at all.
template <class T>
std::vector<T> values(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<T> out(count);
    for (T& v : out) v = static_cast<T>(static_cast<std::int64_t>(random() % 61) - 30);
    return out;
}

// Chunks are packed here and unpacked, checksum and all, by the library.
template <class T>
void expect_packed_is_readable() {
    const test::TemporaryFile file("packed.h5");
    constexpr std::uint64_t chunk = 1000;
    std::vector<std::size_t> sizes = {0,   1,   2,    3,    255,  256,  257, 719,
                                      721, 999, 1000, 1001, 1439, 2000, 3001};
    {
        h5::Writer out(file.path());
        for (const std::size_t n : sizes) {
            out.write(fmt::format("v{}", n), values<T>(n, n), {}, chunk);
            out.begin<T>(fmt::format("b{}", n), n, chunk);
            out.append(fmt::format("b{}", n), values<T>(n, n));
        }
        out.write("plane", values<T>(1025 * 513, 7), {1025, 513});
        out.write("strip", values<T>(3 * 700, 8), {3, 700});
        out.close();
    }
    const h5::Reader in(file.path());
    for (const std::size_t n : sizes) {
        EXPECT_EQ(in.read<T>(fmt::format("v{}", n)), values<T>(n, n)) << n;
        EXPECT_EQ(in.read<T>(fmt::format("b{}", n)), values<T>(n, n)) << n;
    }
    EXPECT_EQ(in.read<T>("plane"), values<T>(1025 * 513, 7));
    EXPECT_EQ(in.read<T>("strip"), values<T>(3 * 700, 8));
    const auto part = in.read_window<T>("plane", {500, 400}, {30, 113});
    const auto whole = values<T>(1025 * 513, 7);
    for (std::size_t y = 0; y < 30; ++y) {
        for (std::size_t x = 0; x < 113; ++x) {
            ASSERT_EQ(part[y * 113 + x], whole[(500 + y) * 513 + 400 + x]);
        }
    }
    const auto some = in.read<T>("v3001", 990, 1500);
    const auto all = values<T>(3001, 3001);
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin() + 990));
    EXPECT_TRUE(in.read<T>("v3001", 3001, 0).empty());
}

TEST(H5, ChunksOfOurOwnPackingAreReadable) {
    expect_packed_is_readable<float>();
    expect_packed_is_readable<double>();
    expect_packed_is_readable<std::uint8_t>();
    expect_packed_is_readable<std::int32_t>();
    expect_packed_is_readable<std::int64_t>();
}

// The library checks each chunk's sum: of all zeros, of all ones, of odd length.
TEST(H5, ChecksumsOfExtremeChunksAreAsTheLibraryTakesThem) {
    const test::TemporaryFile file("extreme.h5");
    h5::Writer out(file.path());
    for (const int v : {0, 1, 127, 255}) {
        for (const std::uint64_t n : {257U, 720U, 721U, 100003U}) {
            out.write(fmt::format("v{}_{}", v, n),
                      std::vector<std::uint8_t>(n, static_cast<std::uint8_t>(v)), {}, n);
        }
    }
    out.close();
    const h5::Reader in(file.path());
    for (const int v : {0, 1, 127, 255}) {
        for (const std::uint64_t n : {257U, 720U, 721U, 100003U}) {
            EXPECT_EQ(in.read<std::uint8_t>(fmt::format("v{}_{}", v, n)),
                      std::vector<std::uint8_t>(n, static_cast<std::uint8_t>(v)));
        }
    }
}

TEST(H5, AColumnThatComesBitByBitIsTheColumnInOnePiece) {
    const test::TemporaryFile whole("whole.h5");
    const test::TemporaryFile bits("bits.h5");
    const std::vector<std::int32_t> data = values<std::int32_t>(5000, 3);
    {
        h5::Writer out(whole.path());
        out.write("x", data, {}, 700);
        out.close();
    }
    for (const std::size_t step : {1U, 7U, 699U, 700U, 701U, 1400U, 4999U}) {
        h5::Writer out(bits.path());
        out.begin<std::int32_t>("x", data.size(), 700);
        for (std::size_t i = 0; i < data.size(); i += step) {
            const auto to = std::min(data.size(), i + step);
            out.append("x",
                       std::vector<std::int32_t>(data.begin() + static_cast<std::ptrdiff_t>(i),
                                                 data.begin() + static_cast<std::ptrdiff_t>(to)));
        }
        out.close();
        EXPECT_EQ(read_text(bits.path()), read_text(whole.path())) << step;
    }
}

TEST(H5, AColumnMustComeWholeAndNoMore) {
    const test::TemporaryFile file("column.h5");
    {
        h5::Writer out(file.path());
        out.begin<double>("x", 10);
        out.append("x", ramp(9));
        EXPECT_THROW(out.close(), IoError);
    }
    EXPECT_FALSE(std::filesystem::exists(file.path()));
    h5::Writer out(file.path());
    out.begin<double>("x", 10);
    EXPECT_THROW(out.append("x", ramp(11)), IoError);
    EXPECT_THROW(out.append("y", ramp(1)), IoError);
}

TEST(H5, VirtualDatasetsNameTheirParts) {
    const test::TemporaryFolder folder("virtual");
    std::filesystem::create_directories(folder.path() / "parts");
    for (const std::int32_t k : {0, 1}) {
        h5::Writer out(folder.path() / "parts" / fmt::format("p{}.h5", k));
        out.write("plane", values<float>(600, static_cast<std::uint64_t>(k)), {20, 30});
        out.group("g");
        out.write("g/run", values<std::int32_t>(300, static_cast<std::uint64_t>(k)));
        out.close();
    }
    const std::filesystem::path index = folder.path() / "index.h5";
    // Two planes on the diagonal; the rest is nobody's.
    const std::vector<h5::Source> plane = {{"parts/p0.h5", "plane", {0, 0}, {20, 30}},
                                           {"parts/p1.h5", "plane", {20, 30}, {20, 30}}};
    const std::vector<h5::Source> run = {{"parts/p1.h5", "g/run", {0}, {300}},
                                         {"parts/p0.h5", "g/run", {300}, {300}}};
    {
        h5::Writer out(index);
        out.write_virtual<float>("plane", {40, 60}, plane, -99.0F);
        out.write_virtual<std::int32_t>("run", {600}, run, -1);
        out.write_virtual<std::int32_t>("none", {0}, {}, -1);
        out.close();
    }
    // What others see of it, tests/e2e/readers_test.py looks at; we read parts by names of our own.
    const h5::Reader in(index);
    EXPECT_EQ(in.sources("plane"), plane);
    EXPECT_EQ(in.sources("run"), run);
    EXPECT_TRUE(in.sources("none").empty());
    EXPECT_EQ(in.dims("plane"), (h5::Dims{40, 60}));
    EXPECT_THROW(in.read<float>("plane"), IoError);
    EXPECT_THROW(in.read_window<float>("plane", {0, 0}, {1, 1}), IoError);
    EXPECT_THROW(in.read<std::int32_t>("run", 0, 1), IoError);
}

}  // namespace
}  // namespace vfplan
