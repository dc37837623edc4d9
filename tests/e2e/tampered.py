#!/usr/bin/env python3
"""Changes finished run directories and looks at what vfplan makes of them.

    tampered.py PROGRAM [--bytes N] [--resealed N] [--seed S]

 bytes     one byte of any file is another: `verify` says no (1 or 4) and names the file
 resealed  numbers in tables and shards are others, and all checksums right again, as somebody would
           write them who means harm: `verify`, `plan` and `run` end with 0, 1, 2 or 4 within 20 seconds,
           never by a signal
Exit code 1 and the seed where one of these is not so.
"""

import argparse
import hashlib
import os
import random
import shutil
import subprocess
import sys
import time

import h5py
import numpy

from trials import Trouble, in_folder

TRAILER = 80
INDICES = {"field": "field.h5", "coverage": "coverage.h5", "pool": "pool.h5"}


def call(program, words):
    try:
        done = subprocess.run([program] + words, capture_output=True, timeout=20, check=False)
    except subprocess.TimeoutExpired:
        return "more than 20 s", ""
    return done.returncode, (done.stdout + done.stderr).decode(errors="replace")


def prepare(program, folder):
    subprocess.run([program, "generate", "flat", "--seed", "3", "--out", f"{folder}/flat.geojson"],
                   check=True, stdout=subprocess.DEVNULL)
    with open(f"{folder}/job.toml", "w", encoding="utf-8") as job:
        job.write('preset = "indoor"\n[site]\ninput = "flat.geojson"\n[field]\ncell_m = 0.25\n'
                  "tile_cells = 64\n[output]\nmap_px = 300\n")
    code, said = call(program, ["run", f"{folder}/job.toml", "--out", f"{folder}/whole", "--quiet",
                                "--set", "plan.method=certified"])
    if code != 0:
        raise Trouble(f"run: {code} {said}")


def all_files(folder):
    out = []
    for at, _, names in os.walk(folder):
        out += [os.path.relpath(os.path.join(at, n), folder) for n in names]
    return sorted(out)


def copy_of(folder):
    shutil.rmtree(f"{folder}/copy", ignore_errors=True)
    shutil.copytree(f"{folder}/whole", f"{folder}/copy")
    return f"{folder}/copy"


def change_bytes(program, folder, tries, rng):
    files = all_files(f"{folder}/whole")
    for i in range(tries):
        name = files[i % len(files)]
        run = copy_of(folder)
        with open(f"{run}/{name}", "r+b") as file:
            size = file.seek(0, os.SEEK_END)
            at = rng.randrange(size)
            file.seek(at)
            old = file.read(1)[0]
            file.seek(at)
            file.write(bytes([old ^ (1 << rng.randrange(8))]))
        code, said = call(program, ["verify", run])
        if code not in (1, 4):
            raise Trouble(f"byte {at} of {name} changed: verify ended with {code}\n{said}")
        if name not in said and os.path.basename(name) not in said:
            raise Trouble(f"byte {at} of {name} changed: verify does not name it\n{said}")
    print(f"{tries} bytes changed in {len(files)} files: each named")


def sha256(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def seal(path):
    """Puts the checksum at the end that belongs there."""
    with open(path, "ab") as file:
        file.write(b"\nvfplan sha256 " + sha256(path).encode() + b"\n")


def unseal(path):
    with open(path, "r+b") as file:
        file.truncate(os.path.getsize(path) - TRAILER)


def reseal_index(run, shard):
    """After a shard was changed: its hash in the index."""
    name = os.path.basename(shard)
    index = os.path.join(run, INDICES[name.split("-")[0]])
    number = int(name.rsplit("-", 1)[1].split(".")[0])
    with open(shard, "rb") as file:
        content = file.read()[-65:-1].decode()
    unseal(index)
    with h5py.File(index, "r+") as file:
        hashes = file["tile_sha256"][...]
        hashes[number] = numpy.frombuffer(bytes.fromhex(content), dtype=numpy.uint8)
        file["tile_sha256"][...] = hashes
    seal(index)


def strange(dtype, rng):
    if dtype.kind == "f":
        return rng.choice([numpy.nan, numpy.inf, -1.0, 1e300, 1e9, 0.0, -1e-9, 2.0])
    info = numpy.iinfo(dtype)
    return rng.choice([info.min, info.max, -1 if info.min < 0 else 255, 0, 1, info.max // 2, 1000])


def as_type(value, dtype):
    with numpy.errstate(all="ignore"):
        return numpy.array(value).astype(dtype)


def change_numbers(file, rng):
    """Changes one thing in an open HDF5 file; says what."""
    sets = []
    file.visititems(lambda name, thing: sets.append(name) if isinstance(thing, h5py.Dataset) else None)
    objects = [file] + [file[name] for name in sets]
    way = rng.randrange(10)
    if way == 0:  # a number beside the data
        on = rng.choice([o for o in objects if len(o.attrs)])
        names = [n for n in on.attrs if isinstance(on.attrs[n], (numpy.floating, numpy.integer))]
        if names:
            name = rng.choice(names)
            value = strange(on.attrs[name].dtype, rng)
            on.attrs.modify(name, as_type(value, on.attrs[name].dtype))
            return f"attribute {name} = {value}"
    plain = [n for n in sets if not file[n].is_virtual and file[n].size and n != "tile_sha256"
             and file[n].dtype.kind in "fiu"]
    name = rng.choice(plain)
    data = file[name][...]
    if way == 1:  # another size
        size = rng.choice([0, 1, data.size - 1, data.size + 1, 2 * data.size])
        attributes = dict(file[name].attrs)
        del file[name]
        new = file.create_dataset(name, data=numpy.resize(data, size) if size else data.ravel()[:0])
        for key, value in attributes.items():
            if key not in ("DIMENSION_LIST", "REFERENCE_LIST", "CLASS", "NAME"):
                new.attrs[key] = value
        return f"{name} has {size} values"
    if way == 2 and not [v for v in file if v in ("vf",)]:
        link = rng.choice(["soft", "external", "virtual"])
        shape, dtype = file[name].shape, file[name].dtype
        del file[name]
        if link == "soft":
            file[name] = h5py.SoftLink("/" + rng.choice([n for n in plain if n != name] or ["x"]))
        elif link == "external":
            file[name] = h5py.ExternalLink("/etc/passwd", "/x")
        else:
            layout = h5py.VirtualLayout(shape=shape, dtype=dtype)
            layout[...] = h5py.VirtualSource("../elsewhere.h5", "x", shape=shape)
            file.create_virtual_dataset(name, layout)
        return f"{name} is {link}"
    flat = data.reshape(-1)
    if way == 3:
        rng.shuffle(flat)
        file[name][...] = data
        return f"{name} shuffled"
    many = rng.choice([1, 1, 1, flat.size])
    value = strange(data.dtype, rng)
    at = rng.randrange(flat.size)
    flat[at:at + many] = as_type(value, data.dtype)
    file[name][...] = data
    return f"{name}[{at}:{at + many}] = {value}"


def change_tables(program, folder, tries, rng):
    counts = {}
    tables = [n for n in all_files(f"{folder}/whole") if n.endswith(".h5")]
    for i in range(tries):
        run = copy_of(folder)
        name = tables[i % len(tables)]
        unseal(f"{run}/{name}")
        with h5py.File(f"{run}/{name}", "r+") as file:
            what = change_numbers(file, rng)
        seal(f"{run}/{name}")
        if name.startswith("shards/"):
            reseal_index(run, f"{run}/{name}")
        command = rng.choice(["verify", "verify", "plan", "run"])
        words = ["run", f"{folder}/job.toml", "--out", run, "--set", "plan.method=certified"] \
            if command == "run" else [command, run]
        code, said = call(program, words)
        counts[code] = counts.get(code, 0) + 1
        if code not in (0, 1, 2, 4) or "bug" in said:
            raise Trouble(f"{name}: {what}: {command} ended with {code}\n{said}")
    print(f"{tries} resealed tables: exit codes {dict(sorted(counts.items()))}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--bytes", type=int, default=60)
    parser.add_argument("--resealed", type=int, default=120)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    args = parser.parse_args()
    rng = random.Random(args.seed)

    def trial(folder):
        prepare(args.program, folder)
        change_bytes(args.program, folder, args.bytes, rng)
        change_tables(args.program, folder, args.resealed, rng)

    return in_folder("tampered", trial, args.seed)


if __name__ == "__main__":
    sys.exit(main())
