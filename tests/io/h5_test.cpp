#include "io/h5.h"

#include <gtest/gtest.h>

#include <numeric>

#include "io/files.h"
#include "kernels/error.h"
#include "tests/io/features.h"

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
    file.write_strings("names", {"one", "three", ""});
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
    EXPECT_EQ(in.dims("names"), (h5::Dims{3}));
    EXPECT_EQ(in.text("/", "title"), "a title");
    EXPECT_EQ(in.text("small", "empty"), "");
    EXPECT_EQ(in.number("g", "number"), 2.5);
    EXPECT_EQ(in.number("g", "count"), 12);
    EXPECT_TRUE(in.has("g/run"));
    EXPECT_FALSE(in.has("nothing"));
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
    write_text(file.path(), bytes);
    EXPECT_THROW(h5::Reader(file.path()).read<double>("noise"), IoError);
}

TEST(Files, TextIsWrittenWholeAndReadBack) {
    const test::TemporaryFile file("text.csv");
    write_text(file.path(), std::string("a\0b\n", 4));
    EXPECT_EQ(read_text(file.path()), std::string("a\0b\n", 4));
    write_text(file.path(), "short");
    EXPECT_EQ(read_text(file.path()), "short");
    EXPECT_THROW(read_text("no/such/file"), IoError);
    EXPECT_THROW(write_text("no/such/file", "x"), IoError);
}

}  // namespace
}  // namespace vfplan
