// What messages say.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vfplan::test {

// Fails for every word that a text lacks.
inline void expect_words(const std::string& text, const std::vector<std::string>& words) {
    for (const std::string& w : words) {
        EXPECT_NE(text.find(w), std::string::npos) << "no \"" << w << "\" in: " << text;
    }
}

// What an error of type E says that f() throws.
template <class E, class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const E& e) {
        return e.what();
    }
    return "no error";
}

}  // namespace vfplan::test
