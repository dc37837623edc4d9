// The built program as a person runs it: a process, a scratch folder, and the files it leaves.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../data.h"

namespace vfplan::test {

using Path = std::filesystem::path;
using Json = nlohmann::ordered_json;

// A folder that is removed with everything in it.
class Scratch {
public:
    Scratch();
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    const Path& path() const { return path_; }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    // Writes a file and returns its path.
    std::string write(const std::string& name, const std::string& text) const;
    // Relative paths of all files and folders in it, sorted.
    std::vector<std::string> names() const;

private:
    Path path_;
};

struct Output {
    int code = -1;  // exit code; 128 + signal number when it was killed
    std::string out;
    std::string err;
};

using Words = std::vector<std::string>;
using Environment = std::map<std::string, std::string>;

// Runs `vfplan words...` and waits. `environment` comes on top of this process's own.
Output vfplan_process(const Words& words, const Environment& environment = {});
// The same; the test fails with the program's words when the exit code is another.
Output vfplan_expect(int code, const Words& words, const Environment& environment = {});
// Any program of the machine; code 127 when there is none of that name.
Output run_program(const std::string& name, const Words& words,
                   const Environment& environment = {});

// Starts `vfplan words...`, sends it a signal after `after_s` seconds unless it has ended by then,
// and waits.
Output vfplan_signalled(int signal, double after_s, const Words& words);

// `all` and then `--set key=value` for each of `sets`.
Words with_sets(Words all, const std::vector<std::string>& sets);

std::string read_bytes(const Path& file);
Json read_json(const Path& file);

struct Csv {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;

    std::vector<std::string> column(const std::string& name) const;
    std::vector<double> numbers(const std::string& name) const;
    std::map<std::string, std::int64_t> counts(const std::string& name) const;
};
Csv read_csv(const Path& file);

// Relative names of the .h5, .csv and .geojson files in a run directory and their bytes.
std::map<std::string, std::string> lasting_bytes(const Path& dir);
// Fails for every file that the two folders do not share byte for byte.
void expect_same_bytes(const Path& a, const Path& b);
// The same for every file but summary.json and provenance.json, which hold times and the machine;
// and the same result by summary.json.
void expect_same_run(const Path& a, const Path& b);
// Changes one bit of the byte at this share of a file's length.
void flip_a_bit(const Path& file, double where);

// Writes a generated site into the scratch folder; returns its path.
std::string generated(const Scratch& scratch, const std::string& kind, const Words& more = {});
// A job file of the repository.
std::string config_file(const std::string& name);
std::string data_file(const std::string& name);
// Class, type of geometry and coordinates of each feature.
using Features = std::vector<std::array<std::string, 3>>;
std::string geojson(const Features& features);
// Moves every coordinate of a GeoJSON text.
std::string shifted(const std::string& geojson, double dx, double dy);

}  // namespace vfplan::test
