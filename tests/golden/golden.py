#!/usr/bin/env python3
"""Runs whole jobs on generated sites and compares everything they leave, array by array, with
tests/golden/hashes.json: what a change of the code must not change.

    golden.py check PROGRAM         compare; exit code 1 and the names of what differs (ctest calls this)
    golden.py renew PROGRAM         write hashes.json anew, after a change that is meant (make golden)
    golden.py same DIR DIR          compare two run directories
                [--renamed OLD=NEW] a dataset that has another name in the second one; repeatable

hashes.json also holds the version of what tables mean (tables_version, engine/folder/run_dir.h), which keeps
a run from going on with another program's shards: where tables change and it does not, both commands fail.

Compared are all datasets of field.h5, coverage.h5, pool.h5 and plan.h5, read through their indices (type, shape
and bytes), the CSV and GeoJSON files, and result_sha256. Left out are attributes, which hold the job's
key, and the checksums of shards, which hold the shards' attributes.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile

import h5py

HERE = os.path.dirname(os.path.abspath(__file__))
HASHES = os.path.join(HERE, "hashes.json")
TABLES = ["field.h5", "coverage.h5", "pool.h5", "plan.h5"]
TEXTS = ["stations.csv", "stations.geojson", "links.csv", "pieces.csv"]
CHECKSUMS = ["tile_sha256"]

SITES = {
    "town": ["town", "--seed", "1"],
    "city": ["city", "--seed", "5", "--size-km", "0.5"],
    "flat": ["flat", "--seed", "3"],
    "large_flat": ["flat", "--seed", "8", "--rooms", "9"],
}
OUTDOOR = ["preset=outdoor", "field.cell_m=2"]
TOWN = OUTDOOR + ["scanner.range_min_m=0.6", "scanner.range_max_m=600", "coverage.partition_m=5"]
INDOOR = ["preset=indoor", "field.cell_m=0.05"]
POINTS = ["plan.required=[[30.5, 200.25], [255, 255.1]]", "plan.existing=[[210, 40.5]]"]

# name: site, settings
JOBS = {
    "town": ("town", TOWN),
    "town_embree": ("town", TOWN + ["visibility.kernel=embree"]),
    "town_greedy_without_loops": ("town", TOWN + ["plan.method=greedy", "plan.loops=false"]),
    "town_by_angle": ("town", TOWN + ["overlap.ratio=union_ang", "overlap.threshold=0.4"]),
    "city": ("city", OUTDOOR),
    "city_embree": ("city", OUTDOOR + ["visibility.kernel=embree", "field.tile_cells=100"]),
    "city_tiles": ("city", OUTDOOR + ["field.tile_cells=64"]),
    "city_incidence": ("city", OUTDOOR + ["scanner.max_incidence_deg=70", "overlap.ratio=mean_ang",
                                          "coverage.visible_fraction=0.9"]),
    "city_points": ("city", OUTDOOR + POINTS + ["site.clearance_m=0.4", "overlap.ratio=min_len"]),
    "city_apart": ("city", OUTDOOR + ["scanner.range_max_m=20", "overlap.threshold=0.6"]),
    "flat": ("flat", INDOOR),
    "flat_closed": ("flat", INDOOR + ["site.doors=closed", "site.windows=opening"]),
    "flat_embree": ("flat", INDOOR + ["visibility.kernel=embree", "site.windows=ignore"]),
    "large_flat": ("large_flat", INDOOR + ["overlap.threshold=0.7", "overlap.ratio=union_len"]),
}


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def digest(run):
    """Name -> hash of everything in a run directory that is compared."""
    out = {}
    for table in TABLES:
        path = os.path.join(run, table)
        if not os.path.exists(path):
            continue
        with h5py.File(path, "r") as file:
            def visit(name, thing):
                if not isinstance(thing, h5py.Dataset) or name in CHECKSUMS:
                    return
                data = thing[()]
                head = f"{thing.dtype.str} {thing.shape} ".encode()
                out[f"{table}/{name}"] = sha256(head + data.tobytes())
            file.visititems(visit)
    for text in TEXTS:
        path = os.path.join(run, text)
        if os.path.exists(path):
            with open(path, "rb") as file:
                out[text] = sha256(file.read())
    with open(os.path.join(run, "summary.json"), encoding="utf-8") as file:
        out["result_sha256"] = json.load(file).get("result_sha256", "")
    return out


def differences(wanted, got):
    """Lines that say what differs."""
    for name in sorted(set(wanted) | set(got)):
        if name not in got:
            yield f"{name} is missing"
        elif name not in wanted:
            yield f"{name} is new"
        elif wanted[name] != got[name]:
            yield f"{name} differs"


def version_of(run):
    """What the first line of a job.toml says: "# job HASH tables VERSION"."""
    with open(os.path.join(run, "job.toml"), encoding="utf-8") as file:
        return int(file.readline().split(" tables ")[1])


def check_version(wanted, got):
    """A line where tables (not plans) differ and their version is the same."""
    if wanted.get("tables_version") != got["tables_version"]:
        return []
    changed = [f"{job}: {line}" for job in JOBS
               for line in differences(wanted.get(job, {}), got.get(job, {}))
               if line.startswith(("field.h5", "coverage.h5", "pool.h5"))]
    return changed[:1] and [f"{changed[0]}, and so tables_version in engine/folder/run_dir.h must be "
                            f"another than {got['tables_version']}"]


def run_job(program, folder, name):
    site, settings = JOBS[name]
    site_file = os.path.join(folder, site + ".geojson")
    if not os.path.exists(site_file):
        subprocess.run([program, "generate", *SITES[site], "--out", site_file], check=True,
                       stdout=subprocess.DEVNULL)
    job = os.path.join(folder, name + ".toml")
    with open(job, "w", encoding="utf-8") as file:
        file.write(f'[site]\ninput = "{site}.geojson"\n[output]\nformats = ["csv", "geojson"]\n')
    command = [program, "run", job, "--out", os.path.join(folder, name), "--quiet", "--threads", "2"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True)
    run = os.path.join(folder, name)
    return {**digest(run), "version": version_of(run)}


def all_jobs(program):
    with tempfile.TemporaryDirectory(prefix="vfplan-golden-") as folder:
        out = {name: run_job(program, folder, name) for name in JOBS}
    versions = {digests.pop("version") for digests in out.values()}
    assert len(versions) == 1, versions
    return {"tables_version": versions.pop(), **out}


def check(program):
    with open(HASHES, encoding="utf-8") as file:
        wanted = json.load(file)
    got = all_jobs(program)
    bad = [f"{job}: {line}" for job in JOBS
           for line in differences(wanted.get(job, {}), got.get(job, {}))]
    bad += check_version(wanted, got)
    if wanted.get("tables_version") != got["tables_version"]:
        bad.append(f"tables_version is {got['tables_version']}")
    for line in bad:
        print(line)
    if bad:
        print(f"{len(bad)} arrays or files are not what tests/golden/hashes.json says. If the change "
              "is meant: make golden, and say in the commit why.")
        return 1
    print(f"{sum(len(got[job]) for job in JOBS)} arrays and files of {len(JOBS)} jobs are as they were.")
    return 0


def renew(program):
    hashes = all_jobs(program)
    if os.path.exists(HASHES):
        with open(HASHES, encoding="utf-8") as file:
            wrong = check_version(json.load(file), hashes)
        if wrong:
            print(wrong[0])
            return 1
    with open(HASHES, "w", encoding="utf-8") as file:
        json.dump(hashes, file, indent=1, sort_keys=True)
        file.write("\n")
    return 0


def same(first, second, renamed):
    names = dict(pair.split("=", 1) for pair in renamed)
    wanted = {names.get(name, name): value for name, value in digest(first).items()}
    bad = list(differences(wanted, digest(second)))
    for line in bad:
        print(line)
    if not bad:
        print(f"{len(wanted)} arrays and files are equal.")
    return 1 if bad else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name in ["check", "renew"]:
        commands.add_parser(name).add_argument("program")
    both = commands.add_parser("same")
    both.add_argument("first")
    both.add_argument("second")
    both.add_argument("--renamed", action="append", default=[], metavar="OLD=NEW")
    args = parser.parse_args()
    if args.command == "same":
        return same(args.first, args.second, args.renamed)
    program = os.path.abspath(args.program)
    return check(program) if args.command == "check" else renew(program)


if __name__ == "__main__":
    sys.exit(main())
