"""What the trials of run directories share: kills.py, tampered.py, limits.py."""

import os
import shutil
import subprocess
import tempfile


class Trouble(Exception):
    """Something is not so that must be."""


def small_city(program, folder):
    """A job that takes a second, in a folder of its own; returns its file."""
    subprocess.run([program, "generate", "city", "--size-km", "0.5", "--seed", "3", "--out",
                    os.path.join(folder, "city.geojson")], check=True, stdout=subprocess.DEVNULL)
    job = os.path.join(folder, "job.toml")
    with open(job, "w", encoding="utf-8") as file:
        file.write('preset = "outdoor"\n[site]\ninput = "city.geojson"\n[field]\ncell_m = 2\n'
                   "tile_cells = 64\n[scanner]\nrange_max_m = 30\n[output]\nmap_px = 300\n")
    return job


def in_folder(name, trial, seed=None):
    """Runs a trial in a temporary folder; returns an exit code. After Trouble the folder is kept."""
    if seed is not None:
        print(f"seed {seed}", flush=True)
    with tempfile.TemporaryDirectory(prefix=f"vfplan-{name}-") as folder:
        try:
            trial(folder)
        except Trouble as e:
            print(e if seed is None else f"seed {seed}: {e}")
            keep = tempfile.mkdtemp(prefix=f"vfplan-{name}-kept-")
            shutil.copytree(folder, keep, dirs_exist_ok=True)
            print(f"the folders are in {keep}")
            return 1
    return 0
