// Fields and views, this project's and its peers', on the same cells of the same site, one thread.
// Ours and the sweep verify a part of their answers before they are timed; CGAL is what the exact
// field is verified against, and bare rays have no answer. A benchmark's time is that of its whole
// sample; `s_per_cell` (SI prefixes) is what to compare, and the counters say how much work that
// was.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "bench/peers/cgal_expansion.h"
#include "bench/peers/embree_quads.h"
#include "bench/peers/rotational_sweep.h"
#include "bench/scenes.h"
#include "kernels/angle.h"
#include "kernels/embree_scene.h"
#include "kernels/exact_scene.h"
#include "kernels/index.h"

namespace vfplan::bench {
namespace {

constexpr int field_every = 5;  // a fifth of the windows
constexpr std::size_t eyes_of_views = 2000;
constexpr std::size_t eyes_of_cgal = 300;

std::vector<Vec2d> spread(const std::vector<Vec2d>& all, std::size_t count) {
    std::vector<Vec2d> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(all[i * all.size() / count]);
    return out;
}

struct Sample {
    const Scene* scene = nullptr;
    std::vector<Window> windows;
    std::vector<Vec2d> eyes;
    Raster<float> exact;  // of the windows' cells

    explicit Sample(const std::string& name) : scene(bench::scene(name)) {
        if (scene == nullptr) return;
        windows = sample_windows(*scene, field_every);
        eyes = eyes_in(*scene, windows);
        exact = run(ExactScene(scene->walls(), scene->extent(), scene->scanner().range_max_m));
    }
    Raster<float> run(const ViewKernel& kernel, FieldCounts* counts = nullptr) const {
        Raster<float> vf(idx(scene->grid().size()), std::nanf(""));
        for (const Window& w : windows) {
            const FieldCounts c =
                kernel.field(scene->scanner(), scene->grid(), w, scene->standable, vf);
            if (counts != nullptr) *counts += c;
        }
        return vf;
    }
};

// One per site; nullptr and a skipped benchmark without its data.
const Sample* sample(benchmark::State& state, const std::string& name) {
    static std::map<std::string, std::unique_ptr<Sample>> made;
    auto& s = made[name];
    if (!s) s = std::make_unique<Sample>(name);
    if (s->scene == nullptr) state.SkipWithError("no data folder: set VFPLAN_DATA");
    return s->scene == nullptr ? nullptr : s.get();
}

void per_cell(benchmark::State& state, std::int64_t cells) {
    state.counters["cells"] = static_cast<double>(cells);
    state.counters["s_per_cell"] = benchmark::Counter(
        static_cast<double>(cells),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

struct Error {
    double mean = 0;
    double p999 = 0;
    double worst = 0;
};
Error error_of(const Raster<float>& got, const Raster<float>& want) {
    std::vector<double> error;
    for (std::size_t i = 0; i < got.size(); ++i) {
        if (!std::isnan(want[i])) {
            error.push_back(std::abs(static_cast<double>(got[i]) - static_cast<double>(want[i])));
        }
    }
    std::sort(error.begin(), error.end());
    Error e;
    for (const double d : error) e.mean += d / static_cast<double>(error.size());
    e.p999 = error[error.size() * 999 / 1000];
    e.worst = error.back();
    return e;
}

void report(benchmark::State& state, const Error& e) {
    state.counters["error_mean"] = e.mean;
    state.counters["error_p999"] = e.p999;
    state.counters["error_max"] = e.worst;
}

// The exact field; checked in double precision against CGAL.
void exact_field(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    const ExactScene scene(s->scene->walls(), s->scene->extent(), s->scene->scanner().range_max_m);
    const std::vector<Vec2d> eyes = spread(s->eyes, 100);
    std::vector<double> got;
    scene.angles(s->scene->scanner(), eyes, got);
    peers::CgalExpansion cgal(s->scene->walls(), s->scene->extent());
    Error e;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        cgal.stand_at(eyes[i]);
        e.worst = std::max(e.worst, std::abs(got[i] - cgal.vf_rad(eyes[i], s->scene->scanner())));
    }
    if (!(e.worst <= 1e-9)) return state.SkipWithError("differs from CGAL by more than 1e-9 rad");
    FieldCounts counts;
    s->run(scene, &counts);
    for (auto _ : state) benchmark::DoNotOptimize(s->run(scene));
    per_cell(state, counts.cells);
    state.counters["error_max"] = e.worst;
    state.counters["packets"] = static_cast<double>(counts.packets);
    state.counters["steps"] = static_cast<double>(counts.steps);
    state.counters["walls"] = static_cast<double>(counts.walls);
}

void embree_field(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    const int rays = state.range(0) > 0 ? static_cast<int>(state.range(0))
                                        : scene_options(s->scene->config).rays;
    const EmbreeScene scene(s->scene->walls(), s->scene->extent(), s->scene->scanner().range_max_m,
                            rays);
    FieldCounts counts;
    const Error e = error_of(s->run(scene, &counts), s->exact);
    if (rays >= scene_options(s->scene->config).rays && !(e.mean <= 1.5e-3 && e.p999 <= 5e-2)) {
        return state.SkipWithError("farther from exact than 1.5e-3 rad or, for 0.1 %, 5e-2 rad");
    }
    for (auto _ : state) benchmark::DoNotOptimize(s->run(scene));
    per_cell(state, counts.cells);
    report(state, e);
    state.counters["rays_first"] = rays;
    state.counters["rays_per_cell"] =
        static_cast<double>(counts.steps) / static_cast<double>(counts.cells);
    state.counters["rays"] = static_cast<double>(counts.steps);
    state.counters["packets"] = static_cast<double>(counts.packets);
    state.counters["rays_per_s"] = benchmark::Counter(
        static_cast<double>(counts.steps), benchmark::Counter::kIsIterationInvariantRate);
}

// 4 x 4 cells as the ray kernel groups them.
std::vector<std::vector<Vec2d>> blocks(const Sample& s) {
    std::vector<std::vector<Vec2d>> out;
    for (const Window& w : s.windows) {
        for (std::int32_t y = w.y_begin; y < w.y_end; y += window_step) {
            for (std::int32_t x = w.x_begin; x < w.x_end; x += window_step) {
                out.push_back(eyes_in(*s.scene, {{x, y, std::min(x + window_step, w.x_end),
                                                  std::min(y + window_step, w.y_end)}}));
                if (out.back().empty()) out.pop_back();
            }
        }
    }
    return out;
}

void per_ray(benchmark::State& state, const std::vector<std::vector<Vec2d>>& groups, double rays) {
    std::int64_t cells = 0;
    for (const auto& eyes : groups) cells += static_cast<std::int64_t>(eyes.size());
    per_cell(state, cells);
    state.counters["rays_per_cell"] = rays;
    state.counters["rays_per_s"] = benchmark::Counter(
        rays * static_cast<double>(cells), benchmark::Counter::kIsIterationInvariantRate);
}

// As many rays per cell as embree_field casts in all (rounded up), in the kernel's own packets
// and with its own wall test, and nothing done with the answers.
void bare_packets(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    const int first = state.range(0) > 0 ? static_cast<int>(state.range(0))
                                         : scene_options(s->scene->config).rays;
    const EmbreeScene scene(s->scene->walls(), s->scene->extent(), s->scene->scanner().range_max_m,
                            first);
    FieldCounts counts;
    s->run(scene, &counts);
    const auto rays = static_cast<std::size_t>((counts.steps + counts.cells - 1) / counts.cells);
    const std::vector<Vec2d> circle = circle_directions(1 << 14);
    std::vector<Vec2d> directions;  // 16 neighbouring ones for each ray
    for (std::size_t r = 0; r < rays; ++r) {
        for (std::size_t k = 0; k < packet_rays; ++k) {
            directions.push_back(
                circle[(packet_rays * r + k) * circle.size() / (packet_rays * rays)]);
        }
    }
    const auto groups = blocks(*s);
    const auto tracer = scene.tracer();
    PerRay<std::int32_t> wall{};
    for (auto _ : state) {
        for (const auto& group : groups) {
            PerRay<Vec2d> eyes;
            eyes.fill(group.front());
            std::copy(group.begin(), group.end(), eyes.begin());
            tracer->set_eyes(eyes, group.size());
            for (std::size_t r = 0; r < rays; ++r) {
                tracer->along(&directions[packet_rays * r], wall);
                benchmark::DoNotOptimize(wall);
            }
        }
    }
    per_ray(state, groups, static_cast<double>(rays));
}

// The same with Embree's own quads.
void bare_quads(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    const int rays = static_cast<int>(state.range(0));
    const peers::EmbreeQuads quads(s->scene->walls(), s->scene->extent(),
                                   s->scene->scanner().range_max_m);
    const auto groups = blocks(*s);
    for (auto _ : state) {
        for (const auto& group : groups) benchmark::DoNotOptimize(quads.cast(group, rays));
    }
    per_ray(state, groups, rays);
}

// Whole views with their spans, as candidates need them: one eye after the other.
void exact_views(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    const ExactScene scene(s->scene->walls(), s->scene->extent(), s->scene->scanner().range_max_m);
    const std::vector<Vec2d> eyes = spread(s->eyes, eyes_of_views);
    std::vector<double> want;
    scene.angles(s->scene->scanner(), eyes, want);
    View hits;
    View seen;
    std::int64_t spans = 0;
    double worst = 0;
    const auto look = [&](const Vec2d& eye) {
        scene.first_hits(eye, hits);
        observe(s->scene->walls(), s->scene->scanner(), eye, hits, seen);
    };
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        look(eyes[i]);
        spans += static_cast<std::int64_t>(seen.size());
        worst = std::max(worst, std::abs(view_angle_rad(seen) - want[i]));
    }
    if (!(worst <= 1e-9)) return state.SkipWithError("spans do not add up to the field");
    for (auto _ : state) {
        for (const Vec2d& eye : eyes) {
            look(eye);
            benchmark::DoNotOptimize(seen.data());
        }
    }
    per_cell(state, static_cast<std::int64_t>(eyes.size()));
    state.counters["error_max"] = worst;
    state.counters["spans"] = static_cast<double>(spans);
    state.counters["s_per_span"] = benchmark::Counter(
        static_cast<double>(spans),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void cgal_views(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    peers::CgalExpansion cgal(s->scene->walls(), s->scene->extent());
    const std::vector<Vec2d> eyes = spread(s->eyes, eyes_of_cgal);
    cgal.stand_at(eyes.front());  // for outdoor sites one face holds all eyes
    std::vector<Vec2d> corners;
    for (auto _ : state) {
        for (const Vec2d& eye : eyes) {
            cgal.see(eye, corners);
            benchmark::DoNotOptimize(corners.data());
        }
    }
    per_cell(state, static_cast<std::int64_t>(eyes.size()));
}

void sweep_views(benchmark::State& state, const std::string& site) {
    const Sample* s = sample(state, site);
    if (s == nullptr) return;
    const peers::RotationalSweep sweep(s->scene->walls());
    const ExactScene scene(s->scene->walls(), s->scene->extent(), s->scene->scanner().range_max_m);
    const std::vector<Vec2d> eyes = spread(s->eyes, 50);
    std::vector<double> want;
    scene.angles(s->scene->scanner(), eyes, want);
    double worst = 0;
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        worst = std::max(worst, std::abs(sweep.vf_rad(eyes[i], s->scene->scanner()) - want[i]));
    }
    if (!(worst <= 1e-9)) return state.SkipWithError("the sweep differs from exact");
    for (auto _ : state) {
        for (const Vec2d& eye : eyes) {
            benchmark::DoNotOptimize(sweep.vf_rad(eye, s->scene->scanner()));
        }
    }
    per_cell(state, static_cast<std::int64_t>(eyes.size()));
    state.counters["error_max"] = worst;
}

#define VFPLAN_SITE(function, site) \
    BENCHMARK_CAPTURE(function, site, #site)->Unit(benchmark::kMillisecond)

VFPLAN_SITE(exact_field, bellevue);
VFPLAN_SITE(exact_field, town);
VFPLAN_SITE(exact_field, city);
VFPLAN_SITE(exact_field, flat);
VFPLAN_SITE(exact_views, bellevue);
VFPLAN_SITE(exact_views, town);
VFPLAN_SITE(exact_views, city);
VFPLAN_SITE(exact_views, flat);
VFPLAN_SITE(embree_field, bellevue)->Arg(128)->Arg(0)->Arg(512)->Arg(1024);
VFPLAN_SITE(embree_field, town)->Arg(0);
VFPLAN_SITE(embree_field, city)->Arg(0);
VFPLAN_SITE(embree_field, flat)->Arg(0);
VFPLAN_SITE(bare_packets, bellevue)->Arg(128)->Arg(0)->Arg(512)->Arg(1024);
VFPLAN_SITE(bare_packets, town)->Arg(0);
VFPLAN_SITE(bare_quads, bellevue)->Arg(128)->Arg(256)->Arg(512);
VFPLAN_SITE(cgal_views, bellevue);
VFPLAN_SITE(cgal_views, town);
VFPLAN_SITE(cgal_views, city);
VFPLAN_SITE(sweep_views, bellevue);
VFPLAN_SITE(sweep_views, town);
VFPLAN_SITE(sweep_views, city);

}  // namespace
}  // namespace vfplan::bench
