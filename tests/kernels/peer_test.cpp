// The exact kernel against CGAL's own triangular expansion, and the ray kernel against the exact
// one, on real sites.
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arr_walk_along_line_point_location.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangular_expansion_visibility_2.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "io/site_reader.h"
#include "kernels/free_cells.h"
#include "tests/data.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

struct SiteCase {
    const char* path;
    SiteKind kind;
};

void PrintTo(const SiteCase& test, std::ostream* out) { *out << test.path; }

// The paper's presets.
struct Preset {
    Scanner scanner;
    double partition_m;
    double cell_m;
};
Preset preset(SiteKind kind) {
    if (kind == SiteKind::outdoor) return {{0.6, 600, 90}, 5, 2};
    return {{0.6, 30, 90}, 0.1, 0.25};
}

std::string name_of(const testing::TestParamInfo<SiteCase>& test) {
    std::string name = std::filesystem::path(test.param.path).stem().string();
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    return name;
}

Site load(const SiteCase& test) {
    SiteOptions options;
    options.kind = test.kind;
    options.invalid = InvalidPolygons::repair;
    return read_site(test::data_dir() / test.path, options).site;
}

// Centres of free cells, chosen at random but the same ones each time.
std::vector<Vec2d> sample(const Site& site, double cell_m, std::size_t count) {
    const Grid grid = make_grid(site.extent, cell_m, 0.001);
    const auto free = free_cells(grid, site.free_region);
    std::mt19937_64 random(7);
    std::vector<Vec2d> out;
    for (std::size_t tries = 0; out.size() < count && tries < 1000 * count; ++tries) {
        const auto c = static_cast<std::int64_t>(random() % free.size());
        if (free[static_cast<std::size_t>(c)] != 0) out.push_back(grid.centre(c));
    }
    return out;
}

using K = CGAL::Exact_predicates_exact_constructions_kernel;
using Arrangement = CGAL::Arrangement_2<CGAL::Arr_segment_traits_2<K>>;
using Expansion = CGAL::Triangular_expansion_visibility_2<Arrangement, CGAL::Tag_true>;

// Walls in a large square, so that every face is bounded.
class Peer {
public:
    Peer(const std::vector<Wall>& walls, const Box& around) {
        const double margin = 3 * around.size().norm();
        lo_ = around.min - Vec2d(margin, margin);
        hi_ = around.max + Vec2d(margin, margin);
        std::vector<K::Segment_2> segments;
        for (const Wall& w : walls) segments.emplace_back(point(w.a), point(w.b));
        for (const Wall& w : test::rectangle(lo_, hi_)) {
            segments.emplace_back(point(w.a), point(w.b));
        }
        CGAL::insert_non_intersecting_curves(arrangement_, segments.begin(), segments.end());
        location_.attach(arrangement_);
        expansion_.attach(arrangement_);
    }

    // 2 pi less the angle through which the square shows.
    double vf(const Vec2d& eye) const {
        const auto where = location_.locate(point(eye));
        const auto* face = boost::get<Arrangement::Face_const_handle>(&where);
        if (face == nullptr) ADD_FAILURE() << "eye on a wall";
        if (face == nullptr) return 0;
        Arrangement seen;
        expansion_.compute_visibility(point(eye), *face, seen);
        double outside = 0;
        for (auto e = seen.edges_begin(); e != seen.edges_end(); ++e) {
            const K::Point_2& p = e->source()->point();
            const K::Point_2& q = e->target()->point();
            if (!on_square(p, q)) continue;
            const double a = angle_between_rad(vec(p) - eye, vec(q) - eye);
            outside += std::min(a, 2 * pi - a);
        }
        return 2 * pi - outside;
    }

private:
    static K::Point_2 point(const Vec2d& p) { return {p.x(), p.y()}; }
    static Vec2d vec(const K::Point_2& p) {
        return {CGAL::to_double(p.x()), CGAL::to_double(p.y())};
    }
    bool on_square(const K::Point_2& p, const K::Point_2& q) const {  // exactly
        return (p.x() == lo_.x() && q.x() == lo_.x()) || (p.x() == hi_.x() && q.x() == hi_.x()) ||
               (p.y() == lo_.y() && q.y() == lo_.y()) || (p.y() == hi_.y() && q.y() == hi_.y());
    }

    Vec2d lo_;
    Vec2d hi_;
    Arrangement arrangement_;
    CGAL::Arr_walk_along_line_point_location<Arrangement> location_;
    Expansion expansion_;
};

class ExactAgainstCgal : public testing::TestWithParam<SiteCase> {};

INSTANTIATE_TEST_SUITE_P(
    Sites, ExactAgainstCgal,
    testing::Values(SiteCase{"town_bellevue/bellevue_976x893.geojson", SiteKind::outdoor},
                    SiteCase{"town_bellevue/bellevue_b_976x893.geojson", SiteKind::outdoor},
                    SiteCase{"town_karhula/karhula_976x893.geojson", SiteKind::outdoor},
                    SiteCase{"town_helsinki_centre/helsinki_centre_full.geojson",
                             SiteKind::outdoor},
                    SiteCase{"plan_houseexpo/houseexpo_0a1b29db.geojson", SiteKind::indoor},
                    SiteCase{"plan_house_overland/house_overland.geojson", SiteKind::indoor},
                    SiteCase{"plans_offices_schools/office_off_2.geojson", SiteKind::indoor},
                    SiteCase{"plans_offices_schools/office_village.geojson", SiteKind::indoor},
                    SiteCase{"plans_offices_schools/office_magenta.geojson", SiteKind::indoor},
                    SiteCase{"plans_offices_schools/school_franch1.geojson", SiteKind::indoor},
                    SiteCase{"plans_offices_schools/school_vipiteno1.geojson", SiteKind::indoor}),
    name_of);

TEST_P(ExactAgainstCgal, SeesTheSameAngle) {
    VFPLAN_NEED_DATA(GetParam().path);
    Site site = load(GetParam());
    for (Wall& w : site.walls) w.scanned = true;
    const Peer peer(site.walls, site.extent);
    const ExactScene scene(site.walls, site.extent, 1e6);
    double worst = 0;
    for (const Vec2d& eye : sample(site, preset(GetParam().kind).cell_m, 40)) {
        const double vf = view_angle_rad(test::look(scene, site.walls, {0, 1e6, 90}, eye));
        const double want = peer.vf(eye);
        EXPECT_NEAR(vf, want, 1e-9) << "eye at " << eye.transpose();
        worst = std::max(worst, std::abs(vf - want));
    }
    std::printf("largest difference to CGAL %.2e rad\n", worst);
    RecordProperty("max_error_rad", std::to_string(worst));
}

class RaysAgainstExact : public testing::TestWithParam<SiteCase> {};

INSTANTIATE_TEST_SUITE_P(
    Sites, RaysAgainstExact,
    testing::Values(
        SiteCase{"town_bellevue/bellevue_976x893.geojson", SiteKind::outdoor},
        SiteCase{"town_bellevue/bellevue_b_976x893.geojson", SiteKind::outdoor},
        SiteCase{"town_bellevue/bellevue_full.geojson", SiteKind::outdoor},
        SiteCase{"town_karhula/karhula_976x893.geojson", SiteKind::outdoor},
        SiteCase{"town_karhula/karhula_full.geojson", SiteKind::outdoor},
        SiteCase{"town_helsinki_centre/helsinki_centre_full.geojson", SiteKind::outdoor},
        SiteCase{"town_monaco/monaco_full.geojson", SiteKind::outdoor},
        SiteCase{"town_delft/delft_full.geojson", SiteKind::outdoor},
        SiteCase{"town_bubenec/bubenec_full.geojson", SiteKind::outdoor},
        SiteCase{"city_allegheny/allegheny_core_5km.geojson", SiteKind::outdoor},
        SiteCase{"plan_arlington_school/arlington_school.geojson", SiteKind::indoor},
        SiteCase{"plan_house_overland/house_overland.geojson", SiteKind::indoor},
        SiteCase{"plan_houseexpo/houseexpo_0a1b29db.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_324_elm_furn_plan.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_37s_floorplan_big.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_atlanticsuites.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_milano_1.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_off_2.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_officeplan.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_pinecondos.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_village.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_executive_a622d60b.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_floorplanlower.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/office_magenta.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_borchen4.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_franch1.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_histor4.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_liselotte1.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_neulengbach1.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_romainroland2.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_skf_floorplan.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_sabadell3.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_valleceppi_p0.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_vipiteno1.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_hendersonhighschool.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_rockislandgroundfloor.geojson", SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_stjoseph_scatholichighschool.geojson",
                 SiteKind::indoor},
        SiteCase{"plans_offices_schools/school_wilbraham.geojson", SiteKind::indoor}),
    name_of);

TEST_P(RaysAgainstExact, ErrorIsSmall) {
    VFPLAN_NEED_DATA(GetParam().path);
    const Site site = load(GetParam());
    const auto [scanner, partition_m, cell_m] = preset(GetParam().kind);
    const int rays = default_rays(scanner.range_max_m, partition_m);
    const ExactScene exact(site.walls, site.extent, scanner.range_max_m);
    const EmbreeScene embree(site.walls, site.extent, scanner.range_max_m, rays);
    const bool town = std::string(GetParam().path).ends_with("bellevue_976x893.geojson");
    const std::vector<Vec2d> eyes = sample(site, cell_m, town ? 2000 : 400);
    ASSERT_FALSE(eyes.empty());
    double sum = 0;
    double worst = 0;
    double total = 0;
    for (const Vec2d& eye : eyes) {
        const double want = view_angle_rad(test::look(exact, site.walls, scanner, eye));
        const double got = view_angle_rad(test::look(embree, site.walls, scanner, eye));
        EXPECT_LE(want, 2 * pi + 1e-9);
        EXPECT_LE(got, 2 * pi + 1e-6);
        sum += std::abs(got - want);
        worst = std::max(worst, std::abs(got - want));
        total += want;
    }
    const auto n = static_cast<double>(eyes.size());
    std::printf("%-36s %5zu eyes %4d rays: mean error %.2e, max %.2e rad, mean VF %.2f\n",
                std::filesystem::path(GetParam().path).stem().c_str(), eyes.size(), rays, sum / n,
                worst, total / n);
    RecordProperty("mean_error_rad", std::to_string(sum / n));
    RecordProperty("max_error_rad", std::to_string(worst));
    EXPECT_GT(total / n, 0.5);
    EXPECT_LE(sum / n, 5e-3);
}

}  // namespace
}  // namespace vfplan
