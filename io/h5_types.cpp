#include "io/h5_types.h"

#include <cstdlib>
#include <string_view>

namespace vfplan::h5 {

void be_quiet() {
    static const int once = [] {
        // One writes, then others read; and network file systems often cannot lock.
        setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);
        H5dont_atexit();  // before all else of the library
        return H5PLset_loading_state(0);
    }();
    thread_local const herr_t in_this_thread = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    (void)once;
    (void)in_this_thread;
}

int system_error() {
    int found = 0;
    const auto look = [](unsigned, const H5E_error2_t* e, void* to) -> herr_t {
        constexpr std::string_view label = "errno = ";
        const std::string_view text = e->desc == nullptr ? "" : e->desc;
        const auto at = text.find(label);
        if (at != std::string_view::npos) {
            *static_cast<int*>(to) = std::atoi(text.data() + at + label.size());
        }
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &found);
    return found;
}

}  // namespace vfplan::h5
