// What a process may run into, in one place: each ends it with words and exit code 4, whatever
// library met it.
#pragma once

#include <string>

namespace vfplan {

// To be called first in main(). From now on
//  - a write beyond the largest file (ulimit -f) is an error, not a signal;
//  - memory that C libraries ask for and do not get, in pieces that they do not look at, ends the
//    process; C++ gets bad_alloc as ever, and large pieces are refused as ever, which libraries
//    look at. Builds with sanitizers have an allocator of their own and leave this out;
//  - what leaves a thread as an exception (bad_alloc, no more threads) ends it with code 4 or 70;
//  - where memory has a limit (ulimit -v), the stack of the main thread has its room already.
void meet_limits();

// Throws IoError when so many threads cannot be started. Looks once at each number.
void check_threads(int count);

// What to tell where memory gave out.
std::string out_of_memory_text();

}  // namespace vfplan
