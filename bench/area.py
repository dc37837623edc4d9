#!/usr/bin/python3
"""How memory and time grow with the area: `vfplan run` on windows of a city and on a whole county.

Prints one table (Markdown): a row per site, with the peak memory of the stages that make field and
coverage, of those that hold the whole site or plan, and of all; times; disk. Every figure is from
the run's summary.json, the last column from the folder.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
JOB = """preset = "outdoor"
[site]
input = "{site}"
{crop}
[scanner]
range_min_m = 1.2
range_max_m = 75
[field]
cell_m = 2
[coverage]
partition_m = 1
[overlap]
threshold = 0.3
[plan]
candidates = "axis"
[output]
formats = ["csv"]
"""
# The parts of a run that work tile by tile.
TILED = {"field": ("field",), "skeleton": ("skeleton",),
         "candidates": ("joints", "splits", "rescues"),
         "connectors": ("components", "paths", "connectors", "disputed", "joins"),
         "coverage": ("coverage",)}
WHOLE = {"site": ("site",), "ridges": ("ridges",), "tables": ("tables",),
         "plan": ("read", "overlap", "plan", "metrics", "join_thresholds", "files", "hash")}


def centre_of(site):
    """Of the boxes of all features: GeoJSON in metres, a feature a line or not."""
    xs, ys = [], []
    for feature in json.loads(site.read_text())["features"]:
        ring = feature["geometry"]["coordinates"][0]
        while not isinstance(ring[0][0], (int, float)):
            ring = ring[0]
        xs.append(ring[0][0])
        ys.append(ring[0][1])
    return (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2


def run(program, site, crop, folder, threads):
    job = folder / "job.toml"
    job.write_text(JOB.format(site=site, crop=f"crop_m = {crop}" if crop else ""))
    out = folder / "run"
    subprocess.run([program, "run", job, "--out", out, "--threads", str(threads), "--fresh", "-q"],
                   check=True)
    summary = json.loads((out / "summary.json").read_text())
    disk = sum(p.stat().st_size for p in out.rglob("*") if p.is_file())
    return summary, disk


def row(name, s, disk):
    peaks = s["stage_peak_rss_mb"]

    def peak(stages):
        return f"{max(peaks.get(k, 0) for k in stages):.0f}"

    cells = [name, f"{s['site']['buildings']:,}", f"{s['grid']['cells'] / 1e6:.1f}",
             f"{s['candidates']:,}", f"{s['stations']:,}"]
    cells += [peak(stages) for stages in TILED.values()]
    cells += [peak(stages) for stages in WHOLE.values()]
    minutes, seconds = divmod(s["wall_s"], 60)
    wall = f"{seconds:.0f} s" if minutes == 0 else f"{minutes:.0f}:{seconds:02.0f} min"
    cells += [f"{s['peak_rss_mb']:.0f}", wall, f"{sum(s['stage_cpu_s'].values()):.0f} s",
              f"{disk / 1e6:,.0f}"]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    data = Path(os.environ.get("VFPLAN_DATA", ROOT.parent / "shared/data")) / "city_allegheny"
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/vfplan")
    parser.add_argument("--city", type=Path, default=data / "allegheny_core_5km.geojson")
    parser.add_argument("--county", type=Path, default=data / "allegheny_north.geojson.gz")
    parser.add_argument("--km2", type=float, nargs="*", default=[1, 4, 16, 25])
    parser.add_argument("--no-county", action="store_true")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    args = parser.parse_args()
    x, y = centre_of(args.city)
    head = ["area", "buildings", "cells, M", "candidates", "stations"]
    head += [f"{k}, MB" for k in (*TILED, *WHOLE)] + ["peak, MB", "wall", "processor", "disk, MB"]
    print("| " + " | ".join(head) + " |\n" + "|" + " --- |" * len(head), flush=True)
    jobs = [(f"{k:g} km2", args.city,
             None if k >= 25 else [x - 500 * k**0.5, y - 500 * k**0.5,
                                   x + 500 * k**0.5, y + 500 * k**0.5]) for k in args.km2]
    if not args.no_county:
        jobs.append(("county", args.county, None))
    for name, site, crop in jobs:
        with tempfile.TemporaryDirectory() as folder:
            print(row(name, *run(args.program, site, crop, Path(folder), args.threads)),
                  flush=True)


if __name__ == "__main__":
    sys.exit(main())
