// The exact kernel against CGAL's own triangular expansion, and the ray kernel against the exact
// one, on real sites.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "bench/peers/cgal_expansion.h"
#include "bench/peers/rotational_sweep.h"
#include "io/site/site_reader.h"
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
    const auto free = free_cells(grid, site.free_border);
    std::mt19937_64 random(7);
    std::vector<Vec2d> out;
    for (std::size_t tries = 0; out.size() < count && tries < 1000 * count; ++tries) {
        const auto c = static_cast<std::int64_t>(random() % free.size());
        if (free[static_cast<std::size_t>(c)] != 0) out.push_back(grid.centre(c));
    }
    return out;
}

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
    peers::CgalExpansion peer(site.walls, site.extent);
    const double far_m = 3 * site.extent.size().norm();  // the peer's square lies beyond
    const ExactScene scene(site.walls, site.extent, far_m);
    std::vector<double> packets;
    const std::vector<Vec2d> eyes = sample(site, preset(GetParam().kind).cell_m, 40);
    for (const Scanner& scanner : {Scanner{0, far_m, 90}, preset(GetParam().kind).scanner}) {
        scene.angles(scanner, eyes, packets);
        const peers::RotationalSweep sweep(site.walls);
        double worst = 0;
        for (std::size_t i = 0; i < eyes.size(); ++i) {
            peer.stand_at(eyes[i]);
            const double want = peer.vf_rad(eyes[i], scanner);
            const double vf = view_angle_rad(test::look(scene, site.walls, scanner, eyes[i]));
            EXPECT_NEAR(vf, want, 1e-9) << "eye at " << eyes[i].transpose();
            EXPECT_NEAR(packets[i], want, 1e-9) << "eye at " << eyes[i].transpose();
            EXPECT_NEAR(sweep.vf_rad(eyes[i], scanner), want, 1e-9);
            worst = std::max({worst, std::abs(vf - want), std::abs(packets[i] - want)});
        }
        std::printf("range %g m: largest difference to CGAL %.2e rad\n", scanner.range_max_m,
                    worst);
    }
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
    const Grid grid = make_grid(site.extent, cell_m, 0.001);
    const auto free = free_cells(grid, site.free_border);
    // Windows at random, the same ones each time.
    std::mt19937_64 random(7);
    Raster<float> want(free.size(), -1.0F);
    Raster<float> got(free.size(), -1.0F);
    std::int64_t seen = 0;
    const auto begin = [&](std::int32_t n) {
        return 4 * static_cast<std::int32_t>(random() % static_cast<std::uint64_t>((n + 3) / 4));
    };
    for (int tries = 0; tries < 100000 && seen < 20000; ++tries) {
        const std::int32_t x = begin(grid.nx);
        const std::int32_t y = begin(grid.ny);
        const Window w{x, y, std::min(x + 4, grid.nx), std::min(y + 4, grid.ny)};
        seen += exact.field(scanner, grid, w, free, want).cells;
        embree.field(scanner, grid, w, free, got);
    }
    ASSERT_GT(seen, 0);
    std::vector<double> error;
    double sum = 0;
    double total = 0;
    for (std::size_t i = 0; i < want.size(); ++i) {
        if (want[i] < 0) continue;
        EXPECT_LE(got[i], 6.2832F);
        error.push_back(std::abs(static_cast<double>(got[i]) - static_cast<double>(want[i])));
        sum += error.back();
        total += static_cast<double>(want[i]);
    }
    std::sort(error.begin(), error.end());
    const double worst = error.back();
    const double p999 = error[error.size() * 999 / 1000];
    const auto n = static_cast<double>(error.size());
    std::printf(
        "%-36s %5zu cells %4d rays: mean error %.2e, 99.9 %% %.2e, max %.2e rad, mean VF %.2f\n",
        std::filesystem::path(GetParam().path).stem().c_str(), error.size(), rays, sum / n, p999,
        worst, total / n);
    RecordProperty("mean_error_rad", std::to_string(sum / n));
    RecordProperty("max_error_rad", std::to_string(worst));
    EXPECT_GT(total / n, 0.5);
    EXPECT_LE(sum / n, 1.5e-3);
    EXPECT_LE(p999, 5e-2);
}

}  // namespace
}  // namespace vfplan
