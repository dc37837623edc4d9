#include "program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

namespace vfplan::test {
namespace {

struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
};
using File = std::unique_ptr<std::FILE, Closer>;

std::string text_of(std::FILE* file) {
    std::string text;
    std::rewind(file);
    char part[4096];
    while (const std::size_t n = std::fread(part, 1, sizeof part, file)) text.append(part, n);
    return text;
}

void shift(Json& coordinates, double dx, double dy) {
    if (!coordinates.empty() && coordinates[0].is_number()) {
        coordinates[0] = coordinates[0].get<double>() + dx;
        coordinates[1] = coordinates[1].get<double>() + dy;
        return;
    }
    for (Json& c : coordinates) shift(c, dx, dy);
}

// At commas outside of quotes; without a carriage return.
std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> words(1);
    bool quoted = false;
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
        } else if (c == ',' && !quoted) {
            words.emplace_back();
        } else if (c != '\r') {
            words.back() += c;
        }
    }
    return words;
}

}  // namespace

Scratch::Scratch() {
    static std::atomic<int> count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("vfplan_e2e_" + std::to_string(getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
}

Scratch::~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string Scratch::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this / name;
}

std::vector<std::string> Scratch::names() const {
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path_)) {
        out.push_back(entry.path().lexically_relative(path_).string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

namespace {

// `meanwhile(pid)` is called while the program runs.
template <class F>
Output run_beside(const std::string& name, const Words& words, const Environment& environment,
                  F&& meanwhile) {
    const File out(std::tmpfile());
    const File err(std::tmpfile());
    std::vector<char*> argv = {const_cast<char*>(name.c_str())};
    for (const std::string& w : words) argv.push_back(const_cast<char*>(w.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        dup2(fileno(out.get()), STDOUT_FILENO);
        dup2(fileno(err.get()), STDERR_FILENO);
        for (const auto& [key, value] : environment) setenv(key.c_str(), value.c_str(), 1);
        execvp(name.c_str(), argv.data());
        _exit(127);
    }
    meanwhile(child);
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out.get()),
            text_of(err.get())};
}

}  // namespace

Output run_program(const std::string& name, const Words& words, const Environment& environment) {
    return run_beside(name, words, environment, [](pid_t) {});
}

Output vfplan_signalled(int signal, double after_s, const Words& words) {
    return run_beside(VFPLAN_BINARY, words, {}, [&](pid_t child) {
        std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
        kill(child, signal);  // a child that has ended is not yet waited for, so this is safe
    });
}

Output vfplan_process(const Words& words, const Environment& environment) {
    return run_program(VFPLAN_BINARY, words, environment);
}

Output vfplan_expect(int code, const Words& words, const Environment& environment) {
    Output o = vfplan_process(words, environment);
    std::string line = "vfplan";
    for (const std::string& w : words) line += " '" + w + "'";
    EXPECT_EQ(o.code, code) << line << "\n" << o.out << o.err;
    return o;
}

Words with_sets(Words all, const std::vector<std::string>& sets) {
    for (const std::string& s : sets) {
        all.emplace_back("--set");
        all.push_back(s);
    }
    return all;
}

std::string read_bytes(const Path& file) {
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in.good()) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

Json read_json(const Path& file) {
    try {
        return Json::parse(read_bytes(file));
    } catch (const Json::parse_error& e) {
        ADD_FAILURE() << file << ": " << e.what();
        return Json::object();
    }
}

std::vector<std::string> Csv::column(const std::string& name) const {
    const auto at = std::find(header.begin(), header.end(), name);
    EXPECT_NE(at, header.end()) << "no column " << name;
    std::vector<std::string> out;
    if (at == header.end()) return out;
    const auto i = static_cast<std::size_t>(at - header.begin());
    for (const auto& row : rows) out.push_back(i < row.size() ? row[i] : "");
    return out;
}

std::vector<double> Csv::numbers(const std::string& name) const {
    std::vector<double> out;
    for (const std::string& s : column(name)) {
        char* end = nullptr;
        out.push_back(std::strtod(s.c_str(), &end));
        EXPECT_TRUE(!s.empty() && *end == '\0') << name << ": no number: " << s;
    }
    return out;
}

std::map<std::string, std::int64_t> Csv::counts(const std::string& name) const {
    std::map<std::string, std::int64_t> out;
    for (const std::string& s : column(name)) ++out[s];
    return out;
}

Csv read_csv(const Path& file) {
    std::istringstream in(read_bytes(file));
    Csv csv;
    std::string line;
    if (std::getline(in, line)) csv.header = split(line);
    while (std::getline(in, line)) {
        csv.rows.push_back(split(line));
        EXPECT_EQ(csv.rows.back().size(), csv.header.size()) << file << ": " << line;
    }
    return csv;
}

std::map<std::string, std::string> lasting_bytes(const Path& dir) {
    std::map<std::string, std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
        const std::string kind = entry.path().extension();
        if (kind == ".h5" || kind == ".csv" || kind == ".geojson") {
            out[entry.path().lexically_relative(dir).string()] = read_bytes(entry.path());
        }
    }
    return out;
}

void expect_same_bytes(const Path& a, const Path& b) {
    const auto one = lasting_bytes(a);
    const auto two = lasting_bytes(b);
    EXPECT_FALSE(one.empty()) << a;
    std::string differ;
    for (const auto& [name, bytes] : one) {
        const auto other = two.find(name);
        if (other == two.end() || other->second != bytes) differ += " " + name;
    }
    EXPECT_TRUE(differ.empty() && one.size() == two.size())
        << a << " and " << b << " (" << one.size() << " and " << two.size()
        << " files) differ in:" << differ;
}

void expect_same_run(const Path& a, const Path& b) {
    const auto files_in = [](const Path& dir) {
        std::map<std::string, std::string> out;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(dir)) {
            const std::string name = entry.path().lexically_relative(dir).string();
            if (entry.is_directory()) {
                out[name] = "folder";
            } else if (name != "summary.json" && name != "provenance.json") {
                out[name] = read_bytes(entry.path());
            }
        }
        return out;
    };
    const auto one = files_in(a);
    const auto two = files_in(b);
    std::string differ;
    for (const auto& [name, bytes] : one) {
        const auto other = two.find(name);
        if (other == two.end() || other->second != bytes) differ += " " + name;
    }
    for (const auto& [name, bytes] : two) {
        if (!one.contains(name)) differ += " " + name;
    }
    EXPECT_TRUE(differ.empty()) << a << " and " << b << " differ in:" << differ;
    EXPECT_EQ(read_json(a / "summary.json")["result_sha256"],
              read_json(b / "summary.json")["result_sha256"]);
}

void flip_a_bit(const Path& file, double where) {
    std::string bytes = read_bytes(file);
    const auto i = static_cast<std::size_t>(where * static_cast<double>(bytes.size() - 1));
    bytes[i] = static_cast<char>(bytes[i] ^ 1);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

std::string geojson(const Features& features) {
    std::string out = R"({"type":"FeatureCollection","features":[)";
    for (std::size_t i = 0; i < features.size(); ++i) {
        const auto& [cls, type, coordinates] = features[i];
        out += fmt::format(
            R"({}{{"type":"Feature","properties":{{"class":"{}"}},"geometry":{{"type":"{}","coordinates":{}}}}})",
            i > 0 ? "," : "", cls, type, coordinates);
    }
    return out + "]}";
}

std::string generated(const Scratch& scratch, const std::string& kind, const Words& more) {
    const std::string file = scratch / (kind + ".geojson");
    Words words = {"generate", kind, "--out", file};
    words.insert(words.end(), more.begin(), more.end());
    vfplan_expect(0, words);
    return file;
}

std::string config_file(const std::string& name) {
    return (Path(VFPLAN_SOURCE_DIR) / "configs" / name).string();
}

std::string data_file(const std::string& name) { return (data_dir() / name).string(); }

std::string shifted(const std::string& geojson, double dx, double dy) {
    Json j = Json::parse(geojson);
    for (Json& feature : j["features"]) shift(feature["geometry"]["coordinates"], dx, dy);
    return j.dump();
}

}  // namespace vfplan::test
