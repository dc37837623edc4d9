#!/usr/bin/python3
"""Sites that are as hard as sites can be, each planned and verified within a time limit, or refused at
once where the program's own estimate is beyond it.

Prints one table (Markdown): a row per scene. Figures are from the run's summary.json, processor time
and memory from the operating system, over the whole process. A run that is refused says why below.
"""
import argparse
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
JOB = """preset = "outdoor"
[site]
input = "site.geojson"
[scanner]
range_max_m = {range_m}
[field]
cell_m = {cell_m}
"""


def feature(cls, kind, coordinates):
    return ('{"type":"Feature","properties":{"class":"%s"},"geometry":{"type":"%s","coordinates":%s}}'
            % (cls, kind, coordinates))


def ring(points):
    closed = [*points, points[0]]
    return "[[" + ",".join(f"[{x:.3f},{y:.3f}]" for x, y in closed) + "]]"


def square(x, y, side):
    return ring([(x, y), (x + side, y), (x + side, y + side), (x, y + side)])


def star(walls):
    """Walls from one point outwards, 5 to 60 m long."""
    dice = random.Random(1)
    for k in range(walls):
        a = 2 * math.pi * k / walls
        r = dice.uniform(5, 60)
        yield feature("wall", "LineString",
                      f"[[0,0],[{r * math.cos(a):.3f},{r * math.sin(a):.3f}]]")


def crossing(walls):
    """Walls right through one point: all cross all others there."""
    dice = random.Random(2)
    for k in range(walls // 2):
        a = math.pi * k / (walls // 2)
        r, s = dice.uniform(5, 60), dice.uniform(5, 60)
        x, y = math.cos(a), math.sin(a)
        yield feature("wall", "LineString",
                      f"[[{r * x:.3f},{r * y:.3f}],[{-s * x:.3f},{-s * y:.3f}]]")


def comb(teeth):
    """One building with teeth 0.1 m wide and 10 m long, 0.1 m apart."""
    points = [(0.2 * teeth, -5.0), (0.0, -5.0)]
    for k in range(teeth):
        x = 0.2 * k
        points += [(x, 10.0), (x + 0.1, 10.0), (x + 0.1, 0.0), (x + 0.2, 0.0)]
    yield feature("building", "Polygon", ring(points))


def pillars(side):
    """Pillars of 0.4 m, 2 m apart."""
    for j in range(side):
        for i in range(side):
            yield feature("building", "Polygon", square(2.0 * i, 2.0 * j, 0.4))


def outline(vertices):
    """One building with a rough outline, 5 km around its centre: 3 cm and more a side."""
    dice = random.Random(3)
    points = []
    for k in range(vertices):
        a = 2 * math.pi * k / vertices
        r = 5000 * (1 + 0.2 * math.sin(5 * a)) + dice.uniform(-0.1, 0.1)
        points.append((r * math.cos(a), r * math.sin(a)))
    yield feature("building", "Polygon", ring(points))


def line(buildings):
    """Buildings of 10 m, 5 m apart, along a line."""
    for k in range(buildings):
        yield feature("building", "Polygon", square(15.0 * k, 0.0, 10.0))


# Name: what it is, how it is made, how many of them, side of cells and range in metres.
SCENES = {
    "star": ("walls that end in one point", star, 10_000, 0.5, 50),
    "crossing": ("walls that cross in one point", crossing, 10_000, 0.5, 50),
    "comb": ("teeth of a comb", comb, 30_000, 1, 50),
    "pillars": ("pillars in a square", lambda n: pillars(math.isqrt(n)), 160_000, 1, 50),
    "outline": ("vertices of a polygon", outline, 1_000_000, 2, 50),
    "line": ("buildings in a line", line, 1_000_000, 2, 50),
}


def write_site(path, features):
    with open(path, "w", encoding="ascii") as file:
        file.write('{"type":"FeatureCollection","units":"m","features":[\n')
        for k, f in enumerate(features):
            file.write((",\n" if k else "") + f)
        file.write("\n]}\n")


def timed(words, limit_s):
    """Exit code (None: it was stopped), what it printed, wall and processor time in s, peak in MB."""
    begin = time.monotonic()
    with tempfile.TemporaryFile("w+") as said:
        child = subprocess.Popen([str(w) for w in words], stdout=said, stderr=subprocess.STDOUT)
        stopped = False
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() - begin > limit_s and not stopped:
                child.terminate()
                stopped = True
            time.sleep(0.02)
        child.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read()
    return (None if stopped else child.returncode, text, time.monotonic() - begin,
            usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def row(name, count, args, folder):
    what, make, default, cell_m, range_m = SCENES[name]
    count = count or default
    write_site(folder / "site.geojson", make(count))
    job = folder / "job.toml"
    job.write_text(JOB.format(cell_m=cell_m, range_m=range_m))
    out = folder / "run"
    code, said, wall_s, cpu_s, peak_mb = timed(
        [args.program, "run", job, "--out", out, "--threads", args.threads, "-q", "--time",
         f"{args.limit_s}s", *args.more],
        args.limit_s)
    cells = [f"{count:,} {what}"]
    why = ""
    good = code == 0
    if good:
        s = json.loads((out / "summary.json").read_text())
        cells += [f"{s['site']['walls']:,}", f"{s['grid']['cells']:,}", f"{s['candidates']:,}",
                  f"{s['stations']:,}"]
        ends = timed([args.program, "verify", out, "-q"], args.limit_s)
        good = ends[0] == 0
        held = f"{'yes' if good else 'NO'}, {ends[2]:.0f} s"
        if args.stages:
            why = "  " + ", ".join(f"{k} {v:.1f}" for k, v in s["stage_cpu_s"].items() if v > 0.5)
    else:
        good = code == 2
        held = "refused" if good else f"exit code {code}"
        why = said.strip()
        cells += ["", "", "", ""]
    wall = f"{wall_s:.1f} s" if code is not None else f"stopped after {args.limit_s} s"
    cells += [wall, f"{cpu_s:.1f} s", f"{peak_mb:,.0f}", held]
    return "| " + " | ".join(cells) + " |", why, good


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", metavar="SCENE[:COUNT]", default=list(SCENES),
                        help=f"of {', '.join(SCENES)}; COUNT instead of the count of the table")
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/vfplan")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--limit-s", type=int, default=600)
    parser.add_argument("--stages", action="store_true", help="processor time of stages below")
    parser.add_argument("--keep", type=Path, help="folder that keeps sites and runs")
    parser.add_argument("--more", nargs="*", default=[], help="further words for vfplan run")
    args = parser.parse_args()
    head = ["scene", "walls", "cells", "candidates", "stations", "wall", "processor", "peak, MB",
            "verify"]
    print("| " + " | ".join(head) + " |\n" + "|" + " --- |" * len(head), flush=True)
    notes = []
    all_good = True
    for scene in args.scene:
        name, _, count = scene.partition(":")
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            if args.keep:
                folder = args.keep / name
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir(parents=True)
            text, why, good = row(name, int(count or 0), args, folder)
        print(text, flush=True)
        if why:
            notes.append(f"{name}: {why}")
        all_good = all_good and good
    print("\n" + "\n".join(notes))
    return 0 if all_good else 1


if __name__ == "__main__":
    sys.exit(main())
