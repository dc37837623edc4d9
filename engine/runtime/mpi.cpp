#include "engine/runtime/mpi.h"

// The C interface only.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <array>

#include "kernels/error.h"

namespace vfplan {

Mpi::Mpi() {
    int granted = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &granted);
    if (granted < MPI_THREAD_SERIALIZED) {
        MPI_Finalize();
        throw UsageError(name() +
                         " does not allow calls from several threads, which vfplan needs; use an "
                         "MPI that was built with thread support");
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
}

Mpi::~Mpi() { MPI_Finalize(); }

// Three numbers always fit into what MPI sends without waiting for the receiver.
void Mpi::send(int to, const Note& note) {
    const std::array<std::int64_t, 3> numbers = {note.kind, note.a, note.b};
    MPI_Send(numbers.data(), 3, MPI_INT64_T, to, 0, MPI_COMM_WORLD);
}

std::optional<Note> Mpi::receive() {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return std::nullopt;
    std::array<std::int64_t, 3> numbers{};
    MPI_Recv(numbers.data(), 3, MPI_INT64_T, status.MPI_SOURCE, 0, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    return Note{numbers[0], numbers[1], numbers[2], status.MPI_SOURCE};
}

bool Mpi::built() { return true; }

std::string Mpi::name() {
    std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
    int length = 0;
    MPI_Get_library_version(text.data(), &length);
    const std::string all(text.data());
    // "Open MPI v4.1.4, package: ...", "MPICH Version:      4.0.2\n..."
    return all.substr(0, all.find_first_of(",\n"));
}

}  // namespace vfplan
