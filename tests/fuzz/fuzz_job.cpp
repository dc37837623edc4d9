// Any bytes as a job file: a configuration or an Error, and a configuration that is written reads
// as the same again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "engine/config/config.h"
#include "kernels/error.h"

// Called by libFuzzer for each input; whatever it throws or ends with is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vfplan;
    const std::string text(reinterpret_cast<const char*>(data), size);
    std::string written;
    try {
        written = to_toml(parse_config(text, "job.toml", "/jobs", {}));
    } catch (const Error&) {
        return 0;
    }
    if (to_toml(parse_config(written, "again.toml", "/elsewhere", {})) != written) std::abort();
    // As a value of --set, too.
    try {
        parse_config("site.input = \"a\"\n", "job.toml", "/jobs", {"site.layer=" + text});
    } catch (const Error&) {
        return 0;
    }
    return 0;
}
