// VF of many eyes at once: triangular expansion with one eye per SIMD lane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/expansion.h"
#include "kernels/view.h"

namespace vfplan {

// The cones still to be followed; reused from call to call, grows as needed.
struct PacketStack {
    struct Cone {
        Behind behind;
        std::uint32_t lanes;      // one bit per eye that looks through this cone
        double right_x, right_y;  // ends of the edge, relative to the eyes' middle
        double left_x, left_y;
    };
    std::vector<Cone> cones;
    std::vector<double> borders;  // per cone and lane: the border rays right x, y, left x, y
};

// vf_rad[i] = VF(x[i], y[i]), eq. 4 and 5, for eyes that all stand in `triangle`.
//  (1) each value depends on its own eye only: the same bits for any grouping and instruction set
//  (2) equals view_angle_rad(observe(...)) but for rounding: angles are summed per unbroken run
// Thread-safe; each thread brings its own stack.
void packet_angles(const Expansion& expansion, const std::vector<Wall>& walls,
                   const Scanner& scanner, std::int32_t triangle, const double* x, const double* y,
                   std::size_t count, double* vf_rad, PacketStack& stack, FieldCounts& counts);

// See limit_isa(). REQUIRES: one of its names.
void limit_packet_isa(const std::string& isa);

}  // namespace vfplan
