#!/usr/bin/env python3
"""Runs the benchmark suites and prints one table: this project, its peers, the ratio, the error.

Usage: bench/table.py [--out FILE.md] [arguments for the suites]
"""

import pathlib
import sys

import results as bench

# site, ours, peer, what the peer is
PAIRS = [
    ("exact_field", "cgal_views", "CGAL triangular expansion", ("bellevue", "town", "city")),
    ("exact_field", "sweep_views", "rotational sweep", ("bellevue", "town", "city")),
    ("exact_views", "cgal_views", "CGAL triangular expansion", ("bellevue", "town", "city")),
    ("exact_views", "sweep_views", "rotational sweep", ("bellevue", "town", "city")),
    ("embree_field", "cgal_views", "CGAL triangular expansion", ("bellevue", "town", "city")),
]
RAYS = ["128", "0", "512", "1024"]  # 0: what a job of that site takes


def seconds(s):
    for unit, size in (("s", 1), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)):
        if s >= size:
            return f"{s / size:.3g} {unit}"
    return f"{s / 1e-12:.3g} ps"


def error(name, b):
    """What the benchmark itself compared, and with what."""
    if "error_mean" in b:
        return (f"exact: mean {b['error_mean']:.1e}, 99.9 % {b['error_p999']:.1e}, "
                f"max {b['error_max']:.1e}")
    against = {"exact_field": "CGAL", "exact_views": "own field", "sweep_views": "exact"}[name]
    return f"{against}: max {b['error_max']:.1e}"


def row(cells):
    return "| " + " | ".join(cells) + " |"


def compare(found):
    lines = [row(["per cell", "site", "this project", "peer", "peer's time", "ratio",
                  "checked against, rad"]), row(["---"] * 7)]
    for ours, peer, title, sites in PAIRS:
        for site in sites:
            mine = found.get(f"{ours}/{site}") or found.get(f"{ours}/{site}/0")
            other = found.get(f"{peer}/{site}")
            if not mine or not other or "s_per_cell" not in mine or "s_per_cell" not in other:
                continue
            a, b = mine["s_per_cell"], other["s_per_cell"]
            lines.append(row([ours.replace("_", " "), site, seconds(a), title, seconds(b),
                              f"{b / a:.3g} x",
                              error(peer, other) if peer == "sweep_views" else error(ours, mine)]))
    return lines


def rays(found):
    lines = [row(["rays first", "rays per cell", "embree field", "bare packets, as many rays",
                  "field / bare", "Embree quads, as many rays", "field / quads",
                  "checked against, rad"]), row(["---"] * 8)]
    quads = found.get("bare_quads/bellevue/512")
    for r in RAYS:
        mine = found.get(f"embree_field/bellevue/{r}")
        bare = found.get(f"bare_packets/bellevue/{r}")
        if not mine or not bare or not quads or "s_per_cell" not in mine:
            continue
        a, b = mine["s_per_cell"], bare["s_per_cell"]
        q = quads["s_per_cell"] / quads["rays_per_cell"] * mine["rays_per_cell"]
        lines.append(row([f"{mine['rays_first']:.0f}", f"{mine['rays_per_cell']:.0f}", seconds(a),
                          seconds(b), f"{a / b:.2f}", seconds(q), f"{a / q:.2f}",
                          error("embree_field", mine)]))
    return lines


def stages(found):
    lines = [row(["stage, one thread", "site", "time", "per item", "items"]), row(["---"] * 5)]
    for name, b in found.items():
        if name.startswith("stage_") and "s_per_item" in b:
            stage, site = name.split("/")
            item = next(k for k in ("rows", "candidates", "cells") if k in b)
            lines.append(row([stage[6:].replace("_", " "), site, seconds(b["cpu_time"] * 1e-3),
                              seconds(b["s_per_item"]), f"{b[item]:.0f} {item}"]))
    return lines


def main(arguments):
    if {"-h", "--help"} & set(arguments):
        print(__doc__)
        return 0
    out = None
    if arguments[:1] == ["--out"]:
        out, arguments = pathlib.Path(arguments[1]), arguments[2:]
    # Sets are none of this table's, and their 25 km2 would take minutes.
    context, found = bench.run(arguments or ["--benchmark_filter=-^sets_"])
    head = (f"vfplan {context.get('vfplan', '?')} ({context.get('build', '?')}), "
            f"{context['num_cpus']} processors of {context['mhz_per_cpu']} MHz, load "
            f"{context['load_avg'][0]:.2f}, processor time, one thread")
    text = "\n".join([head, "", *compare(found), "", "Bellevue, rays:", "", *rays(found), "",
                      *stages(found), ""])
    print(text)
    if out:
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(text)
    wrong = bench.failed(found)
    for name, message in wrong:
        print(f"{name}: {message}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
