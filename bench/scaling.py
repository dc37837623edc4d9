#!/usr/bin/python3
"""Measures how vfplan scales with threads and with the size of the site.

  strong  one site, 1, 2, 4, ... threads: Bellevue (run) and 4 km2 of a city (precompute)
  weak    a generated city of 1 km2 per thread (precompute)
  crops   the paper's five crops on one thread (run), beside the paper's own figures
  city    1 to 25 km2 of a city on one thread and on all (precompute)
  model   the measured tasks of the largest city window, handed to 1 to 128 cores by arithmetic

Every measurement is made --repeat times. Other work on the machine only ever adds, so processor
times and memory are those of the repeat with the least processor time, wall times those of the
repeat with the least wall time. All runs of one job must give the same result.
"""
# Not "env python3": python3-numpy and python3-matplotlib belong to this interpreter.
import argparse
import csv
import datetime
import hashlib
import heapq
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

try:
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot, ticker
except ImportError:
    matplotlib = None

ROOT = Path(__file__).resolve().parent.parent
CROPS_M = ((520, 292), (965, 366), (976, 441), (976, 588), (976, 893))
PAPER = {"buildings": [132, 274, 379, 529, 637],
         "peak_rss_mb": [265, 1018, 1683, 3268, 5703],
         "wall_s": [60 * minutes for minutes in (2.68, 30.84, 71.02, 967.48, 1505.36)]}
CITY_KM2 = (1, 2, 4, 8, 16, 25)
CORES = tuple(2**i for i in range(8))
FILES = ("site", "tables", "read", "files", "hash")  # stages that read and write
IN_TASKS = ("field", "skeleton", "joints", "splits", "rescues", "components", "paths", "connectors",
            "disputed", "coverage")  # stages that hand out tasks
QUANTITIES = {"cpu_s": "processor time, whole job",
              "cpu_computing_s": "the same without reading and writing files",
              "cpu_field_s": "processor time, field",
              "wall_s": "wall time, whole job",
              "peak_rss_mb": "peak memory"}
SIZES = {"buildings": "buildings", "free_cells": "free cells"}


class Failure(Exception):
    """A run failed or gave another result."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def on(threads):
    return f"{threads} thread{'s' * (threads > 1)}"


def table(head, rows):
    lines = (head, ["---"] * len(head), *rows)
    return ["| " + " | ".join(map(str, line)) + " |" for line in lines] + [""]


# --- running ------------------------------------------------------------------------------------


class Bench:
    """Runs the program, keeps one row per measurement."""

    def __init__(self, args, temporary):
        self.args = args
        self.temporary = Path(temporary)
        # A copy, so that a build in the meantime does not change what is measured.
        self.program = Path(shutil.copy2(args.program, self.temporary / "vfplan"))
        self.granted = len(os.sched_getaffinity(0))
        self.rows = []
        self.results = {}

    def threads(self):
        """1, 2, 4, ... and what is granted."""
        return sorted({self.granted, *(2**i for i in range(self.granted.bit_length()))})

    def windows(self):
        return CITY_KM2[:2] if self.args.quick else CITY_KM2

    def call(self, *words):
        words = list(map(str, words))
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failure(f"{' '.join(words)}\nended with {done.returncode}:\n{done.stderr}")
        return done.stdout

    def site(self, real, kind, *options):
        """The file of real data or, without it, a generated site; and whether it is real."""
        if real and (self.args.data / real).exists():
            return self.args.data / real, True
        file = self.temporary / ("-".join([kind, *map(str, options)]) + ".geojson")
        if not file.exists():
            self.call(self.program, "generate", kind, "--seed", 1, *options, "--out", file)
        return file, False

    def folder(self, case):
        return self.temporary / case.replace(" ", "_")

    def measure(self, part, case, threads, command, job, site, crop_m=None):
        """`case` names the job: what two parts share is measured once and stands in both."""
        for row in self.rows:
            if (row["case"], row["threads"]) == (case, threads):
                self.rows.append({**row, "part": part})
                return self.rows[-1]
        words = [self.program, command, ROOT / "configs" / job, "-q", "--fresh", "--threads",
                 threads, "--out", self.folder(case), "--set", f"site.input={site}"]
        if crop_m:
            words += ["--set", f"site.crop_m={list(crop_m)}"]
        runs = []
        for _ in range(self.args.repeat):
            before = clocks_s()
            self.call(*words)
            wall_s, ours_s, all_s = clocks_s() - before
            others = max(0.0, (all_s - ours_s) / wall_s)
            runs.append({**read_row(self.folder(case)), "wall_other_processors": others})
            if self.results.setdefault(case, runs[-1]["result"]) != runs[-1]["result"]:
                raise Failure(f"{case}: another result on {on(threads)} than in an earlier run; "
                              "equal jobs must give equal results, so no time here means anything")
        cpu, wall = (min(runs, key=lambda r: r[k]) for k in ("cpu_s", "wall_s"))
        spread = {f"spread_{k}": max(r[k] for r in runs) / min(r[k] for r in runs) - 1
                  for k in ("cpu_s", "wall_s")}
        self.rows.append({"part": part, "case": case, "threads": threads, **spread, **cpu,
                          **{k: v for k, v in wall.items() if k.startswith("wall_")}})
        say(f"{part}: {case}, {on(threads)}: {wall['wall_s']:.2f} s wall, "
            f"{cpu['cpu_s']:.2f} s processor, {cpu['peak_rss_mb']:.0f} MB; other work took "
            f"{wall['wall_other_processors']:.1f} processors")
        return self.rows[-1]


def clocks_s():
    """Now; processor time of our finished runs; busy time of all processors. They tell how much
    other work a run shared the machine with."""
    times = os.times()
    ticks = [int(t) for t in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
    busy = (sum(ticks) - ticks[3] - ticks[4]) / os.sysconf("SC_CLK_TCK")  # idle, waiting for disks
    return np.array([times.elapsed, times.children_user + times.children_system, busy])


def read_row(folder):
    s = json.loads((folder / "summary.json").read_text())
    tables = hashlib.sha256()  # precompute has no result_sha256; equal tables are equal bytes
    for name in ("field.h5", "coverage.h5"):
        tables.update((folder / name).read_bytes())
    cpu = s["stage_cpu_s"]
    return {"buildings": s["site"]["buildings"], "walls": s["site"]["walls"],
            "free_cells": s["grid"]["free_cells"], "candidates": s["candidates"],
            "pieces": s["pieces"], "stations": s.get("stations", ""), "kernel": s["kernel"],
            "peak_rss_mb": s["peak_rss_mb"], "wall_s": s["wall_s"], "cpu_s": sum(cpu.values()),
            "cpu_computing_s": sum(t for stage, t in cpu.items() if stage not in FILES),
            **{f"wall_{stage}_s": t for stage, t in s["stage_wall_s"].items()},
            **{f"cpu_{stage}_s": t for stage, t in cpu.items()},
            "result": s.get("result_sha256", tables.hexdigest())}


def stages(row):
    return [k[5:-2] for k in row if k.startswith("wall_") and k.endswith("_s") and k != "wall_s"]


def city_window(bench, part, km2, threads):
    """From the north-west corner, where the number of buildings per area changes least."""
    file, real = bench.site("city_allegheny/allegheny_core_5km.geojson", "city", "--size-km", 5)
    name, west, north = ("Allegheny", 38000, 36000) if real else ("generated city", 0, 5000)
    side = round(1000 * math.sqrt(km2), 3)
    crop_m = None if km2 == 25 else (west, north - side, west + side, north)
    return bench.measure(part, f"{name} {km2} km2", threads, "precompute", "city.toml", file,
                         crop_m)


# --- fits ---------------------------------------------------------------------------------------


def power_law(x, y):
    """y = factor * x ^ exponent by least squares in log-log; None without two sizes."""
    if len(set(x)) < 2 or min(y) <= 0:
        return None
    lx, ly = np.log(x), np.log(y)
    exponent, intercept = np.polyfit(lx, ly, 1)
    rest = np.sum((ly - intercept - exponent * lx) ** 2)
    return {"exponent": float(exponent), "factor": math.exp(intercept), "points": len(x),
            "r2": float(1 - rest / max(np.sum((ly - ly.mean()) ** 2), 1e-300))}


def growth(rows, quantities=QUANTITIES):
    return {x: {y: power_law([r[x] for r in rows], [r[y] for r in rows]) for y in quantities}
            for x in SIZES}


def fit_text(fit):
    if not fit:
        return "-"
    how_well = "2 sizes" if fit["points"] == 2 else f"{fit['r2']:.2f}"
    return f"{fit['exponent']:.2f} ({how_well})"


def growth_lines(fits):
    """Exponents, a column per site and measure of size."""
    columns = [(site, x) for site, of_site in fits.items() for x in of_site]
    rows = [[text, *(fit_text(fits[site][x].get(y)) for site, x in columns)]
            for y, text in QUANTITIES.items()]
    head = [f"{site}, against {SIZES[x]}" for site, x in columns]
    return ["Exponents (R2 in brackets):", "", *table(["quantity", *head], rows)]


def memory_lines(name, rows):
    if len(rows) < 3:
        return []
    slope, base = np.polyfit([r["free_cells"] / 1e6 for r in rows],
                             [r["peak_rss_mb"] for r in rows], 1)
    return [f"{name}: peak memory is about {base:.0f} MB + {slope:.0f} MB per million free cells. "
            "While the first term is most of it, the exponent says little.", ""]


# --- the parts: each returns what fits.json keeps and the summary's lines -----------------------


def strong(bench):
    file, real = bench.site("town_bellevue/bellevue_976x893.geojson", "town")
    name = "Bellevue" if real else "generated town"
    town = [bench.measure("strong", name, t, "run", "town.toml", file) for t in bench.threads()]
    city_rows = [city_window(bench, "strong", 4, t) for t in bench.threads()]
    lines, speed_up = ["Wall seconds (processor seconds), speed-up of wall time.", ""], {}
    for rows in (town, city_rows):
        case, body = rows[0]["case"], []
        speed_up[case] = {}
        for key, stage in [*((f"{s}_s", s) for s in stages(rows[0])), ("s", "whole")]:
            ups = [rows[0][f"wall_{key}"] / r[f"wall_{key}"] for r in rows]
            speed_up[case][stage] = ups
            body.append([stage, *(f"{r[f'wall_{key}']:.3f} ({r[f'cpu_{key}']:.3f}), {up:.2f}"
                                  for r, up in zip(rows, ups))])
        lines += [f"{case}; result {rows[0]['result'][:16]} on any number of threads:", "",
                  *table(["stage", *(on(r["threads"]) for r in rows)], body)]
    return {"threads": bench.threads(), "speed_up": speed_up}, lines


def weak(bench):
    data, body = [], []
    for t in bench.threads():
        file, _ = bench.site("", "city", "--size-km", round(math.sqrt(t), 3))
        r = bench.measure("weak", f"generated city of {t} km2", t, "precompute", "city.toml", file)
        first = first if data else r
        # Per free cell, because no two cities have exactly the same work per area.
        work = r["free_cells"] / first["free_cells"] / t
        efficiency = {k: first[f"wall_{k}s"] * work / r[f"wall_{k}s"] for k in ("field_", "")}
        data.append({"threads": t, "field": efficiency["field_"], "whole": efficiency[""]})
        body.append([t, r["buildings"], r["free_cells"], f"{r['wall_field_s']:.3f}",
                     f"{efficiency['field_']:.2f}", f"{r['wall_s']:.2f}", f"{efficiency['']:.2f}"])
    return data, table(["threads = km2", "buildings", "free cells", "field, wall s",
                        "efficiency per cell", "whole job, wall s", "efficiency per cell"], body)


def crops(bench):
    """crop_m is in the file's coordinates and keeps whole buildings. Corners: the generated town's
    south-west one, as its generator counts, and Bellevue's north-west one, for the other is a
    river."""
    file, real = bench.site("town_bellevue/bellevue_976x893.geojson", "town")
    town, _ = bench.site("", "town")
    sites = [("generated town", town, [(0, 0, w, h) for w, h in CROPS_M])]
    if real:
        sites.append(("Bellevue", file, [(62, 973 - h, 62 + w, 973) for w, h in CROPS_M]))
    paper = {y: power_law(PAPER["buildings"], PAPER[y]) for y in ("wall_s", "peak_rss_mb")}
    fits, lines, body = {"paper": {"buildings": paper}}, [], []
    for name, file, windows in sites:
        rows = [bench.measure("crops", f"{name} {w} x {h} m", 1, "run", "town.toml", file, crop_m)
                for (w, h), crop_m in zip(CROPS_M, windows)]
        fits[name] = growth(rows)
        lines += memory_lines(name, rows)
        body += [[r["case"], r["buildings"], r["free_cells"], r["stations"], f"{r['cpu_s']:.2f}",
                  f"{r['cpu_field_s']:.3f}", f"{r['peak_rss_mb']:.0f}", buildings, f"{seconds:.0f}",
                  mb] for r, buildings, seconds, mb in zip(rows, PAPER["buildings"],
                                                           PAPER["wall_s"], PAPER["peak_rss_mb"])]
    head = ["crop", "buildings", "free cells", "stations", "processor s", "of it field",
            "MB", "paper: buildings", "paper: s", "paper: MB"]
    return fits, [*table(head, body), *growth_lines(fits), *lines]


def city(bench):
    counts = sorted({1, bench.granted})
    rows = [city_window(bench, "city", km2, t) for km2 in bench.windows() for t in counts]
    one = [r for r in rows if r["threads"] == 1]
    fits = {on(t): growth([r for r in rows if r["threads"] == t]) for t in counts}
    by_stage = growth(one, [f"cpu_{s}_s" for s in stages(one[0])])["buildings"]
    body = [[r["case"], r["threads"], r["buildings"], r["free_cells"], f"{r['wall_s']:.2f}",
             f"{r['cpu_s']:.2f}", f"{r['cpu_field_s']:.3f}", f"{r['peak_rss_mb']:.0f}"]
            for r in rows]
    last = one[-1]
    stage_body = [[k[4:-2], f"{last[k]:.2f}", f"{last[k] / last['cpu_s']:.0%}", fit_text(fit)]
                  for k, fit in by_stage.items()]
    return {**fits, "stages": by_stage}, [
        *table(["window", "threads", "buildings", "free cells", "wall s", "processor s",
                "of it field", "MB"], body),
        *growth_lines(fits), *memory_lines("City", one),
        f"Stages on one thread, {last['case']}; exponents over all windows:", "",
        *table(["stage", "processor s", "share", "exponent against buildings"], stage_body)]


def makespan_s(tasks_s, cores):
    """Each task, in order, to the core that is idle first."""
    idle = [0.0] * cores
    for t in tasks_s:
        heapq.heapreplace(idle, idle[0] + t)
    return max(idle)


def model(bench):
    rows = [city_window(bench, "model", bench.windows()[-1], t) for t in bench.threads()]
    one = rows[0]
    say(f"model: times of the tasks of {one['case']}")
    tasks = {"field": [], "coverage": []}
    text = bench.call(bench.args.task_times, bench.folder(one["case"]))
    for line in csv.DictReader(text.splitlines()):
        tasks[line["stage"]].append(float(line["seconds"]))
    sums = {k: sum(v) for k, v in tasks.items()}
    share = sum(one.get(f"wall_{s}_s", 0) for s in IN_TASKS) / one["wall_s"]
    data = {"label": "model, not measured", "case": one["case"], "share_in_tasks": share,
            "tasks": {k: {"count": len(v), "sum_s": sums[k], "longest_s": max(v)}
                      for k, v in tasks.items()}, "cores": [], "measured": []}
    for p in CORES:
        spans = {k: makespan_s(v, p) for k, v in tasks.items()}
        amdahl = 1 / (1 - share + share / p)
        data["cores"].append({"cores": p, **{k: sums[k] / (p * spans[k]) for k in tasks},
                              "both": sum(sums.values()) / (p * sum(spans.values())),
                              "amdahl_speed_up": amdahl, "amdahl_efficiency": amdahl / p})
    walls = {"field": ["wall_field_s"], "coverage": ["wall_joints_s", "wall_splits_s"],
             "whole": ["wall_s"]}
    for r in rows:
        data["measured"].append({"threads": r["threads"], **{
            k: sum(one[w] for w in v) / (r["threads"] * sum(r[w] for w in v))
            for k, v in walls.items()}})
    return data, model_lines(data)


def model_lines(data):
    measured = {m["threads"]: m for m in data["measured"]}
    body = [[c["cores"], *(f"{c[k]:.3f}" for k in ("field", "coverage", "both")),
             *(f"{measured[c['cores']][k]:.2f}" if c["cores"] in measured else "-"
               for k in ("field", "coverage", "whole")),
             f"{c['amdahl_speed_up']:.2f}", f"{c['amdahl_efficiency']:.3f}"] for c in data["cores"]]
    head = ["cores", "model: field", "model: coverage", "model: both", "measured: field",
            "measured: joints and splits", "measured: whole job",
            "model (Amdahl): speed-up of the whole job", "model (Amdahl): efficiency"]
    counts = ", ".join(f"{v['count']} tasks of {k} ({v['sum_s']:.2f} s, longest "
                       f"{1000 * v['longest_s']:.2f} ms)" for k, v in data["tasks"].items())
    return [f"**Model, not measured.** {data['case']}: {counts}. Their times, taken one by one "
            "on one thread, are handed in order to the core that is idle first; efficiency = sum "
            "/ (cores x last end). This ignores memory bandwidth, shared caches, clock rates, the "
            "scheduler's own cost and the barriers between the batches in which candidates come: "
            "it is what load balance alone allows.", "",
            f"The Amdahl columns take all stages but {', '.join(IN_TASKS)} as serial. These hold "
            f"{data['share_in_tasks']:.1%} of the precompute job's wall time on one thread, and "
            "that limits its speed-up, whatever the columns to the left say.", "",
            *table(head, body)]


PARTS = {"strong": (strong, "Strong scaling: one site, more threads"),
         "weak": (weak, "Weak scaling: 1 km2 of generated city per thread, precompute"),
         "crops": (crops, "The paper's crops, one thread, whole job"),
         "city": (city, "Growth of a city, precompute"),
         "model": (model, "Model: load balance on more cores than this machine has")}


# --- plot: colour says what is measured, marker and line whose it is ----------------------------


def finish(ax, title, x, y, **scales):
    ax.set(title=title, xlabel=x, ylabel=y, **scales)
    ax.grid(True, which="major", alpha=0.3)


def plain_ticks(axis, values):
    axis.set_major_locator(ticker.FixedLocator(values))
    axis.set_major_formatter(ticker.FuncFormatter(lambda v, _: f"{v:g}"))
    axis.set_minor_locator(ticker.NullLocator())


def plot_strong(ax, _, fits):
    threads = fits["strong"]["threads"]
    ax.plot(threads, threads, color="0.6", ls=":", label="ideal")
    for (case, ups), style in zip(fits["strong"]["speed_up"].items(), ("o-", "s--")):
        for stage, colour in (("field", "C0"), ("rescues", "C2"), ("whole", "C3")):
            ax.plot(threads, ups[stage], style, color=colour, label=f"{case}: {stage}")
    finish(ax, "Strong scaling", "threads", "speed-up of wall time", xscale="log", yscale="log")
    plain_ticks(ax.xaxis, threads)
    plain_ticks(ax.yaxis, (0.5, 0.7, 1, 1.4, *(2**i for i in range(1, 10))))


def plot_crops(ax, rows, fits):
    right = ax.twinx()
    sites = [("paper", "o--", PAPER["buildings"], PAPER["wall_s"], PAPER["peak_rss_mb"])]
    for site, style in (("generated town", "s-"), ("Bellevue", "^-")):
        mine = [r for r in rows if r["part"] == "crops" and r["case"].startswith(site)]
        if mine:
            sites.append((site, style, *([r[k] for r in mine]
                                         for k in ("buildings", "cpu_s", "peak_rss_mb"))))
    for site, style, x, seconds, mb in sites:
        fill = {"mfc": "white"} if site == "paper" else {}
        fit = fits["crops"][site]["buildings"]
        time = fit["wall_s" if site == "paper" else "cpu_s"]["exponent"]
        ax.plot(x, seconds, style, color="C0", label=f"{site}: time {time:.2f}", **fill)
        right.plot(x, mb, style, color="C1", **fill)
        ax.plot([], [], style, color="C1", **fill,
                label=f"{site}: memory {fit['peak_rss_mb']['exponent']:.2f}")
    finish(ax, "The paper's crops, whole job on one thread, with exponents", "buildings",
           "time, s (blue; ours: processor time)", xscale="log", yscale="log", ylim=(0.1, 1e6))
    right.set(ylabel="peak memory, MB (orange)", yscale="log", ylim=(10, 1e5))
    plain_ticks(ax.xaxis, (100, 150, 200, 300, 400, 500, 600))


def plot_city(ax, rows, fits):
    mine = [r for r in rows if r["part"] == "city" and r["threads"] == 1]
    whole = fits["city"]["1 thread"]["buildings"]["cpu_s"]
    lines = {"cpu_s": whole, **fits["city"]["stages"]}
    for k in sorted(lines, key=lambda k: -mine[-1][k])[:7]:  # the whole job and its largest stages
        style = "ko-" if k == "cpu_s" else ".-"
        ax.plot([r["buildings"] for r in mine], [r[k] for r in mine], style,
                label=f"{k[4:-2] or 'whole job'} {lines[k]['exponent']:.2f}")
    finish(ax, f"{mine[0]['case']} to {mine[-1]['case'].split(' ', 1)[1]}, precompute on one "
           "thread, with exponents", "buildings", "processor time, s", xscale="log", yscale="log")
    plain_ticks(ax.xaxis, (1000, 2000, 5000, 10000, 20000))
    plain_ticks(ax.yaxis, (0.01, 0.1, 1, 10, 100))


def plot_model(ax, _, fits):
    data = fits["model"]
    cores = [c["cores"] for c in data["cores"]]
    for key, look in (("both", {"color": "0.7", "lw": 5}), ("field", {"color": "C0"}),
                      ("coverage", {"color": "C2", "ls": "--"})):
        ax.plot(cores, [c[key] for c in data["cores"]], label=f"model: {key}", **look)
    for key, colour in (("field", "C0"), ("coverage", "C2"), ("whole", "C3")):
        ax.plot([m["threads"] for m in data["measured"]], [m[key] for m in data["measured"]], "D",
                color=colour, mfc="white", label=f"measured: {key}" + " job" * (key == "whole"))
    ax.plot(cores, [c["amdahl_efficiency"] for c in data["cores"]], color="C3", ls="--",
            label="model (Amdahl): whole job")
    finish(ax, f"Model (lines) and measured (diamonds), {data['case']}, precompute", "cores",
           "efficiency", xscale="log", ylim=(0, 1.1))
    plain_ticks(ax.xaxis, CORES)


def draw(rows, fits, file):
    matplotlib.rcParams.update({"svg.hashsalt": "vfplan", "font.size": 9, "axes.titlesize": 10})
    figure, axes = pyplot.subplots(2, 2, figsize=(12, 9), constrained_layout=True)
    plots = {"strong": plot_strong, "crops": plot_crops, "city": plot_city, "model": plot_model}
    for ax, (part, plot) in zip(axes.flat, plots.items()):
        if part in fits:
            plot(ax, rows, fits)
            ax.legend(fontsize=8, framealpha=0.9, handlelength=3.5)
        else:
            ax.set_axis_off()
            ax.text(0.5, 0.5, f"{part}: not measured", ha="center")
    figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else {})


# --- results and command line -------------------------------------------------------------------


def value_in(file, key):
    lines = Path(file).read_text().splitlines()
    return next((x.split(":", 1)[1].strip() for x in lines if x.startswith(key)), "unknown")


def compiler_of(program):
    """Compiler and flags of the program's main file, from what CMake left beside it."""
    try:
        entries = json.loads((program.parent / "compile_commands.json").read_text())
        command = next(e["command"] for e in entries if e["file"].endswith("engine/main.cpp"))
        words = [w for w in command.split() if not w.endswith("ccache")]
        version = subprocess.check_output([words[0], "--version"], text=True).splitlines()[0]
        flags = [w for w in words if w.startswith(("-O", "-D", "-f", "-m", "-std"))]
        return {"compiler": version, "compiler_flags": " ".join(flags)}
    except (OSError, ValueError, LookupError, StopIteration, subprocess.SubprocessError):
        return {"compiler": "unknown", "compiler_flags": "unknown"}


def machine(bench):
    return {"processor": value_in("/proc/cpuinfo", "model name"),
            "processors_granted": bench.granted,
            "memory_mb": int(value_in("/proc/meminfo", "MemTotal").split()[0]) // 1024,
            "kernel": f"{os.uname().sysname} {os.uname().release}",
            "load_average_at_start": round(os.getloadavg()[0], 2),
            "program": bench.call(bench.program, "--version").strip(),
            **compiler_of(bench.args.program), "repeat": bench.args.repeat,
            "date_utc": datetime.datetime.now(datetime.timezone.utc).isoformat("T", "seconds")}


def write_results(bench, about, fits, lines):
    out = bench.args.out
    for name, data in (("machine.json", about), ("fits.json", fits)):
        (out / name).write_text(json.dumps(data, indent=2) + "\n")
    with open(out / "scaling.csv", "w", newline="", encoding="utf-8") as file:
        columns = list(dict.fromkeys(k for r in bench.rows for k in r))
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        for r in bench.rows:
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in r.items()})
    (out / "summary.md").write_text("\n".join(lines))
    print("\n".join(lines))
    if matplotlib:
        draw(bench.rows, fits, out / "scaling.svg")
    else:
        say("no plot: matplotlib is missing; apt-get install python3-matplotlib")


def measure_all(bench):
    about, fits = machine(bench), {}
    parts = []
    for name, (part, title) in PARTS.items():
        if name in bench.args.part:
            fits[name], text = part(bench)
            parts += [f"## {title}", "", *text]
    spread = ", ".join(f"{max(r[f'spread_{k}_s'] for r in bench.rows):.0%} {text}"
                       for k, text in (("cpu", "processor time"), ("wall", "wall time")))
    about["largest_spread_of_repeats"] = spread
    others = max(bench.rows, key=lambda r: r["wall_other_processors"])
    about["most_other_work"] = (f"{others['wall_other_processors']:.1f} processors, during "
                                f"{others['case']} on {on(others['threads'])}")
    facts = [f"- {k.replace('_', ' ')}: {v}" for k, v in about.items()]
    write_results(bench, about, fits, ["# How vfplan scales", "", *facts, "", *parts])


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    data = os.environ.get("VFPLAN_DATA", ROOT / "../shared/data")
    parser.add_argument("part", nargs="*", metavar="PART", help="default: all")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/vfplan")
    parser.add_argument("--task-times", type=Path, default=ROOT / "build/bench/task_times")
    parser.add_argument("--data", type=Path, default=data,
                        help="real sites; default: $VFPLAN_DATA, else ../shared/data beside the "
                        "source tree; generated sites where there are none")
    parser.add_argument("--out", type=Path, default=ROOT / "runs/scaling")
    parser.add_argument("--repeat", type=int, default=3, metavar="N")
    parser.add_argument("--quick", action="store_true",
                        help="once each, city up to 2 km2; without PART: crops and city")
    args = parser.parse_args()
    for wrong in set(args.part) - set(PARTS):
        parser.error(f"{wrong}: no such part; choose from {', '.join(PARTS)}")
    if args.repeat < 1:
        parser.error(f"--repeat {args.repeat}: nothing would be measured; 1 is the least")
    args.part = args.part or (["crops", "city"] if args.quick else list(PARTS))
    args.repeat = 1 if args.quick else args.repeat
    for name in ("program", "task_times", "data", "out"):
        setattr(args, name, Path(getattr(args, name)).resolve())
    for file in [args.program] + [args.task_times] * ("model" in args.part):
        if not file.is_file():
            parser.error(f"{file}: no such program; make program and make bench build them")
    return args


def main():
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    try:
        with tempfile.TemporaryDirectory(prefix="tmp-", dir=args.out) as temporary:
            measure_all(Bench(args, temporary))
    except (Failure, OSError) as e:
        say(f"scaling: {e}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
