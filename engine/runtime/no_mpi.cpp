// The door to MPI where there is none: one process.
#include <cassert>

#include "engine/runtime/mpi.h"

namespace vfplan {

Mpi::Mpi() = default;
Mpi::~Mpi() = default;

void Mpi::send(int, const Note&) { assert(false); }
std::optional<Note> Mpi::receive() { return std::nullopt; }
bool Mpi::built() { return false; }
std::string Mpi::name() { return "without MPI"; }

}  // namespace vfplan
