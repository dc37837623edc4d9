// The door to MPI: short notes between the processes of a job. Two sources implement it, mpi.cpp
// and no_mpi.cpp; the build takes one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vfplan {

struct Note {
    std::int64_t kind = 0;
    std::int64_t a = 0;
    std::int64_t b = 0;
    int from = 0;  // filled in by receive()
};

// At most one object in the life of a process, used by one thread at a time. Notes from one rank to
// another arrive in the order in which they were sent. What MPI cannot repair, it ends the job for.
class Mpi {
public:
    Mpi();   // MPI_Init_thread
    ~Mpi();  // MPI_Finalize: waits for all ranks
    Mpi(const Mpi&) = delete;
    Mpi& operator=(const Mpi&) = delete;

    int rank() const { return rank_; }
    int count() const { return count_; }
    void send(int to, const Note& note);
    std::optional<Note> receive();  // nothing, if nothing is there

    static bool built();
    static std::string name();

private:
    int rank_ = 0;
    int count_ = 1;
};

}  // namespace vfplan
