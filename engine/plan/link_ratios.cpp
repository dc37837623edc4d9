#include "engine/plan/link_ratios.h"

#include <algorithm>
#include <span>

#include "kernels/index.h"

namespace vfplan {
namespace {

// Angles of rows asked for in ascending order, fetched many rows at a time.
class AngleWindow {
public:
    AngleWindow(const OverlapRows& rows, const AngleSource& source)
        : rows_(rows), source_(source) {}

    std::span<const float> of(std::int32_t c) {
        const std::int64_t from = rows_.begin[idx(c)];
        const std::int64_t to = rows_.begin[idx(c) + 1];
        if (to > from_ + static_cast<std::int64_t>(angles_.size())) {
            // Whole rows, so that none is fetched twice; one at least, however long.
            const auto next = rows_.begin.begin() + c + 1;
            const auto end = std::upper_bound(next + 1, rows_.begin.end(), from + most) - 1;
            from_ = from;
            angles_ = {};
            angles_ = source_(from, *end - from);
        }
        return {angles_.data() + (from - from_), angles_.data() + (to - from_)};
    }

private:
    static constexpr std::int64_t most = std::int64_t{1} << 22;  // 16 MB
    const OverlapRows& rows_;
    const AngleSource& source_;
    std::int64_t from_ = 0;
    std::vector<float> angles_;
};

}  // namespace

void add_ratios(const PlanInput& in, const AngleSource& angles, Plan& plan) {
    // What two rows share, as seen from one end, needs that end's angles and both rows' pieces:
    // each candidate has its turn by itself.
    struct End {
        std::int32_t station;
        std::int32_t other;
        std::size_t link;
    };
    const auto row_of = [&](std::int32_t station) { return plan.stations[idx(station)].candidate; };
    const auto without_angles = [&](std::int32_t c) {
        return SeenRow{in.rows.row(c), {}, in.piece_length_m, true};
    };
    std::vector<End> ends;
    ends.reserve(2 * plan.links.size());
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        ends.push_back({plan.links[i].from, plan.links[i].to, i});
        ends.push_back({plan.links[i].to, plan.links[i].from, i});
    }
    std::sort(ends.begin(), ends.end(), [&](const End& a, const End& b) {
        return std::pair(row_of(a.station), a.link) < std::pair(row_of(b.station), b.link);
    });
    std::vector<SeenTotal> totals(plan.stations.size());
    std::vector<SeenJointly> joint(plan.links.size());
    AngleWindow window(in.rows, angles);
    std::int32_t last = -1;
    for (const End& e : ends) {
        const std::int32_t c = row_of(e.station);
        SeenRow row = without_angles(c);
        row.angle_rad = window.of(c);
        if (e.station != last) totals[idx(e.station)] = seen_total(row);
        last = e.station;
        const SeenJointly from_here = seen_jointly(row, without_angles(row_of(e.other)));
        SeenJointly& sum = joint[e.link];
        sum.length_m = from_here.length_m;  // the same from the other end
        (e.station == plan.links[e.link].from ? sum.angle_a_rad : sum.angle_b_rad) =
            from_here.angle_a_rad;
    }
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        Link& link = plan.links[i];
        for (const OverlapFormula& f : overlap_ratios) {
            link.ratios[static_cast<std::size_t>(f.ratio)] =
                f.of(totals[idx(link.from)], totals[idx(link.to)], joint[i]);
        }
    }
}

}  // namespace vfplan
