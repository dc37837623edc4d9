#include <malloc.h>

#include "engine/cli/cli.h"
#include "engine/runtime/limits.h"

int main(int argc, char** argv) {
    vfplan::meet_limits();
    // Rasters and rows of a tile go back to the system when the tile is done. Left to itself, the
    // allocator learns to keep such blocks, and memory grows with the number of tiles.
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    return vfplan::run_cli(argc, argv);
}
