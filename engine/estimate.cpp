#include "engine/estimate.h"

namespace vfplan {

std::string estimate_text(const Config&, const Threads&, Progress&) { return ""; }

}  // namespace vfplan
