#include "engine/joining/meetings.h"

#include <algorithm>

namespace vfplan {

Meetings::Meetings(const Window& window, std::int32_t reach_cells)
    : window_(window),
      reach_cells_(reach_cells),
      side_(std::max(1, reach_cells / 8)),
      columns_((window.x_end - window.x_begin + side_ - 1) / side_),
      rows_((window.y_end - window.y_begin + side_ - 1) / side_),
      meets_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), sees_nothing) {}

void Meetings::add(std::int32_t x, std::int32_t y, std::int32_t set) {
    std::int32_t& known = meets_[square(x, y)];
    known = seen_together(known, set);
}

void Meetings::find() {
    // What is seen from each place; then where anything is that is seen from one that sees several.
    std::vector<std::int32_t> sees = spread(meets_);
    for (std::int32_t& s : sees) {
        if (s != sees_several) s = sees_nothing;
    }
    meets_ = spread(sees);
}

std::vector<std::int32_t> Meetings::spread(const std::vector<std::int32_t>& squares) const {
    // Two cells within reach lie in squares whose centres are a diagonal farther apart at most.
    const double most = static_cast<double>(reach_cells_) / side_ + 1.4143;
    const auto far = static_cast<std::int32_t>(most);
    std::vector<std::pair<std::int32_t, std::int32_t>> around;
    for (std::int32_t dy = -far; dy <= far; ++dy) {
        for (std::int32_t dx = -far; dx <= far; ++dx) {
            if (dx * dx + dy * dy <= most * most) around.emplace_back(dx, dy);
        }
    }
    std::vector<std::int32_t> out(squares.size(), sees_nothing);
    std::size_t i = 0;
    for (std::int32_t y = 0; y < rows_; ++y) {
        for (std::int32_t x = 0; x < columns_; ++x, ++i) {
            if (squares[i] == sees_nothing) continue;
            for (const auto& [dx, dy] : around) {
                if (x + dx < 0 || x + dx >= columns_ || y + dy < 0 || y + dy >= rows_) continue;
                std::int32_t& known =
                    out[static_cast<std::size_t>(y + dy) * static_cast<std::size_t>(columns_) +
                        static_cast<std::size_t>(x + dx)];
                known = seen_together(known, squares[i]);
            }
        }
    }
    return out;
}

}  // namespace vfplan
