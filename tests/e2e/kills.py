#!/usr/bin/env python3
"""Ends vfplan in the midst of its work, again and again, and looks at what it leaves.

    kills.py PROGRAM [--kills N] [--ranks 1,3] [--seed S]

A small city is planned by two plans from the same tables, A and B. Then, until N processes were ended:
a run from nothing, a run that goes on, `plan` in place (A's folder becomes B's and back) or `plan --out`
is ended at a random moment by a random signal: KILL, TERM, HUP, INT or USR1; with several ranks one of
them, or mpirun, or all. After each:
 (1) `verify` says yes only to a folder whose files are all A's or all B's, byte by byte;
 (2) a polite signal ends it within ten seconds, with exit code 75 or 0, and leaves no *.tmp;
 (3) the same command again ends in the same bytes as if nothing had happened.
Exit code 1 and the seed where one of these is not so.
"""

import argparse
import filecmp
import os
import random
import shutil
import signal
import subprocess
import sys
import time

from trials import Trouble, in_folder, small_city

POLITE = [signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGUSR1]
MAY_DIFFER = {"summary.json", "provenance.json", ".lock", ".ranks"}
B = ["--set", "overlap.threshold=0.2"]
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n"]


def files_of(folder):
    out = set()
    for at, _, names in os.walk(folder):
        out.update(os.path.relpath(os.path.join(at, n), folder) for n in names)
    return out


def difference(a, b):
    """What differs between two run directories, or an empty text."""
    left, right = (files_of(f) - MAY_DIFFER for f in (a, b))
    if left != right:
        return f"only in one: {sorted(left ^ right)}"
    for name in sorted(left):
        if not filecmp.cmp(os.path.join(a, name), os.path.join(b, name), shallow=False):
            return name
    return ""


class Killer:
    def __init__(self, program, folder, rng):
        self.program, self.folder, self.rng = program, folder, rng
        self.kills = {}
        self.accepted = 0
        self.slowest = 0.0

    def at(self, name):
        return os.path.join(self.folder, name)

    def command(self, words, ranks=1):
        start = MPIRUN + [str(ranks)] if ranks > 1 else []
        return start + [self.program] + words + ["--quiet", "--threads", "1"]

    def must(self, words, ranks=1):
        done = subprocess.run(self.command(words, ranks), capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Trouble(f"{' '.join(words)}: exit code {done.returncode}: {done.stderr}")

    def prepare(self):
        small_city(self.program, self.folder)
        began = time.monotonic()
        self.must(self.run_words("A"))
        self.whole_s = time.monotonic() - began
        shutil.copytree(self.at("A"), self.at("B"))
        began = time.monotonic()
        self.must(["plan", self.at("B")] + B)
        self.plan_s = time.monotonic() - began
        self.must(["plan", self.at("A"), "--out", self.at("C"), "--set", "plan.loops=false"])
        if not difference(self.at("A"), self.at("B")):
            raise Trouble("both plans are one, so nothing could be told")

    def run_words(self, name):
        return ["run", self.at("job.toml"), "--out", self.at(name)]

    def processes(self, started):
        """The ranks of an mpirun."""
        out = subprocess.run(["ps", "-eo", "pid=,ppid=,comm="], capture_output=True, text=True,
                             check=False).stdout
        rows = [line.split(None, 2) for line in out.splitlines()]
        return [int(pid) for pid, parent, name in rows
                if int(parent) == started.pid and name.startswith("vfplan")]

    def end_it(self, words, ranks, after_s):
        """Starts a command and ends it; returns whether the signal came before its end."""
        number = self.rng.choice([signal.SIGKILL] * 4 + POLITE)
        started = subprocess.Popen(self.command(words, ranks), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, start_new_session=True)
        whom = self.rng.choice(["one", "mpirun", "all"]) if ranks > 1 else "one"
        try:
            started.wait(after_s)
        except subprocess.TimeoutExpired:
            pass
        ended = started.poll() is not None
        if not ended:
            try:
                if ranks == 1 or whom == "mpirun":
                    os.kill(started.pid, number)
                else:
                    found = self.processes(started)
                    for pid in found if whom == "all" else self.rng.sample(found, min(1, len(found))):
                        os.kill(pid, number)
            except ProcessLookupError:
                pass
        sent = time.monotonic()
        err = started.communicate()[1].decode(errors="replace")
        took = time.monotonic() - sent
        if ranks > 1:
            for _ in range(100):  # what mpirun left behind
                if not subprocess.run(["pgrep", "-s", str(started.pid)], capture_output=True,
                                      check=False).stdout:
                    break
                time.sleep(0.1)
        if not ended:
            key = (signal.Signals(number).name, ranks, whom, words[0])
            self.kills[key] = self.kills.get(key, 0) + 1
            if number != signal.SIGKILL:
                self.slowest = max(self.slowest, took)
                if took > 10:
                    raise Trouble(f"{number!r} took {took:.1f} s")
                # A signal that comes before main() ends a process as it ends any.
                if ranks == 1 and started.returncode not in (0, 75, -number):
                    raise Trouble(f"{number!r} ended it with {started.returncode}: {err}")
        return not ended

    def judge(self, name):
        """What verify says of a folder must be true of it."""
        folder = self.at(name)
        if not os.path.exists(folder):
            return
        done = subprocess.run([self.program, "verify", folder, "--quiet"], capture_output=True,
                              text=True, check=False)
        if done.returncode not in (0, 1, 2, 4):
            raise Trouble(f"verify: {done.returncode} {done.stderr}")
        if done.returncode != 0:
            return
        self.accepted += 1
        wrong = [difference(folder, self.at(plan)) for plan in ("A", "B", "C")]
        if all(wrong):
            raise Trouble(f"{name}: verify says yes, and it is neither plan: {wrong}")

    def round(self, ranks):
        kind = self.rng.choice(["run", "run", "plan", "plan", "plan", "out"])
        name = "there"
        shutil.rmtree(self.at(name), ignore_errors=True)
        wanted = "A"
        if kind == "run":
            words, most = self.run_words(name), self.whole_s * (1.5 if ranks > 1 else 1)
        elif kind == "plan":
            shutil.copytree(self.at("A"), self.at(name))
            words, most, wanted, ranks = ["plan", self.at(name)] + B, self.plan_s, "B", 1
        else:
            words = ["plan", self.at("A"), "--out", self.at(name), "--set", "plan.loops=false"]
            most, wanted, ranks = self.plan_s, "C", 1
        for _ in range(self.rng.randint(1, 3)):
            if not self.end_it(words, ranks, self.rng.uniform(0.02, 1.02) * most):
                break
            self.judge(name)
            # plan --out writes over no finished plan; the signal may have come after its end.
            if kind == "out" and os.path.exists(os.path.join(self.at(name), "summary.json")):
                break
        # plan --out writes over no finished plan: it came to its end all the same.
        if kind != "out" or not os.path.exists(os.path.join(self.at(name), "summary.json")):
            self.must(words, ranks)
        wrong = difference(self.at(name), self.at(wanted))
        if wrong:
            raise Trouble(f"{' '.join(words)} ended otherwise after being ended: {wrong}")
        self.judge(name)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--ranks", default="1")
    parser.add_argument("--seed", type=int, default=int(time.time()))
    args = parser.parse_args()
    ranks = [int(r) for r in args.ranks.split(",")]

    def trial(folder):
        killer = Killer(os.path.abspath(args.program), folder, random.Random(args.seed))
        killer.prepare()
        rounds = 0
        while sum(killer.kills.values()) < args.kills:
            killer.round(ranks[rounds % len(ranks)])
            rounds += 1
            if rounds % 50 == 0:
                print(f"  {sum(killer.kills.values())} ended so far", flush=True)
        for key in sorted(killer.kills):
            print("  {0:8} {1} rank(s), {2:6} {3}: {4}".format(*key, killer.kills[key]))
        print(f"{sum(killer.kills.values())} ended in {rounds} rounds; {killer.accepted} folders "
              f"accepted, each one plan; the slowest polite end took {killer.slowest:.1f} s")

    return in_folder("kills", trial, args.seed)


if __name__ == "__main__":
    sys.exit(main())
