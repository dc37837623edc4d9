#!/usr/bin/env python3
"""Compares the benchmarks with bench/baseline.json and fails where they got worse.

Usage: bench/check.py [--counts] [--record]

Counts do not depend on the machine: they are taken under VFPLAN_ISA=sse2, on generated sites. Counts
of results (stations, links, digests) must be as they were; counts of work may not grow by more than
10 %; a wrong answer fails, and so does a figure without its counterpart in the baseline. Without
--counts processor times are compared too, as multiples of the suites' own calibration loop: more
than 30 % up fails. --record writes a new baseline; the commit that does so says why.
"""

import json
import pathlib
import sys

import results as bench

BASELINE = pathlib.Path(__file__).resolve().parent / "baseline.json"
SITES = "(town|city|flat)"
RESULTS = ("cells", "spans", "rows", "entries", "links", "candidates", "stations", "digest")
WORK = ("packets", "steps", "walls", "rays")
COUNTS_MAY_GROW = 1.10
TIME_MAY_GROW = 1.30
ERRORS = ("error_mean", "error_p999", "error_max")
ERRORS_ARE_NOTHING = 1e-9


def measure(with_times):
    wanted = f"--benchmark_filter=^(exact|embree|stage)_.*/{SITES}"
    _, found = bench.run([wanted, "--benchmark_min_time=0"], {"VFPLAN_ISA": "sse2"})
    now = {name: {k: b[k] for k in RESULTS + WORK + ERRORS if k in b} for name, b in found.items()
           if not b.get("error_occurred")}
    wrong = bench.failed(found)
    if with_times:
        _, timed = bench.run([wanted.replace("^(", "^calibration|^("), "--benchmark_repetitions=5"])
        unit = timed["calibration"]["cpu_time"]
        for name, b in timed.items():
            if name in now:
                now[name]["time"] = b["cpu_time"] / unit
        wrong += bench.failed(timed)
    return now, wrong


def worse(name, key, was, now):
    """Why `now` is not acceptable, or None."""
    if key in ERRORS:
        bad = now > max(1.1 * was, ERRORS_ARE_NOTHING)
        return f"{name}: {key} {was:.2e} -> {now:.2e} rad" if bad else None
    if key in RESULTS:
        return None if now == was else f"{name}: {key} {was:.9g} -> {now:.9g}, another result"
    limit = TIME_MAY_GROW if key == "time" else COUNTS_MAY_GROW
    return f"{name}: {key} {was:.6g} -> {now:.6g}, x {now / was:.2f}" if now > limit * was else None


def main(arguments):
    if {"-h", "--help"} & set(arguments):
        print(__doc__)
        return 0
    unknown = set(arguments) - {"--counts", "--record"}
    if unknown:
        print(__doc__, file=sys.stderr)
        return 2
    now, wrong = measure("--counts" not in arguments)
    problems = [f"{name}: {message}" for name, message in wrong]
    if "--record" in arguments:
        if problems:
            print("\n".join(problems), file=sys.stderr)
            return 1
        BASELINE.write_text(json.dumps(now, indent=1, sort_keys=True) + "\n")
        print(f"{BASELINE.name}: {len(now)} benchmarks recorded")
        return 0
    baseline = json.loads(BASELINE.read_text())
    problems += [f"{name}: in the baseline, but it did not run" for name in baseline
                 if name not in now]
    compared = 0
    for name, measures in now.items():
        known = baseline.get(name, {})
        problems += [f"{name}: {key} is in the baseline, but it was not measured"
                     for key in known if key not in measures and key != "time"]
        for key, value in measures.items():
            was = known.get(key)
            if was is None:
                problems.append(f"{name}: {key} is not in the baseline; record a new one")
                continue
            compared += 1
            problems += filter(None, [worse(name, key, was, value)])
            if key in WORK and value < was / COUNTS_MAY_GROW:
                print(f"{name}: {key} {was:.6g} -> {value:.6g}: better; record a new baseline?")
    print(f"bench-check: {compared} figures of {len(now)} benchmarks compared with the baseline, "
          f"{len(problems)} worse.")
    for p in problems:
        print("  " + p, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
