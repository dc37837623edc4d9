// A picture of figures side by side: a row for each plan, a column of bars for each figure.
#pragma once

#include <string>
#include <vector>

namespace vfplan {

struct Bars {
    std::string title;
    std::vector<double> value;      // of each row, the bar's length; NaN: none
    std::vector<double> mark = {};  // of each row, or empty: a line at this value; NaN: none
    std::vector<std::string> text;  // of each row, written behind the bar
};

// PNG. Bars of a column begin at 0 and have one scale. REQUIRES: as many of everything in a column
// as there are names, no value below 0. IoError when it cannot be drawn.
std::string bars_png(const std::string& title, const std::vector<std::string>& names,
                     const std::vector<Bars>& columns);

}  // namespace vfplan
