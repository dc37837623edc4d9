#include "io/h5_types.h"

#include <cstdlib>

namespace vfplan::h5 {

void be_quiet() {
    static const int once = [] {
        // One writes, then others read; and network file systems often cannot lock.
        setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
        return H5dont_atexit();
    }();
    thread_local const herr_t in_this_thread = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    (void)once;
    (void)in_this_thread;
}

}  // namespace vfplan::h5
