#include "io/exports/vector_writer.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "io/files.h"
#include "io/tables/coverage_file.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// One GeoPackage being written; a failure of any call ends in an IoError.
class Package {
public:
    Package(const std::filesystem::path& file, const std::string& crs_wkt) : file_(file) {
        GDALAllRegister();
        CPLSetConfigOption("OGR_CURRENT_DATE", "2000-01-01T00:00:00.000Z");  // equal bytes
        CPLPushErrorHandler(CPLQuietErrorHandler);
        set_ = GDALCreate(GDALGetDriverByName("GPKG"), file.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
        // Without a CRS the coordinates are plain metres, which the format knows by this name.
        srs_ = OSRNewSpatialReference(crs_wkt.empty()
                                          ? R"(LOCAL_CS["Undefined Cartesian SRS",UNIT["metre",1]])"
                                          : crs_wkt.c_str());
        check(set_ != nullptr);
    }
    ~Package() {
        if (set_ != nullptr) GDALClose(set_);
        if (srs_ != nullptr) OSRRelease(srs_);
        CPLPopErrorHandler();
        CPLSetConfigOption("OGR_CURRENT_DATE", nullptr);
    }
    Package(const Package&) = delete;
    Package& operator=(const Package&) = delete;

    // With a spatial index, for programs that show a part, unless there are so many features that
    // it would take four times as long as they do.
    void layer(const char* name, OGRwkbGeometryType type, std::size_t features) {
        constexpr std::size_t indexed_most = 1'000'000;
        char none[] = "SPATIAL_INDEX=NO";
        std::array<char*, 2> options = {features > indexed_most ? none : nullptr, nullptr};
        layer_ = GDALDatasetCreateLayer(set_, name, srs_, type, options.data());
        check(layer_ != nullptr);
        check(GDALDatasetStartTransaction(set_, 0) == OGRERR_NONE);
    }
    void field(const char* name, OGRFieldType type) {
        const OGRFieldDefnH f = OGR_Fld_Create(name, type);
        check(OGR_L_CreateField(layer_, f, 1) == OGRERR_NONE);
        OGR_Fld_Destroy(f);
    }
    // `fill` sets the fields by number.
    template <class F>
    void feature(const std::vector<Vec2d>& points, F&& fill) {
        const OGRGeometryH g = OGR_G_CreateGeometry(points.size() == 1 ? wkbPoint : wkbLineString);
        for (const Vec2d& p : points) OGR_G_AddPoint_2D(g, p.x(), p.y());
        const OGRFeatureH f = OGR_F_Create(OGR_L_GetLayerDefn(layer_));
        OGR_F_SetGeometryDirectly(f, g);
        fill(f);
        const bool good = OGR_L_CreateFeature(layer_, f) == OGRERR_NONE;
        OGR_F_Destroy(f);
        check(good);
    }
    void commit() { check(GDALDatasetCommitTransaction(set_) == OGRERR_NONE); }
    void close() {
        CPLErrorReset();
        GDALClose(set_);
        set_ = nullptr;
        check(CPLGetLastErrorType() < CE_Failure);
    }

private:
    void check(bool good) const {
        if (good) return;
        throw IoError(fmt::format("{}: cannot write the GeoPackage: {}; check free space",
                                  file_.string(), CPLGetLastErrorMsg()));
    }

    std::filesystem::path file_;
    GDALDatasetH set_ = nullptr;
    OGRSpatialReferenceH srs_ = nullptr;
    OGRLayerH layer_ = nullptr;
};

void write_layers(Package& out, const CoverageTables& t, const Plan& plan, bool all_pieces) {
    const auto point = [&](std::size_t station) -> Vec2d {
        return t.origin + t.candidates[idx(plan.stations[station].candidate)].at;
    };
    out.layer("stations", wkbPoint, plan.stations.size());
    out.field("id", OFTInteger);
    out.field("component", OFTInteger);
    out.field("order", OFTInteger);
    out.field("new_length_m", OFTReal);
    out.field("seen_length_m", OFTReal);
    out.field("kind", OFTString);
    out.field("only_length_m", OFTReal);
    out.field("articulation", OFTInteger);
    out.field("bridge_end", OFTInteger);
    out.field("needed_overlap", OFTReal);
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const Station& s = plan.stations[i];
        out.feature({point(i)}, [&](OGRFeatureH f) {
            OGR_F_SetFieldInteger(f, 0, static_cast<int>(i));
            OGR_F_SetFieldInteger(f, 1, s.network);
            OGR_F_SetFieldInteger(f, 2, s.order);
            OGR_F_SetFieldDouble(f, 3, s.new_length_m);
            OGR_F_SetFieldDouble(f, 4, s.seen_length_m);
            OGR_F_SetFieldString(f, 5,
                                 std::string(name_of(t.candidates[idx(s.candidate)].kind)).c_str());
            OGR_F_SetFieldDouble(f, 6, s.only_length_m);
            OGR_F_SetFieldInteger(f, 7, s.articulation ? 1 : 0);
            OGR_F_SetFieldInteger(f, 8, s.bridge_end ? 1 : 0);
            OGR_F_SetFieldDouble(f, 9, s.needed_overlap);
        });
    }
    out.commit();
    out.layer("links", wkbLineString, plan.links.size());
    out.field("from", OFTInteger);
    out.field("to", OFTInteger);
    out.field("overlap", OFTReal);
    for (const Link& l : plan.links) {
        out.feature({point(idx(l.from)), point(idx(l.to))}, [&](OGRFeatureH f) {
            OGR_F_SetFieldInteger(f, 0, l.from);
            OGR_F_SetFieldInteger(f, 1, l.to);
            OGR_F_SetFieldDouble(f, 2, l.overlap);
        });
    }
    out.commit();
    const auto covered = std::count(plan.pieces.begin(), plan.pieces.end(), PieceStatus::covered);
    out.layer("pieces", wkbLineString,
              plan.pieces.size() - (all_pieces ? 0 : static_cast<std::size_t>(covered)));
    out.field("id", OFTInteger);
    out.field("length_m", OFTReal);
    out.field("status", OFTString);
    for (std::size_t p = 0; p < plan.pieces.size(); ++p) {
        if (!all_pieces && plan.pieces[p] == PieceStatus::covered) continue;
        const Pieces::Place place = t.pieces.place(static_cast<std::int64_t>(p));
        const Wall& wall = t.walls[idx(place.wall)];
        const Vec2d a = t.origin + wall.at(place.s0_m);
        const Vec2d b = t.origin + wall.at(place.s1_m);
        out.feature({a, b}, [&](OGRFeatureH f) {
            OGR_F_SetFieldInteger(f, 0, static_cast<int>(p));
            OGR_F_SetFieldDouble(f, 1, place.s1_m - place.s0_m);
            OGR_F_SetFieldString(f, 2, std::string(name_of(plan.pieces[p])).c_str());
        });
    }
    out.commit();
}

}  // namespace

void write_gpkg(const std::filesystem::path& file, const Results& results) {
    Aside aside(file, true);  // SQLite keeps journals beside the file while it writes
    Package out(aside.path(), results.tables.crs_wkt);
    write_layers(out, results.tables, results.plan, results.all_pieces);
    out.close();
    aside.publish();
}

}  // namespace vfplan
