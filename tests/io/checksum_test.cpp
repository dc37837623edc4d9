// What was damaged is noticed before it is read.
#include "io/checksum.h"

#include <gtest/gtest.h>

#include <random>

#include "io/files.h"
#include "io/h5_reader.h"
#include "io/h5_writer.h"
#include "io/sha256.h"
#include "kernels/error.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

void write_sample(const std::filesystem::path& path) {
    h5::Writer file(path);
    file.write("run", std::vector<double>(3000, 0.25));
    file.write("small", std::vector<std::int32_t>{3, -1, 4});
    file.close();
}

// What the message of the IoError of f() is; empty when there is none.
template <class F>
std::string message_of_io_error(F&& f) {
    try {
        f();
    } catch (const IoError& e) {
        return e.what();
    }
    return "";
}

TEST(Checksum, AnyFlippedByteIsNoticedByName) {
    const test::TemporaryFile file("flipped.h5");
    write_sample(file.path());
    const std::string bytes = read_text(file.path());
    std::mt19937_64 random(1);
    std::vector<std::size_t> places = {0,
                                       1,
                                       8,
                                       100,
                                       bytes.size() - 1,
                                       bytes.size() - 2,
                                       bytes.size() - 79,
                                       bytes.size() - 80,
                                       bytes.size() - 81};
    for (int i = 0; i < 200; ++i) places.push_back(random() % bytes.size());
    for (const std::size_t place : places) {
        std::string damaged = bytes;
        damaged[place] = static_cast<char>(damaged[place] ^ (1 << random() % 8));
        test::overwrite(file.path(), damaged);
        const std::string message = message_of_io_error([&] { const h5::Reader in(file.path()); });
        EXPECT_NE(message.find("flipped.h5"), std::string::npos)
            << "byte " << place << " of " << bytes.size();
    }
    test::overwrite(file.path(), bytes);
    EXPECT_EQ(h5::Reader(file.path()).read<std::int32_t>("small").size(), 3U);
}

TEST(Checksum, ATruncatedOrLengthenedFileIsNoticedByName) {
    const test::TemporaryFile file("cut.h5");
    write_sample(file.path());
    const std::string bytes = read_text(file.path());
    std::vector<std::string> all;
    for (const std::size_t left :
         {std::size_t{0}, std::size_t{1}, std::size_t{79}, std::size_t{80}, std::size_t{81},
          bytes.size() / 2, bytes.size() - 81, bytes.size() - 80, bytes.size() - 1}) {
        all.push_back(bytes.substr(0, left));
    }
    all.push_back(bytes + "x");
    all.push_back(bytes + bytes.substr(bytes.size() - 80));
    for (const std::string& damaged : all) {
        test::overwrite(file.path(), damaged);
        EXPECT_NE(message_of_io_error([&] { const h5::Reader in(file.path()); }).find("cut.h5"),
                  std::string::npos)
            << damaged.size();
        EXPECT_NE(message_of_io_error([&] { checked_hash(file.path()); }).find("cut.h5"),
                  std::string::npos);
    }
}

TEST(Checksum, TheLastLineIsTheHashOfWhatIsBeforeIt) {
    const test::TemporaryFile file("hash.h5");
    write_sample(file.path());
    const std::string bytes = read_text(file.path());
    const std::string line = bytes.substr(bytes.size() - 80);
    EXPECT_EQ(line.substr(0, 15), "\nvfplan sha256 ");
    EXPECT_EQ(line.back(), '\n');
    EXPECT_EQ(line.substr(15, 64), checked_hash(file.path()));
    Sha256 hash;
    hash.add(bytes.data(), bytes.size() - 80);
    EXPECT_EQ(hash.hex(), line.substr(15, 64));
}

}  // namespace
}  // namespace vfplan
