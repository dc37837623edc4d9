"""vfplan submit on a real Slurm with two simulated nodes: slurm_test.py VFPLAN SOURCE_DIR.

A job on two nodes is preempted twice, requeued, and ends with the result of a plain run. Ends of
other kinds: cancelled, failed, a rank killed, refused by Slurm.

The tools that start the two nodes are looked for in $VFPLAN_TOOLS, else in ../shared/tools beside
the source tree. Exit code 77: skipped; with VFPLAN_REQUIRE_DATA=1 a missing tool fails.
"""
import fcntl
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

program, source = Path(sys.argv[1]), Path(sys.argv[2])
tools = Path(os.environ.get("VFPLAN_TOOLS") or source / ".." / "shared" / "tools").resolve()


def skip(why):
    print(f"slurm_test: {why}")
    sys.exit(1 if os.environ.get("VFPLAN_REQUIRE_DATA") == "1" else 77)


if not (tools / "slurm-up").exists():
    skip(f"{tools}/slurm-up is missing (set VFPLAN_TOOLS to the folder that holds it)")
for tool in ("sbatch", "srun", "mpirun", "munged"):
    if not shutil.which(tool):
        skip(f"{tool} is missing (packages slurm-wlm, munge, openmpi-bin)")
if os.geteuid() != 0:
    skip("only root can start the daemons")
if "without MPI" in subprocess.run([program, "--version"], capture_output=True, text=True).stdout:
    skip("vfplan was built without MPI")


def check(true, what):
    if not true:
        raise AssertionError(what)


def call(*words, code=0, cwd=None):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, cwd=cwd)
    check(done.returncode == code, f"{words}: code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def until(true, what, job=None):
    """Returns the first true value of true(). The limit is for a test that would never end."""
    limit = time.monotonic() + 240
    while time.monotonic() < limit:
        if value := true():
            return value
        time.sleep(0.02)
    raise AssertionError(f"never came: {what}\n{job.text() if job else ''}")


class Job:
    """A submitted job."""

    def __init__(self, folder, job_file, *options, name="out"):
        self.out = folder / name
        said = call(program, "submit", job_file, "--out", self.out, *options, cwd=folder)
        lines = dict(line.split(None, 1) for line in said.splitlines())
        self.id, self.log = lines["job"], Path(lines["log"])
        check(Path(lines["result"]) == self.out, said)

    def show(self):
        words = call("scontrol", "-o", "show", "job", self.id).split()
        return dict(w.split("=", 1) for w in words if "=" in w)

    def state(self):
        return self.show()["JobState"]

    def text(self):
        log = self.log.read_text() if self.log.exists() else "no log"
        return json.dumps(self.show(), indent=1) + "\n" + log

    def shards(self):
        folder = self.out / "shards"
        return len(list(folder.iterdir())) if folder.is_dir() else 0

    def ranks(self):
        """Process numbers of its ranks, by rank."""
        found = {}
        for entry in Path("/proc").iterdir():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                names = dict(v.split(b"=", 1) for v in (entry / "environ").read_bytes().split(b"\0")
                             if b"=" in v)
            except (OSError, ValueError):
                continue
            if words[0] == str(program).encode() and str(self.out).encode() in words:
                found[int(names.get(b"PMIX_RANK", b"0"))] = int(entry.name)
        return found

    def wait_at_work(self, more_than=1):
        """Until there are more shards than that."""
        until(lambda: self.state() not in ("PENDING", "RUNNING") or self.shards() > more_than,
              f"more than {more_than} shards", self)
        check(self.state() == "RUNNING", f"ended before it could be disturbed\n{self.text()}")

    def start_again(self, restarts):
        """Waits for the requeued job and spares us Slurm's pause of two minutes."""
        until(lambda: self.show()["Restarts"] == str(restarts) and self.state() == "PENDING",
              f"restart {restarts}", self)
        # slurmd takes a launch for an old one unless its second is behind that of the end before.
        ended = int(time.time())
        until(lambda: int(time.time()) > ended + 1, "the next second but one")
        call("scontrol", "update", f"JobId={self.id}", "StartTime=now")
        until(lambda: self.state() == "RUNNING", "running again", self)

    def end(self):
        until(lambda: self.state() not in ("PENDING", "RUNNING", "COMPLETING", "CONFIGURING"),
              "its end", self)
        return self.state(), self.show()["ExitCode"]


def write_job(folder, cell_m):
    call(program, "generate", "city", "--size-km", "1", "--seed", "3", "--out",
         folder / "city.geojson")
    file = folder / "job.toml"
    file.write_text(f'preset = "outdoor"\n[site]\ninput = "city.geojson"\n'
                    f"[field]\ncell_m = {cell_m}\ntile_cells = 128\n")
    return file


def preempted_twice(folder):
    """(1) Two nodes, preemption in two ways, and the result of a plain run."""
    job_file = write_job(folder, 0.5)
    call(program, "run", job_file, "--set", "field.tile_cells=1024", "--out", folder / "plain",
         "--quiet")
    job = Job(folder, job_file, "--nodes", "2", name="it's out %j")
    job.wait_at_work()
    check(job.show()["NumNodes"] == "2", job.text())
    check(sorted(until(job.ranks, "ranks", job)) == [0, 1], job.text())
    call("scancel", "--signal=TERM", "--batch", job.id)  # as the end of the time limit does
    job.start_again(1)
    job.wait_at_work(job.shards())
    call("scontrol", "requeue", job.id)  # as a job of higher priority does
    job.start_again(2)
    check(job.end() == ("COMPLETED", "0:0"), job.text())
    log = job.log.read_text()
    check(all(f"start {n}, 2 x 1 threads" in log for n in (1, 2, 3)), log)
    check("stopped, requeued" in log, log)
    shas = [json.loads((f / "summary.json").read_text())["result_sha256"]
            for f in (folder / "plain", job.out)]
    check(shas[0] == shas[1], f"{shas}\n{log}")
    check(json.loads((job.out / "provenance.json").read_text())["ranks"] == 2, log)


def cancelled(folder):
    """(2) scancel ends a job for good."""
    job = Job(folder, write_job(folder, 0.5), "--nodes", "2")
    job.wait_at_work()
    call("scancel", job.id)
    check(job.end()[0] == "CANCELLED", job.text())
    until(lambda: not job.ranks(), "no rank is left", job)
    check(job.state() == "CANCELLED" and job.show()["Restarts"] == "0", job.text())


def rank_killed(folder):
    """(3) A rank that dies ends the job, which does not hang; the same job goes on."""
    job = Job(folder, write_job(folder, 0.5), "--nodes", "2")
    job.wait_at_work()
    os.kill(job.ranks()[1], 9)
    check(job.end() == ("FAILED", "137:0"), job.text())
    check("killed by signal 9" in job.log.read_text(), job.text())


def failed(folder):
    """(4) Exit codes of the program are those of the job, with one message."""
    file = folder / "job.toml"
    (folder / "no_site.geojson").write_text("no site")
    file.write_text('preset = "outdoor"\n[site]\ninput = "no_site.geojson"\n')
    job = Job(folder, file, "--nodes", "2")
    check(job.end() == ("FAILED", "3:0"), job.text())
    check(job.log.read_text().count("vfplan: ") == 1, job.text())


def refused(folder):
    """(5) What Slurm does not accept is told, with its words."""
    (folder / "city.geojson").write_text("{}")
    file = folder / "job.toml"
    file.write_text('preset = "outdoor"\n[site]\ninput = "city.geojson"\n')
    said = call(program, "submit", file, "--partition", "none such", code=4, cwd=folder)
    check("sbatch refused" in said and "partition" in said, said)


wanted = sys.argv[3:]
lock = open(Path(tempfile.gettempdir()) / "vfplan_slurm_test.lock", "w")
fcntl.flock(lock, fcntl.LOCK_EX)  # the nodes' ports are fixed
with tempfile.TemporaryDirectory(prefix="vfplan slurm's ") as scratch, \
        tempfile.TemporaryDirectory(prefix="vfplan_slurm_") as nodes:
    os.chmod(nodes, 0o755)  # MUNGE wants its socket to be seen by all
    slurm = Path(nodes) / "s"
    call(tools / "slurm-up", slurm)
    os.environ["SLURM_CONF"] = str(slurm / "slurm.conf")
    try:
        for test in (refused, failed, preempted_twice, cancelled, rank_killed):
            if wanted and test.__name__ not in wanted:
                continue
            begin = time.monotonic()
            where = Path(scratch) / test.__name__
            where.mkdir()
            test(where)
            print(f"slurm_test: {test.__name__} passed in {time.monotonic() - begin:.1f} s",
                  flush=True)
    finally:
        subprocess.run(["scancel", "-u", "root"], check=False)
        call(tools / "slurm-down", slurm)
