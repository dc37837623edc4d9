#include "engine/generate/generate.h"

#include "engine/generate/city.h"
#include "engine/generate/drawing.h"
#include "engine/generate/flat.h"
#include "engine/generate/town.h"
#include "kernels/error.h"

namespace vfplan {

GenerateReport generate_site(const GenerateOptions& options) {
    if (options.kind == "town") return generate::town(options.seed);
    if (options.kind == "city") {
        if (!(options.size_km >= 0.5 && options.size_km <= 60)) {
            throw UsageError("size_km = " + generate::fixed(options.size_km, 3) +
                             ": a generated city measures 0.5 to 60 km a side; choose a size "
                             "between these");
        }
        return generate::city(options.seed, options.size_km);
    }
    if (options.kind == "flat") {
        if (options.rooms < 2 || options.rooms > 200) {
            throw UsageError("rooms = " + std::to_string(options.rooms) +
                             ": a generated flat has 2 to 200 rooms; choose a number between "
                             "these");
        }
        return generate::flat(options.seed, options.rooms);
    }
    throw UsageError("unknown kind of site \"" + options.kind +
                     "\": there are town, city and flat; use one of these");
}

}  // namespace vfplan
