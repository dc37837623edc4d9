// What GDAL and PROJ may reach besides the file that they are given. A site from elsewhere must not
// make the program call other machines, or open other files, unless the user says so.
#pragma once

#include <string>

namespace vfplan {

// Closes the network to GDAL and PROJ in the whole process, but for threads in which a Reach opens
// it: no URL is fetched, and file names such as /vsicurl/... or /vsis3/... lead nowhere. PROJ's
// grids are never fetched: where a site lies must not depend on the day. Once is enough;
// thread-safe.
void close_the_network();

// Opens or closes the network to the thread it is made in, while it lives; then all is as before.
class Reach {
public:
    explicit Reach(bool network);
    ~Reach();
    Reach(const Reach&) = delete;
    Reach& operator=(const Reach&) = delete;

    // In this thread, since the youngest Reach was made: the first name on the network that was
    // asked for and refused, and whether any service was asked. A file that is read through
    // /vsicurl/ and the like is none.
    static const std::string& refused();
    static bool asked_a_service();

    struct State;

private:
    State* outer_;
};

}  // namespace vfplan
