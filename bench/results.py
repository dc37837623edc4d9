"""Results of the benchmark suites: running them, reading what they say."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SUITES = ROOT / "build" / "bench"


def suites(folder=SUITES):
    found = sorted(p for p in folder.glob("bench_*") if p.is_file() and os.access(p, os.X_OK))
    if not found:
        sys.exit(f"{folder}: no benchmarks there; make bench builds them")
    return found


def run(arguments, environment=None, folder=SUITES):
    """Runs every suite with the arguments; returns its context and a dictionary by benchmark
    name, with the least processor time where a benchmark was repeated."""
    results = {}
    context = {}
    for suite in suites(folder):
        with tempfile.TemporaryDirectory() as scratch:
            out = pathlib.Path(scratch) / "out.json"
            command = [str(suite), f"--benchmark_out={out}", *arguments]
            done = subprocess.run(command, env={**os.environ, **(environment or {})},
                                  stdout=sys.stderr, check=False)
            if done.returncode != 0:
                sys.exit(f"{suite.name}: ended with exit code {done.returncode}")
            if not out.exists() or not out.stat().st_size:
                continue  # no benchmark of this suite was asked for
            read = json.loads(out.read_text())
        context = read["context"]
        for b in read["benchmarks"]:
            if b.get("run_type") == "aggregate":
                continue
            name = b.get("run_name", b["name"])
            if name in results and b.get("cpu_time", 0) >= results[name].get("cpu_time", 0):
                continue
            results[name] = b
    if not results:
        sys.exit("no benchmark matches the arguments")
    return context, results


def failed(results):
    """Names and messages of benchmarks whose answer was wrong; missing data is not an error."""
    return [(name, b["error_message"]) for name, b in results.items()
            if b.get("error_occurred") and not b["error_message"].startswith("no data")]
