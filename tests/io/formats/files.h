// Files of many formats, for their readers' tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "io/formats/read_features.h"
#include "kernels/error.h"
#include "tests/io/site/features.h"
#include "tests/words.h"

namespace vfplan::test {

inline double area_m2(const Polygon& p) {
    const auto of = [](const Ring& r) {
        double sum = 0;
        for (std::size_t i = 0; i < r.size(); ++i) sum += cross(r[i], r[(i + 1) % r.size()]);
        return std::abs(sum) / 2;
    };
    double sum = of(p.outer);
    for (const Ring& hole : p.holes) sum -= of(hole);
    return sum;
}

// What reading a file of such a text says; bad input ends with its own code.
inline std::string reading_says(const std::string& name, const std::string& text,
                                const ReadOptions& options = {}) {
    const TemporaryFile file(name, text);
    try {
        read_features(file.path(), options);
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::input);
        return e.what();
    }
    return "no error";
}

}  // namespace vfplan::test
