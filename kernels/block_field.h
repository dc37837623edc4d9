// VF of a block of neighbouring cells from rays (eq. 4, 5).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/ray_tracer.h"
#include "kernels/view.h"

namespace vfplan {

// Which walls share an end. End 2 w is walls[w].a, end 2 w + 1 is walls[w].b.
class WallEnds {
public:
    explicit WallEnds(const std::vector<Wall>& walls);
    // The next end at the same point, round and round; the end itself where it stands alone.
    std::int32_t next(std::int32_t end) const { return next_[static_cast<std::size_t>(end)]; }

private:
    std::vector<std::int32_t> next_;
};

// Casts every direction for all eyes at once, then looks at where the first wall changes from one
// ray to the next. A wall that is observed there reaches to its ends or to where the scanner's
// range cuts it; where the stretches of two neighbouring rays meet or overlap, nothing can hide
// between them that would not be observed in its turn; so it is where a wall's neighbour goes on
// from its end. Rays are added only into the gaps that remain, past the ends that border them,
// until what they meet closes the gap or is not observed.
//
// Each eye looks along its own directions, turned a little against its neighbours', so that the
// block as a whole looks 16 times closer. What one eye meets, in range from end to end, the others
// observe too or something before it: walls between two of their rays that met nothing count.
//
// That whatever stands nearer is observed in its turn does not hold for walls that are not scanned,
// nearer than range_min or met too obliquely: they are known where rays meet them.
//
// What it may miss is thinner than the block's directions are apart, or than one eye's where no
// other eye meets it.
class BlockField {
public:
    // `directions`: unit vectors counter-clockwise once round, evenly spread: 16 for each ray that
    // an eye casts, at least 256. Refers to all of its arguments.
    BlockField(const std::vector<Wall>& walls, const WallEnds& ends, const Scanner& scanner,
               const std::vector<Vec2d>& directions, RayTracer& tracer);

    // vf_rad[i] = VF(eyes[i]) for i < count, 0 < count <= 16.
    void angles(const PerRay<Vec2d>& eyes, std::size_t count, PerRay<double>& vf_rad,
                FieldCounts& counts);

private:
    // What an eye observes of a wall around one direction: from `from` counter-clockwise to `to`,
    // both relative to the eye.
    struct Stretch {
        bool observed = false;
        std::int32_t from_end = -1;  // the wall's end that lies there; -1 where the range cuts it
        std::int32_t to_end = -1;
        Vec2d from{0, 0};
        Vec2d to{0, 0};
    };
    // Consecutive rays of one eye that meet the same wall, or none.
    struct Run {
        std::int32_t wall = -1;
        std::int32_t first = 0;  // index of the first ray
        bool whole = false;      // the wall is observed from end to end
        bool mixed = false;      // the wall is observed in parts
        Stretch at_end;          // what is observed at the first ray; after end_run(), at the last
    };
    // An interval of directions not known to be observed, right behind (before) something that is
    // where `open_from` (`open_to`) says so.
    struct Gap {
        std::uint32_t eye;
        std::int32_t ray;       // it lies between rays `ray` - 1 and `ray`
        bool open_from;         // `from` is the end of something observed; look past it
        bool open_to;           // `to` is the beginning of something observed; look before it
        std::int32_t occluder;  // the wall met at the other border, not observed; -1 for none
        Vec2d from;
        Vec2d to;
        bool closed = false;
    };

    bool whole(std::int32_t wall, const Vec2d& eye, Stretch& out) const;
    Stretch stretch(std::int32_t wall, const Vec2d& eye, const Vec2d& direction, bool& mixed);
    void extend_to(Stretch& s, const Vec2d& eye, const Vec2d& enough) const;
    void extend_from(Stretch& s, const Vec2d& eye, const Vec2d& enough) const;
    void cut_into_parts(std::int32_t wall, const Vec2d& eye);
    void begin_run(std::int32_t wall, std::int32_t ray, std::uint32_t eye, Run& run);
    void end_run(Run& run, std::int32_t last, std::uint32_t eye);
    void between_runs(std::uint32_t eye, std::int32_t ray, const Run& run, const Run& next);
    const Vec2d& direction(std::int32_t ray, std::uint32_t eye) const;
    double uncovered_rad(std::uint32_t eye, std::int32_t ray, const Vec2d& a, const Vec2d& b);
    void look_into_sky(std::int32_t ray, std::uint32_t all);
    void look_at_rays();
    void follow_gaps(FieldCounts& counts);
    void past_from(Gap& gap, std::int32_t wall, const Vec2d& direction);
    void before_to(Gap& gap, std::int32_t wall, const Vec2d& direction);

    const std::vector<Wall>& walls_;
    const WallEnds& ends_;
    const Scanner& scanner_;
    const std::vector<Vec2d>& directions_;
    RayTracer& tracer_;
    double tan_limit_;
    double max2_;  // squares of the scanner's range
    double min2_;
    std::int32_t rays_;  // per eye
    double step_rad_;

    PerRay<Vec2d> eyes_;
    std::size_t count_ = 0;
    PerRay<double> unobserved_rad_{};
    std::vector<PerRay<std::int32_t>> met_;
    std::vector<Gap> gaps_;
    std::vector<Stretch> in_sky_;
    std::vector<Stretch> parts_;  // of the wall last cut
    View one_wall_;
    View observed_;
};

}  // namespace vfplan
