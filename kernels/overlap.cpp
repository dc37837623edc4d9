#include "kernels/overlap.h"

#include <algorithm>

namespace vfplan {

SeenTotal seen_total(const Pieces& pieces, const Seen* begin, const Seen* end) {
    SeenTotal total;
    for (const Seen* s = begin; s != end; ++s) {
        total.length_m += pieces.length_m(s->piece);
        total.angle_rad += static_cast<double>(s->angle_rad);
    }
    return total;
}

SeenJointly seen_jointly(const Pieces& pieces, const Seen* a, const Seen* a_end, const Seen* b,
                         const Seen* b_end) {
    SeenJointly joint;
    while (a != a_end && b != b_end) {
        if (a->piece < b->piece) {
            ++a;
        } else if (b->piece < a->piece) {
            ++b;
        } else {
            joint.length_m += pieces.length_m(a->piece);
            joint.angle_a_rad += static_cast<double>(a->angle_rad);
            joint.angle_b_rad += static_cast<double>(b->angle_rad);
            ++a;
            ++b;
        }
    }
    return joint;
}

double overlap(OverlapRatio ratio, const SeenTotal& a, const SeenTotal& b,
               const SeenJointly& joint) {
    const auto over = [](double part, double whole) { return whole > 0 ? part / whole : 0.0; };
    switch (ratio) {
        case OverlapRatio::min_len:
            return over(joint.length_m, std::min(a.length_m, b.length_m));
        case OverlapRatio::mean_len:
            return over(2 * joint.length_m, a.length_m + b.length_m);
        case OverlapRatio::union_len:
            return over(joint.length_m, a.length_m + b.length_m - joint.length_m);
        case OverlapRatio::union_ang:
            return over(joint.angle_a_rad + joint.angle_b_rad, a.angle_rad + b.angle_rad);
        case OverlapRatio::mean_ang:
            return over(joint.angle_a_rad, 2 * a.angle_rad) +
                   over(joint.angle_b_rad, 2 * b.angle_rad);
    }
    return 0;
}

double overlap(OverlapRatio ratio, const Pieces& pieces, const CoverageRow& a,
               const CoverageRow& b) {
    const Seen* a_end = a.data() + a.size();
    const Seen* b_end = b.data() + b.size();
    return overlap(ratio, seen_total(pieces, a.data(), a_end), seen_total(pieces, b.data(), b_end),
                   seen_jointly(pieces, a.data(), a_end, b.data(), b_end));
}

OverlapRow overlap_row(std::vector<SeenLength> seen) {
    OverlapRow row{std::move(seen), {}};
    for (const SeenLength& s : row.seen) {
        row.total.length_m += s.length_m;
        row.total.angle_rad += static_cast<double>(s.angle_rad);
    }
    return row;
}

double overlap(OverlapRatio ratio, const OverlapRow& a, const OverlapRow& b) {
    SeenJointly joint;
    for (auto i = a.seen.begin(), k = b.seen.begin(); i != a.seen.end() && k != b.seen.end();) {
        if (i->piece < k->piece) {
            ++i;
        } else if (k->piece < i->piece) {
            ++k;
        } else {
            joint.length_m += i->length_m;
            joint.angle_a_rad += static_cast<double>(i->angle_rad);
            joint.angle_b_rad += static_cast<double>(k->angle_rad);
            ++i;
            ++k;
        }
    }
    return overlap(ratio, a.total, b.total, joint);
}

}  // namespace vfplan
