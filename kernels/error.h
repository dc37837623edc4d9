// Bad input, in one form: the problem, why it is one, what to do. Bugs are asserts instead.
#pragma once

#include <stdexcept>
#include <string>

namespace vfplan {

// Exit codes of the program (docs/cli.md).
enum class Exit : int { done = 0, usage = 2, input = 3, io = 4, stopped = 75 };

class Error : public std::runtime_error {
public:
    Error(Exit code, const std::string& message) : std::runtime_error(message), code_(code) {}
    Exit code() const { return code_; }

private:
    Exit code_;
};

// The configuration or the command line is wrong.
struct UsageError : Error {
    explicit UsageError(const std::string& m) : Error(Exit::usage, m) {}
};
// The site's data are wrong.
struct InputError : Error {
    explicit InputError(const std::string& m) : Error(Exit::input, m) {}
};
// The machine would not read or write.
struct IoError : Error {
    explicit IoError(const std::string& m) : Error(Exit::io, m) {}
};

}  // namespace vfplan
