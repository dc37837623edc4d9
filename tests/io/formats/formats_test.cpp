// Drawings, and what is no site.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "tests/io/formats/files.h"

namespace vfplan {
namespace {

using test::expect_words;
using test::indoor;
using test::reading_says;
using test::TemporaryFile;

TEST(Formats, DxfBlocksAndSplinesThroughPoints) {
    const auto groups = [](std::initializer_list<std::pair<int, std::string>> list) {
        std::string out;
        for (const auto& [code, value] : list) out += fmt::format("{:3d}\r\n{}\r\n", code, value);
        return out;
    };
    const std::string dxf =
        groups({{0, "SECTION"}, {2, "HEADER"}, {9, "$INSUNITS"}, {70, "6"}, {0, "ENDSEC"}}) +
        groups({{0, "SECTION"},
                {2, "BLOCKS"},
                {0, "BLOCK"},
                {8, "0"},
                {2, "COL"},
                {70, "0"},
                {10, "0"},
                {20, "0"},
                {3, "COL"},
                {0, "LINE"},
                {8, "WALL"},
                {10, "0"},
                {20, "0"},
                {11, "1"},
                {21, "0"},
                {0, "ENDBLK"},
                {8, "0"},
                {0, "ENDSEC"}}) +
        groups({{0, "SECTION"},
                {2, "ENTITIES"},
                {0, "INSERT"},
                {8, "WALL"},
                {2, "COL"},
                {10, "5"},
                {20, "5"},
                {41, "2"},
                {50, "90"},
                // A quarter of a circle of 4 m by five points.
                {0, "SPLINE"},
                {8, "WALL"},
                {100, "AcDbSpline"},
                {70, "8"},
                {71, "3"},
                {74, "5"},
                {11, "4"},
                {21, "0"},
                {11, "3.69551813"},
                {21, "1.53073373"},
                {11, "2.82842712"},
                {21, "2.82842712"},
                {11, "1.53073373"},
                {21, "3.69551813"},
                {11, "0"},
                {21, "4"},
                {0, "LINE"},
                {8, "WALL"},
                {10, "0"},
                {20, "4"},
                {11, "0"},
                {21, "0"},
                {0, "LINE"},
                {8, "WALL"},
                {10, "0"},
                {20, "0"},
                {11, "4"},
                {21, "0"},
                {0, "ENDSEC"},
                {0, "EOF"}});
    const TemporaryFile file("curves.dxf", dxf);
    const FeatureSet set = read_features(file.path(), indoor());
    double on_circle = 0;
    bool inserted = false;
    for (const Feature& f : set.features) {
        EXPECT_EQ(f.role, Role::wall);
        for (const Line& line : f.lines) {
            if (line.size() > 10) {
                for (const Vec2d& v : line) on_circle = std::max(on_circle, std::abs(v.norm() - 4));
                EXPECT_EQ(line.size(), 4U * 16 + 1);
            }
            if ((line.front() - Vec2d(5, 5)).norm() < 1e-9) {
                inserted = (line.back() - Vec2d(5, 7)).norm() < 1e-9;
            }
        }
    }
    EXPECT_TRUE(inserted);
    EXPECT_GT(on_circle, 0);
    EXPECT_LT(on_circle, 0.01);
    EXPECT_NEAR(read_site(file.path(), indoor()).site.area_m2, M_PI * 4, 0.05);
}

TEST(Formats, WhatIsNoSiteIsNamed) {
    expect_words(reading_says("model.ifc", "ISO-10303-21;\nHEADER;\n"), {"IFC", "IfcConvert"});
    expect_words(reading_says("plan.dwg", "AC1032\x01\x02"), {"DWG", "DXF"});
    expect_words(reading_says("plan.pdf", "%PDF-1.7\n"), {"PDF"});
    expect_words(reading_says("poem.txt", "once upon a time"), {"not a site", "docs/formats.md"});
    ReadOptions where;
    where.where = "a = 1";
    const TemporaryFile pol("g.pol", "3 0/1 0/1 1/1 0/1 0/1 1/1\n");
    EXPECT_THROW(read_features(pol.path(), where), UsageError);
    where.where.clear();
    where.layer = "walls";
    EXPECT_THROW(read_features(pol.path(), where), InputError);
}

}  // namespace
}  // namespace vfplan
