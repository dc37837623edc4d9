#include "engine/config/options.h"

#include "engine/config/config.h"
#include "kernels/embree_scene.h"

namespace vfplan {
namespace {

OverlapRule overlap_rule(const Config& c) { return {c.overlap.ratio, c.overlap.threshold}; }

}  // namespace

GroundOptions ground_options(const Config& c) {
    GroundOptions o;
    o.input = c.site.input;
    o.site.kind = c.site.kind;
    o.site.layer = c.site.layer;
    o.site.where = c.site.where;
    o.site.roles = c.site.roles;
    o.site.osm_parts = c.site.osm_parts;
    o.site.osm_barriers = c.site.osm_barriers;
    o.site.crs = c.site.crs;
    o.site.allow_network = c.site.allow_network;
    o.site.unit_m = c.site.unit_m;
    o.site.snap_m = c.site.snap_m;
    o.site.margin_m = c.site.margin_m;
    o.site.crop_m = c.site.crop_m;
    o.site.doors = c.site.doors;
    o.site.windows = c.site.windows;
    o.site.invalid = c.site.invalid;
    o.site.max_opening_m = c.site.max_opening_m;
    o.site.min_width_m = c.site.min_width_m;
    o.site.min_room_m2 = c.site.min_room_m2;
    o.site.max_gap_m2 = c.site.max_gap_m2;
    o.forbidden = c.plan.forbidden;
    o.required = c.plan.required;
    o.existing = c.plan.existing;
    o.clearance_m = c.site.clearance_m;
    o.cell_m = c.field.cell_m;
    o.tile_cells = c.field.tile_cells;
    o.range_max_m = c.scanner.range_max_m;
    o.partition_m = c.coverage.partition_m;
    return o;
}

SceneOptions scene_options(const Config& c) {
    SceneOptions o;
    o.scanner = {c.scanner.range_min_m, c.scanner.range_max_m, c.scanner.max_incidence_deg};
    o.kernel = c.visibility.kernel;
    o.rays = c.visibility.rays > 0 ? static_cast<int>(c.visibility.rays)
                                   : default_rays(c.scanner.range_max_m, c.coverage.partition_m);
    o.more_rays = c.visibility.rays == 0;
    o.visible_fraction = c.coverage.visible_fraction;
    o.partition_m = c.coverage.partition_m;
    return o;
}

TableOptions table_options(const Config& c) {
    TableOptions out{
        scene_options(c), c.field.tile_cells, c.field.threshold_rad, overlap_rule(c), {}, {}, {}};
    if (c.plan.candidates == CandidatePool::pool) {
        out.pool = {c.plan.pool_tried, c.plan.pool_taken, out.scenes, c.site.snap_m};
    }
    return out;
}

PlanOptions plan_options(const Config& c) {
    const bool survive = c.plan.survive > 0;
    return {c.plan.method,       c.plan.loops || survive, overlap_rule(c),      c.plan.effort,
            c.plan.proof_effort, c.plan.candidates,       c.plan.min_spacing_m, survive,
            c.plan.shortcuts};
}

}  // namespace vfplan
