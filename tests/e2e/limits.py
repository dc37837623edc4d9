#!/usr/bin/env python3
"""Runs a job under ever wider limits until it is done, and looks at how it ends before.

    limits.py PROGRAM [JOB.toml] [--step MB] [--only memory,given,threads,files,descriptors,disk]

 memory       ulimit -v, from where the program starts at all, in steps of MB
 given        --memory, which may also refuse the job (2), and holds the process to it
 threads      ulimit -u, as another user (root has no such limit)
 files        ulimit -f: the largest file
 descriptors  ulimit -n
 disk         a tmpfs of 12 sizes (root only)
Every end must be 0 or 4 (75 where a signal came) with words, no *.tmp may stay, and where it was 4, the
same command without the limit must end in the bytes of a run that never met it. Without JOB a small city.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys

from trials import Trouble, in_folder, small_city

MB = 1 << 20
NOBODY = 65534


def limited(which, value, user=None):
    def prepare():
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if which is not None:
            resource.setrlimit(which, (value, value))
        if user is not None:
            os.setgid(user)
            os.setuid(user)
    return prepare


class Limits:
    def __init__(self, program, job, folder, step):
        self.program, self.job, self.folder, self.step = program, job, folder, step
        self.run("whole", None)

    def run(self, out, prepare, more=()):
        words = [self.program, "run", self.job, "--out", os.path.join(self.folder, out), "--quiet",
                 "--threads", "2", *more]
        return subprocess.run(words, capture_output=True, text=True, preexec_fn=prepare, check=False)

    def same(self, out):
        for name in ("field.h5", "coverage.h5", "pool.h5", "plan.h5", "pieces.csv"):
            one, two = (os.path.join(self.folder, o, name) for o in ("whole", out))
            with open(one, "rb") as a, open(two, "rb") as b:
                if a.read() != b.read():
                    return False
        return True

    def judge(self, what, out, done):
        if done.returncode not in (0, 4):
            raise Trouble(f"{what}: ended with {done.returncode}: {done.stderr}")
        if done.returncode == 4 and "vfplan: " not in done.stderr:
            raise Trouble(f"{what}: no words: {done.stderr}")
        if "bug" in done.stderr:
            raise Trouble(f"{what}: {done.stderr}")
        for at, _, names in os.walk(os.path.join(self.folder, out)):
            left = [n for n in names if n.endswith(".tmp")]
            if left:
                raise Trouble(f"{what}: {at} holds {left}: {done.stderr}")

    def sweep(self, what, which, values, enough, user=None):
        ends = []
        good = 0
        for value in values:
            shutil.rmtree(os.path.join(self.folder, "run"), ignore_errors=True)
            done = self.run("run", limited(which, value, user))
            if done.returncode == 127 and "shared libraries" in done.stderr:
                continue  # it does not start
            if done.returncode < 0 and not done.stderr and which == resource.RLIMIT_AS:
                continue  # the loader itself
            self.judge(f"{what} {value}", "run", done)
            ends.append(done.returncode)
            good = good + 1 if done.returncode == 0 else 0
            if len(ends) % 8 == 1 and done.returncode == 4:
                again = self.run("run", limited(None, 0, user))
                if again.returncode != 0 or not self.same("run"):
                    raise Trouble(f"{what} {value}: goes on to {again.returncode}: {again.stderr}")
            if good >= enough:
                break
        print(f"{what}: {len(ends)} starts, {ends.count(4)} ended with 4, {ends.count(0)} with 0",
              flush=True)
        if not ends.count(4) or not ends.count(0):
            raise Trouble(f"{what}: the limit was never met, or never wide enough")

    def memory(self):
        self.sweep("memory", resource.RLIMIT_AS, (k * self.step * MB for k in range(1, 4000)), 3)

    def given(self):
        ends = []
        for mb in range(64, 100_000, self.step):
            shutil.rmtree(os.path.join(self.folder, "run"), ignore_errors=True)
            done = self.run("run", limited(None, 0), ["--memory", f"{mb}M"])
            what = f"--memory {mb}M"
            if done.returncode == 2:
                if "--memory grants" not in done.stderr or os.path.exists(
                        os.path.join(self.folder, "run")):
                    raise Trouble(f"{what}: {done.stderr}")
            else:
                self.judge(what, "run", done)
                if done.returncode == 0 and not self.same("run"):
                    raise Trouble(f"{what}: other bytes")
            ends.append(done.returncode)
            if ends[-2:] == [0, 0]:
                break
        print(f"given: {len(ends)} starts, {ends.count(2)} refused, {ends.count(4)} ended with 4, "
              f"{ends.count(0)} with 0", flush=True)
        if not ends.count(0):
            raise Trouble("given: no job was done")

    def threads(self):
        if os.geteuid() != 0:
            return
        os.chmod(self.folder, 0o777)
        for at, names, _ in os.walk(self.folder):
            for name in names:
                os.chmod(os.path.join(at, name), 0o777)
        self.sweep("threads", resource.RLIMIT_NPROC, range(1, 12), 3, NOBODY)

    def files(self):
        self.sweep("files", resource.RLIMIT_FSIZE, (1 << k for k in range(10, 34)), 2)

    def descriptors(self):
        self.sweep("descriptors", resource.RLIMIT_NOFILE, range(4, 64), 3)

    def disk(self):
        if os.geteuid() != 0:
            return
        whole = sum(os.path.getsize(os.path.join(at, n))
                    for at, _, names in os.walk(os.path.join(self.folder, "whole")) for n in names)
        ends = []
        for k in range(12):
            os.makedirs(os.path.join(self.folder, "run"), exist_ok=True)
            size = max(4096, int(whole * (0.02 + 0.2 * k)))
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none",
                                      os.path.join(self.folder, "run")], check=False,
                                     capture_output=True)
            if mounted.returncode != 0:
                print("disk: no tmpfs can be mounted here, left out")
                return
            try:
                done = self.run("run", limited(None, 0))
                self.judge(f"disk of {size}", "run", done)
                ends.append(done.returncode)
                if done.returncode == 4:
                    subprocess.run(["mount", "-o", f"remount,size={4 * whole + MB}",
                                    os.path.join(self.folder, "run")], check=True)
                    again = self.run("run", limited(None, 0))
                    if again.returncode != 0 or not self.same("run"):
                        raise Trouble(f"disk of {size}: goes on to {again.returncode}: "
                                      f"{again.stderr}")
            finally:
                subprocess.run(["umount", os.path.join(self.folder, "run")], check=False)
        print(f"disk: {len(ends)} sizes, {ends.count(4)} ended with 4, {ends.count(0)} with 0")
        if not ends.count(4) or not ends.count(0):
            raise Trouble("disk: the limit was never met, or never wide enough")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("job", nargs="?")
    parser.add_argument("--step", type=int, default=40)
    parser.add_argument("--only", default="memory,given,threads,files,descriptors,disk")
    args = parser.parse_args()

    def trial(folder):
        job = args.job or small_city(args.program, folder)
        limits = Limits(os.path.abspath(args.program), os.path.abspath(job), folder,
                        args.step)
        for name in args.only.split(","):
            getattr(limits, name)()

    return in_folder("limits", trial)


if __name__ == "__main__":
    sys.exit(main())
