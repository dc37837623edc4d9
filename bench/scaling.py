#!/usr/bin/python3
"""Measures how vfplan scales with threads and with the size of the site.

  strong  one site, 1, 2, 4, ... threads: Bellevue (run) and 4 km2 of a city (precompute)
  weak    a generated city of 1 km2 per thread (precompute)
  crops   the paper's five crops on one thread (run), beside the paper's own figures
  city    1 to 25 km2 of a city on one thread and on all (precompute)
  model   the measured tasks of the largest city window, handed to 1 to 128 cores by arithmetic

Every measurement is made --repeat times and the one with the least processor time is kept, because
other work on the machine only ever adds. All runs of one job must give the same result.
"""
# Not "env python3": the packages python3-numpy and python3-matplotlib belong to this interpreter.
import argparse
import csv
import datetime
import hashlib
import heapq
import io
import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
CROPS_M = ((520, 292), (965, 366), (976, 441), (976, 588), (976, 893))
PAPER = {"buildings": [132, 274, 379, 529, 637],
         "peak_rss_mb": [265, 1018, 1683, 3268, 5703],
         "wall_s": [60 * m for m in (2.68, 30.84, 71.02, 967.48, 1505.36)]}
CITY_KM2 = (1, 2, 4, 8, 16, 25)
CORES = tuple(2**i for i in range(8))
FILES = ("site", "tables", "files")  # stages that read and write
IN_TASKS = ("field", "joints", "ridges", "rescue")  # stages that hand out tasks
QUANTITIES = {"cpu_s": "processor time, whole job",
              "cpu_computing_s": "the same without reading and writing files",
              "cpu_field_s": "processor time, field",
              "wall_s": "wall time, whole job",
              "peak_rss_mb": "peak memory"}


class Failure(Exception):
    """A run failed or gave another result."""


def say(text):
    print(text, file=sys.stderr, flush=True)


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(str(c) for c in line) + " |" for line in lines] + [""]


# --- running ------------------------------------------------------------------------------------


class Bench:
    """Runs the program, keeps one row per measurement."""

    def __init__(self, args):
        self.args = args
        self.temporary = args.out / "tmp"
        self.granted = len(os.sched_getaffinity(0))
        self.rows = []
        self.results = {}

    def threads(self):
        """1, 2, 4, ... and what is granted."""
        powers = [2**i for i in range(self.granted.bit_length())]
        return powers if powers[-1] == self.granted else [*powers, self.granted]

    def call(self, *words):
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failure(f"{' '.join(str(w) for w in words)}\nended with {done.returncode}:\n"
                          f"{done.stderr}")
        return done.stdout

    def generated(self, kind, *options):
        file = self.temporary / ("-".join([kind, *map(str, options)]) + ".geojson")
        if not file.exists():
            self.call(self.args.program, "generate", kind, "--seed", 1, *options, "--out", file)
        return file

    def folder(self, case):
        return self.temporary / case.replace(" ", "_")

    def measure(self, part, case, threads, command, job, site, crop_m=None):
        """`case` names the job: what two parts share is run once and stands in both."""
        for row in self.rows:
            if (row["case"], row["threads"]) == (case, threads):
                self.rows.append({**row, "part": part})
                return self.rows[-1]
        words = [self.args.program, command, ROOT / "configs" / job, "-q", "--fresh", "--threads",
                 threads, "--out", self.folder(case), "--set", f"site.input={site}"]
        if crop_m:
            words += ["--set", f"site.crop_m={list(crop_m)}"]
        rows = []
        for _ in range(self.args.repeat):
            self.call(*words)
            rows.append(read_row(self.folder(case)))
            if self.results.setdefault(case, rows[-1]["result"]) != rows[-1]["result"]:
                raise Failure(f"{case}: another result with {threads} threads than before; equal "
                              "jobs must give equal results: compare with --threads 1")
        best = min(rows, key=lambda r: r["cpu_s"])
        spread = max(r["cpu_s"] for r in rows) / best["cpu_s"] - 1
        row = {"part": part, "case": case, "threads": threads, "cpu_spread": spread, **best}
        self.rows.append(row)
        say(f"{part}: {case}, {threads} threads: {row['wall_s']:.2f} s wall, "
            f"{row['cpu_s']:.2f} s processor, {row['peak_rss_mb']:.0f} MB")
        return row


def read_row(folder):
    s = json.loads((folder / "summary.json").read_text())
    tables = hashlib.sha256()  # precompute has no result_sha256; equal tables are equal bytes
    for name in ("field.h5", "coverage.h5"):
        tables.update((folder / name).read_bytes())
    row = {"buildings": s["site"]["buildings"], "walls": s["site"]["walls"],
           "free_cells": s["grid"]["free_cells"], "candidates": s["candidates"],
           "pieces": s["pieces"], "stations": s.get("stations", ""), "kernel": s["kernel"],
           "wall_s": s["wall_s"], "cpu_s": sum(s["stage_cpu_s"].values()),
           "cpu_computing_s": sum(t for k, t in s["stage_cpu_s"].items() if k not in FILES),
           "peak_rss_mb": s["peak_rss_mb"]}
    for stage, seconds in s["stage_wall_s"].items():
        row[f"wall_{stage}_s"] = seconds
        row[f"cpu_{stage}_s"] = s["stage_cpu_s"][stage]
    return {**row, "result": s.get("result_sha256", tables.hexdigest())}


def stages(row):
    return [k[5:-2] for k in row if k.startswith("wall_") and k != "wall_s"]


def city_window(bench, part, km2, threads):
    """From the north-west corner, where the number of buildings per area changes least."""
    file = bench.args.data / "city_allegheny" / "allegheny_core_5km.geojson"
    name, west, north = "Allegheny", 38000, 36000
    if not file.exists():
        file = bench.generated("city", "--size-km", 5)
        name, west, north = "generated city", 0, 5000
    side = round(1000 * math.sqrt(km2), 3)
    crop_m = None if km2 == 25 else (west, north - side, west + side, north)
    case = f"{name} {km2} km2"
    return bench.measure(part, case, threads, "precompute", "city.toml", file, crop_m)


# --- the parts: each returns what fits.json keeps and the summary's lines -----------------------


def power_law(x, y):
    """y = factor * x ^ exponent by least squares in log-log; None without two sizes."""
    if len(set(x)) < 2 or min(y) <= 0:
        return None
    lx, ly = np.log(x), np.log(y)
    exponent, intercept = np.polyfit(lx, ly, 1)
    rest = np.sum((ly - intercept - exponent * lx) ** 2)
    r2 = 1 - rest / max(np.sum((ly - ly.mean()) ** 2), 1e-300)
    return {"exponent": float(exponent), "factor": math.exp(intercept), "r2": float(r2),
            "points": len(x)}


def growth(rows, quantities=QUANTITIES):
    return {x: {y: power_law([r[x] for r in rows], [r[y] for r in rows])
                for y in quantities if all(y in r for r in rows)}
            for x in ("buildings", "free_cells") if all(x in r for r in rows)}


def fit_text(fit):
    return f"{fit['exponent']:.2f} ({fit['r2']:.2f})" if fit else "-"


def growth_lines(fits):
    """Exponents, a column per site and measure of size."""
    columns = [(site, x) for site, f in fits.items() for x in f]
    rows = [[text, *(fit_text(fits[s][x].get(y)) for s, x in columns)]
            for y, text in QUANTITIES.items()]
    head = [f"{s}, against {x.replace('_', ' ')}" for s, x in columns]
    return ["Exponents (R2):", "", *table(["quantity", *head], rows)]


def memory_line(name, rows):
    if len(rows) < 3:
        return []
    slope, base = np.polyfit([r["free_cells"] / 1e6 for r in rows],
                             [r["peak_rss_mb"] for r in rows], 1)
    return [f"{name}: peak memory is about {base:.0f} MB + {slope:.0f} MB per million free cells; "
            "exponents of memory are small while the first term is most of it.", ""]


def strong(bench):
    file = bench.args.data / "town_bellevue" / "bellevue_976x893.geojson"
    name = "Bellevue"
    if not file.exists():
        file, name = bench.generated("town"), "generated town"
    town = [bench.measure("strong", f"{name} whole", t, "run", "town.toml", file)
            for t in bench.threads()]
    city = [city_window(bench, "strong", 4, t) for t in bench.threads()]
    lines, data = [], {}
    for rows in (town, city):
        case = rows[0]["case"]
        head = ["stage"] + [f"{what}, {r['threads']} threads" for r in rows
                            for what in ("wall s", "processor s", "speed-up")]
        body = []
        for key in [*(f"{s}_s" for s in stages(rows[0])), "s"]:
            ups = [rows[0][f"wall_{key}"] / r[f"wall_{key}"] for r in rows]
            data.setdefault(case, {})[key[:-2] or "whole"] = ups
            body.append([key[:-2] or "**whole**"] + [
                f"{v:.3f}" if i < 2 else f"{v:.2f}" for r, up in zip(rows, ups)
                for i, v in enumerate((r[f"wall_{key}"], r[f"cpu_{key}"], up))])
        lines += [f"{case}; result {rows[0]['result'][:16]} with any number of threads.", "",
                  *table(head, body)]
    return {"threads": bench.threads(), "speed_up": data}, lines


def weak(bench):
    rows = []
    for threads in bench.threads():
        side_km = round(math.sqrt(threads), 3)
        file = bench.generated("city", "--size-km", side_km)
        rows.append(bench.measure("weak", f"generated city of {threads} km2", threads,
                                  "precompute", "city.toml", file))
    body, data = [], []
    for r in rows:  # per free cell, because no two cities have exactly the same work per area
        work = r["free_cells"] / rows[0]["free_cells"] / r["threads"]
        field = rows[0]["wall_field_s"] * work / r["wall_field_s"]
        whole = rows[0]["wall_s"] * work / r["wall_s"]
        data.append({"threads": r["threads"], "field": field, "whole": whole})
        body.append([r["threads"], r["buildings"], r["free_cells"], f"{r['wall_field_s']:.3f}",
                     f"{field:.2f}", f"{r['wall_s']:.2f}", f"{whole:.2f}"])
    return data, table(["threads = km2", "buildings", "free cells", "field, wall s",
                        "efficiency per cell", "whole, wall s", "efficiency per cell"], body)


def crops(bench):
    """Anchored in a corner: the generated town's own, and in Bellevue the north-west one (the
    south-west one is a river). crop_m is in the file's coordinates and keeps whole buildings."""
    sites = {"generated town": [(0, 0, w, h) for w, h in CROPS_M]}
    files = {"generated town": bench.generated("town")}
    real = bench.args.data / "town_bellevue" / "bellevue_976x893.geojson"
    if real.exists():
        sites["Bellevue"] = [(62, 973 - h, 62 + w, 973) for w, h in CROPS_M]
        files["Bellevue"] = real
    fits = {"paper": {"buildings": {y: power_law(PAPER["buildings"], PAPER[y])
                                    for y in ("wall_s", "peak_rss_mb")}}}
    lines, body = [], []
    for site, windows in sites.items():
        rows = [bench.measure("crops", f"{site} {w} x {h} m", 1, "run", "town.toml", files[site], c)
                for (w, h), c in zip(CROPS_M, windows)]
        fits[site] = growth(rows)
        lines += memory_line(site, rows)
        body += [[r["case"], r["buildings"], r["free_cells"], r["stations"], f"{r['cpu_s']:.2f}",
                  f"{r['cpu_field_s']:.3f}", f"{r['peak_rss_mb']:.0f}", PAPER["buildings"][i],
                  f"{PAPER['wall_s'][i]:.0f}", PAPER["peak_rss_mb"][i]]
                 for i, r in enumerate(rows)]
    head = ["crop", "buildings", "free cells", "stations", "processor s", "of it field",
            "MB", "paper: buildings", "paper: s", "paper: MB"]
    return fits, [*table(head, body), *growth_lines(fits), *lines]


def city(bench):
    windows = CITY_KM2[:2] if bench.args.quick else CITY_KM2
    counts = sorted({1, bench.granted})
    rows = [city_window(bench, "city", km2, t) for km2 in windows for t in counts]
    one = [r for r in rows if r["threads"] == 1]
    fits = {f"{t} threads": growth([r for r in rows if r["threads"] == t]) for t in counts}
    names = stages(one[0])
    by_stage = growth(one, [f"cpu_{s}_s" for s in names])["buildings"]
    body = [[r["case"], r["threads"], r["buildings"], r["free_cells"], f"{r['wall_s']:.2f}",
             f"{r['cpu_s']:.2f}", f"{r['cpu_field_s']:.3f}", f"{r['peak_rss_mb']:.0f}"]
            for r in rows]
    last = one[-1]
    stage_body = [[s, f"{last[f'cpu_{s}_s']:.2f}", f"{last[f'cpu_{s}_s'] / last['cpu_s']:.0%}",
                   fit_text(by_stage[f"cpu_{s}_s"])] for s in names]
    head = ["window", "threads", "buildings", "free cells", "wall s", "processor s",
            "of it field", "MB"]
    stage_head = ["stage", "processor s, largest window", "share",
                  "exponent against buildings (R2)"]
    return ({**fits, "stages": by_stage},
            [*table(head, body), *growth_lines(fits), *memory_line("City", one),
             "Stages on one thread:", "", *table(stage_head, stage_body)])


def makespan_s(tasks_s, cores):
    """Each task, in order, to the core that is idle first."""
    idle = [0.0] * cores
    for t in tasks_s:
        heapq.heapreplace(idle, idle[0] + t)
    return max(idle)


def model(bench):
    done = [int(r["case"].split()[-2]) for r in bench.rows if r["part"] == "city"]
    km2 = max(done) if done else (CITY_KM2[1] if bench.args.quick else CITY_KM2[-1])
    rows = [city_window(bench, "model", km2, t) for t in bench.threads()]
    one = rows[0]
    say(f"model: times of the tasks of {one['case']}")
    text = bench.call(bench.args.task_times, bench.folder(one["case"]))
    tasks = {"field": [], "coverage": []}
    for line in csv.DictReader(io.StringIO(text)):
        tasks[line["stage"]].append(float(line["seconds"]))
    sums = {k: sum(v) for k, v in tasks.items()}
    parallel = sum(one[f"wall_{s}_s"] for s in IN_TASKS) / one["wall_s"]
    data = {"label": "model, not measured", "case": one["case"], "parallel_share": parallel,
            "tasks": {k: {"count": len(v), "sum_s": sums[k], "longest_s": max(v)}
                      for k, v in tasks.items()}, "cores": [], "measured": []}
    for p in CORES:
        spans = {k: makespan_s(v, p) for k, v in tasks.items()}
        amdahl = 1 / (1 - parallel + parallel / p)
        data["cores"].append({"cores": p, **{k: sums[k] / (p * spans[k]) for k in tasks},
                              "both": sum(sums.values()) / (p * sum(spans.values())),
                              "amdahl_speed_up": amdahl, "amdahl_efficiency": amdahl / p})
    for r in rows:
        walls = {"field": ("field",), "coverage": ("joints", "ridges"), "whole": None}
        seconds = {k: [sum(x[f"wall_{s}_s"] for s in v) if v else x["wall_s"] for x in (one, r)]
                   for k, v in walls.items()}
        data["measured"].append({"threads": r["threads"], **{
            k: first / (r["threads"] * here) for k, (first, here) in seconds.items()}})
    return data, model_lines(data)


def model_lines(data):
    measured = {m["threads"]: m for m in data["measured"]}
    body = []
    for c in data["cores"]:
        m = measured.get(c["cores"])
        body.append([c["cores"], *(f"{c[k]:.3f}" for k in ("field", "coverage", "both")),
                     *(f"{m[k]:.2f}" if m else "-" for k in ("field", "coverage", "whole")),
                     f"{c['amdahl_speed_up']:.2f}", f"{c['amdahl_efficiency']:.3f}"])
    head = ["cores", "model: field", "model: coverage", "model: both", "measured: field",
            "measured: joints and ridges", "measured: whole job",
            "Amdahl (model): speed-up of the whole job", "Amdahl (model): efficiency"]
    counts = ", ".join(f"{v['count']} tasks of {k} ({v['sum_s']:.2f} s, longest "
                       f"{1000 * v['longest_s']:.2f} ms)" for k, v in data["tasks"].items())
    return [f"**Model, not measured.** {data['case']}: {counts}. Their times, measured one by one "
            "on one thread, are handed in order to the core that is idle first; efficiency = sum "
            "/ (cores x last end). The model knows nothing of memory bandwidth, shared caches, "
            "clock rates, the scheduler's own cost and of the barriers between the batches in "
            "which candidates come, so it is what load balance alone allows.", "",
            f"The Amdahl columns take everything but {', '.join(IN_TASKS)} as serial: "
            f"{data['parallel_share']:.1%} of the whole precompute job is in these stages, and "
            "that limits its speed-up, whatever the columns to the left say.", "",
            *table(head, body)]


PARTS = {"strong": (strong, "Strong scaling: one site, more threads"),
         "weak": (weak, "Weak scaling: 1 km2 of generated city per thread, precompute"),
         "crops": (crops, "The paper's crops, one thread, whole job"),
         "city": (city, "Growth of a city, precompute"),
         "model": (model, "Model: load balance on more cores than this machine has")}


# --- results ------------------------------------------------------------------------------------


def proc_value(file, key):
    for line in Path(file).read_text().splitlines():
        if line.startswith(key):
            return line.split(":", 1)[1].strip()
    return "unknown"


def compiler_of(program):
    """Compiler and flags of the program's main file, from what CMake left beside it."""
    try:
        for entry in json.loads((program.parent / "compile_commands.json").read_text()):
            if entry["file"].endswith("engine/main.cpp"):
                words = [w for w in entry["command"].split() if not w.endswith("ccache")]
                flags = [w for w in words if w.startswith(("-O", "-D", "-f", "-m", "-std"))]
                name = subprocess.run([words[0], "--version"], capture_output=True, text=True,
                                      check=False).stdout.splitlines()[0]
                return name, " ".join(flags)
    except (OSError, ValueError, LookupError):
        pass
    return "unknown", "unknown"


def machine(bench):
    compiler, flags = compiler_of(bench.args.program)
    return {"processor": proc_value("/proc/cpuinfo", "model name"),
            "processors_granted": bench.granted,
            "memory_mb": int(proc_value("/proc/meminfo", "MemTotal").split()[0]) // 1024,
            "kernel": f"{os.uname().sysname} {os.uname().release}",
            "load_average_at_start": os.getloadavg()[0],
            "program": bench.call(bench.args.program, "--version").strip(),
            "compiler": compiler, "compiler_flags": flags, "repeat": bench.args.repeat,
            "date_utc": datetime.datetime.now(datetime.timezone.utc).isoformat("T", "seconds")}


def write_results(bench, about, fits, lines):
    out = bench.args.out
    for name, data in (("machine.json", about), ("fits.json", fits)):
        (out / name).write_text(json.dumps(data, indent=2) + "\n")
    columns = list(dict.fromkeys(k for r in bench.rows for k in r))
    with open(out / "scaling.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        for r in bench.rows:
            writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in r.items()})
    (out / "summary.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    try:
        import scaling_plot
    except ImportError as e:
        say(f"no plot: {e}; apt-get install python3-matplotlib")
        return
    scaling_plot.draw(bench.rows, fits, PAPER, out / "scaling.svg")
