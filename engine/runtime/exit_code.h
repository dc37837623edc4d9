// What an exception means for the program's end.
#pragma once

#include <exception>
#include <string>

namespace vfplan {

struct Ending {
    int code = 0;
    std::string message;  // without "vfplan: "; empty: another rank prints it
};

// Thread-safe.
Ending ending_of(const std::exception_ptr& error);

// Prints the message, if there is one, to standard error; where that cannot be written, nobody can
// be told.
void tell(const Ending& ending);

}  // namespace vfplan
