#!/usr/bin/python3
"""What plans come to: Algorithm 1 of the paper, refined and certified plans, on every site there is.

Prints a table (Markdown) for each group of sites, a row a site and a source of candidates: stations,
stations off a cycle, WAPL, bridges and seconds of the greedy plan (Algorithm 1, loops added) and of
the refined one; then without loops the refined plan, the certified one, its bound and its gap. Every
figure is from a plan's summary.json; every plan has passed `vfplan verify`. Seconds are processor
seconds of stage "plan". The art-gallery instances stand beside the optima that their authors give.

Tables are made once for each site, in --work, and used again; plans are made again each time.
"""
import argparse
import csv
import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OPEN = ["plan.loops=false"]
PLANS = {  # name: what is set
    "greedy": ["plan.method=greedy"],
    "refined": ["plan.method=refined"],
    "joined": ["plan.method=refined", *OPEN],
    "certified": ["plan.method=certified", *OPEN],
}


def groups(data, work, program, seeds):
    """Name, sites; a site is its name, job file and what is set."""
    def generated(kind, seed, job, *sets):
        site = work / f"{kind}-{seed}.geojson"
        if not site.exists():
            subprocess.run([program, "generate", kind, "--seed", str(seed), "--out", site],
                           check=True, stdout=subprocess.DEVNULL)
        return (site.stem, job, [f"site.input={site}", *sets])

    def real(path, job, *sets):
        return (path.stem, job, [f"site.input={path}", *sets])

    towns = ["bellevue/bellevue_976x893", "bellevue/bellevue_b_976x893",
             "karhula/karhula_976x893", "helsinki_centre/helsinki_centre_full",
             "monaco/monaco_full"]
    yield "generated", [generated("town", s, "town") for s in range(1, seeds + 1)] + [
        generated("flat", s, "flat") for s in range(1, seeds + 1)]
    yield "towns", [real(data / f"town_{t}.geojson", "town") for t in towns]
    yield "offices", [real(p, "office") for p in
                      sorted((data / "plans_offices_schools").glob("*.geojson"))]
    yield "homes", [real(data / "plan_houseexpo/houseexpo_0a1b29db.geojson", "office"),
                    real(data / "plan_house_overland/house_overland.geojson", "office")]
    yield "agp", [gallery(p) for p in sorted((data / "agp").rglob("*.geojson"),
                                             key=lambda p: (p.parent.name, p.stat().st_size))
                  if p.with_suffix(".pol").stat().st_size < 20000]


def gallery(path):
    """An art gallery: no range, no overlap asked for, walls cut finely. Its units are abstract, so
    that its longer side is taken to be 100 m."""
    text = json.loads(path.read_text())
    points = []

    def walk(c):
        if isinstance(c[0], (int, float)):
            points.append(c)
        else:
            for part in c:
                walk(part)

    for feature in text["features"]:
        walk(feature["geometry"]["coordinates"])
    side = max(max(p[k] for p in points) - min(p[k] for p in points) for k in (0, 1))
    return (path.stem, "office",
            [f"site.input={path}", f"site.unit_m={100 / side!r}", "scanner.range_min_m=0",
             "scanner.range_max_m=1000", "field.cell_m=0.2", "field.threshold_rad=0",
             "coverage.partition_m=0.25", "coverage.visible_fraction=1",
             "overlap.threshold=1e-6", "site.min_width_m=0", "site.clearance_m=0",
             "plan.loops=false"])


def call(words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.returncode}\n{done.stderr[-600:]}")


def with_sets(sets):
    return [w for s in sets for w in ("--set", s)]


def plan(program, tables, out, sets, threads):
    call(["rm", "-rf", out])
    call([program, "plan", tables, "--out", out, "--threads", threads, "-q",
          *with_sets([*sets, "output.formats=['csv','certificate']"])])
    call([program, "verify", out, "--threads", threads, "-q"])
    return json.loads((out / "summary.json").read_text())


def measured(program, site, pool, work, plans, threads):
    name, job, sets = site
    tables = work / name / "tables"
    call([program, "precompute", ROOT / f"configs/{job}.toml", "--out", tables, "--threads",
          threads, "-q", *with_sets([*sets, "plan.candidates=axis", "output.formats=['csv']"])])
    return {p: plan(program, tables, work / name / f"{pool}-{p}",
                    [f"plan.candidates={pool}", *PLANS[p]], threads) for p in plans}


def row(name, pool, s, optimum):
    def part(plan, keys):
        if plan not in s:
            return ["-"] * len(keys)
        one = s[plan]
        values = {"stations": one["stations"], "off": one["plan"]["off_cycle"],
                  "wapl": f"{one['wapl']:.2f}", "bridges": one["bridges"],
                  "seconds": f"{one['stage_cpu_s']['plan']:.1f}",
                  "bound": one["bound_connected"], "gap": f"{100 * one['gap_connected']:.1f} %"}
        return [values[k] for k in keys]

    every = ["stations", "off", "wapl", "bridges", "seconds"]
    any_plan = next(iter(s.values()))
    return [name, pool, any_plan["candidate_pool"]["candidates"], any_plan["networks"],
            *part("greedy", every), *part("refined", every), *part("joined", ["stations", "seconds"]),
            *part("certified", ["stations", "bound", "gap", "seconds"]),
            *([optimum] if optimum is not None else [])]


HEAD = ["site", "candidates from", "candidates", "networks"] + [
    f"{p}: {k}" for p in ("Algorithm 1", "refined")
    for k in ("stations", "off cycle", "WAPL", "bridges", "s")] + [
    "refined, no loops", "s", "certified, no loops", "bound", "gap", "s"]


def sums(done):
    """In words: stations in all, and how often refined plans are shorter to walk in WAPL."""
    for pool in sorted({pool for _, pool, _ in done}):
        some = [s for _, p, s in done if p == pool]
        for plan_name in PLANS:
            have = [s[plan_name] for s in some if plan_name in s]
            if have:
                bound = sum(s["bound_connected"] for s in have)
                print(f"- {pool}, {plan_name}: {sum(s['stations'] for s in have):,} stations on "
                      f"{len(have)} sites, bound {bound:,}, off a cycle "
                      f"{sum(s['plan']['off_cycle'] for s in have)}, closed "
                      f"{sum(s['bound_connected'] == s['stations'] for s in have)}")
        both = [(s["greedy"], s["refined"]) for s in some if "greedy" in s and "refined" in s]
        if both:
            good = sum(r["wapl"] <= g["wapl"] and r["stations"] <= g["stations"] for g, r in both)
            print(f"- {pool}: WAPL of refined not above Algorithm 1's at no more stations on "
                  f"{good} of {len(both)} sites")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    data = Path(os.environ.get("VFPLAN_DATA", ROOT.parent / "shared/data"))
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/vfplan")
    parser.add_argument("--data", type=Path, default=data)
    parser.add_argument("--work", type=Path, default=ROOT / "runs/plans")
    parser.add_argument("--groups", nargs="*", help="some of: generated towns offices homes agp")
    parser.add_argument("--pools", nargs="*", default=["axis", "pool"])
    parser.add_argument("--plans", nargs="*", default=list(PLANS))
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    args = parser.parse_args()
    args.work.mkdir(parents=True, exist_ok=True)
    optima = {}
    if (args.data / "agp/optima.csv").exists():
        with open(args.data / "agp/optima.csv", newline="", encoding="utf-8") as f:
            optima = {r["instance"]: r["point_guard_optimum"] or "unknown"
                      for r in csv.DictReader(f)}
    failed = 0
    for group, sites in groups(args.data, args.work.resolve(), args.program, args.seeds):
        if args.groups and group not in args.groups:
            continue
        head = HEAD + (["known optimum"] if group == "agp" else [])
        print(f"\n## {group}\n\n| " + " | ".join(head) + " |\n" + "|" + " --- |" * len(head),
              flush=True)
        done = []
        for site in sites:
            for pool in args.pools:
                plans = [p for p in args.plans if group != "agp" or p in ("joined", "certified")]
                try:
                    s = measured(args.program, site, pool, args.work.resolve(), plans,
                                 args.threads)
                except RuntimeError as error:
                    failed += 1
                    print(error, file=sys.stderr, flush=True)
                    continue
                done.append((site[0], pool, s))
                cells = row(site[0], pool, s, optima.get(site[0], "unknown")
                            if group == "agp" else None)
                print("| " + " | ".join(map(str, cells)) + " |", flush=True)
        print()
        sums(done)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
