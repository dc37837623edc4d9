// What the program writes to a terminal and to standard output, and what it does when it cannot.
#include <algorithm>

#include "program.h"

namespace vfplan::test {
namespace {

const std::string site =
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
    R"({"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,0]]]}}]})";

bool escapes(const std::string& text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f;
    });
}

// The program in a shell, where `line` follows its name.
Output in_shell(const std::string& line) {
    return run_program("bash", {"-c", std::string(VFPLAN_BINARY) + " " + line});
}

TEST(Messages, NamesOfFilesMoveNoCursor) {
    const Scratch scratch;
    const std::string name = "evil\x1b[2J\x07.geojson";
    const std::string file = scratch.write(name, "Dear reader,\n");
    const Output refused = vfplan_expect(3, {"run", file, "--out", scratch / "out"});
    EXPECT_FALSE(escapes(refused.err)) << refused.err;
    EXPECT_NE(refused.err.find("evil\\x1b[2J\\x07.geojson"), std::string::npos) << refused.err;
    scratch.write(name, site);
    const Output looked = vfplan_expect(0, {"inspect", file, "--out", scratch / "a\x1b]0;b.png"});
    EXPECT_FALSE(escapes(looked.out + looked.err)) << looked.out << looked.err;
    EXPECT_TRUE(std::filesystem::exists(scratch / "a\x1b]0;b.png"));
}

TEST(Messages, OutputThatCannotBeWrittenIsAnError) {
    const Scratch scratch;
    scratch.write("site.geojson", site);
    const std::string job =
        scratch.write("job.toml", "[site]\ninput = \"site.geojson\"\n[field]\ncell_m = 1\n");
    const std::string out = scratch / "out";
    for (const std::string& line :
         {std::string("generate town"), "submit '" + job + "' --print", std::string("parameters"),
          std::string("--help"), std::string("--version"), "run '" + job + "' --out '" + out + "'",
          "plan '" + out + "'", "verify '" + out + "'",
          "run '" + job + "' --dry-run --out '" + out + "2'",
          "inspect '" + job + "' --out '" + scratch / "a.png" + "'"}) {
        const Output o = in_shell(line + " > /dev/full");
        EXPECT_EQ(o.code, 4) << line << "\n" << o.err;
        EXPECT_NE(o.err.find("standard output"), std::string::npos) << line << "\n" << o.err;
        EXPECT_NE(o.err.find("disk is full"), std::string::npos) << line << "\n" << o.err;
        EXPECT_EQ(o.err.find("bug"), std::string::npos) << line << "\n" << o.err;
    }
    vfplan_expect(0, {"verify", out});  // the files were written before
    EXPECT_EQ(in_shell("run '" + job + "' -q --out '" + out + "' > /dev/full").code, 0);
}

TEST(Messages, JobFilesThatAreNone) {
    const Scratch scratch;
    std::string deep;
    for (int i = 0; i < 50000; ++i) deep += "a.";
    const Output keys = vfplan_expect(
        2, {"run", scratch.write("deep.toml", deep + "a = 1"), "--out", scratch / "q"});
    EXPECT_NE(keys.err.find("deep.toml:1:"), std::string::npos) << keys.err;
    EXPECT_LT(keys.err.size(), 400U);
    std::filesystem::resize_file(scratch.write("large.toml", ""), 20'000'000);
    const Output large = vfplan_expect(2, {"run", scratch / "large.toml", "--out", scratch / "q"});
    EXPECT_NE(large.err.find("16 MB"), std::string::npos) << large.err;
    std::filesystem::create_symlink("/dev/zero", scratch / "zero.toml");
    const Output device = vfplan_expect(2, {"run", scratch / "zero.toml", "--out", scratch / "q"});
    EXPECT_NE(device.err.find("a device"), std::string::npos) << device.err;
}

}  // namespace
}  // namespace vfplan::test
