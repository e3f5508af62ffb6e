"""Faults of a sweep: kills, files that vanish between cases, a disk that fills."""
import collections
import csv
import os
import pathlib
import subprocess
import time

import checks
from solves import SCENE
from study import Study

TIMINGS = ("seconds", "cpu_seconds", "peak_mb")
MATERIALS = {"clay": 1.0, "paint": 0.4, "plastic": 0.2}  # roughness
ITERATIONS = {"known-light": 1, "joint": 0}
# As the solver, ended by its iterations; `exec`: it is the process that the sweep started.
SOLVER = '#!/bin/sh\nexec "{solver}" "$@" --set solver.max_iterations={iterations}\n'
# The same beside another program that fills the disk when the solver is done.
FILLING = """#!/bin/sh
"{solver}" "$@" --set solver.max_iterations=0
code=$?
cat /dev/zero > "{filler}" 2> /dev/null
exit $code
"""


def rows(out):
    """Of results.csv, but for what differs from run to run."""
    path = out / "results.csv"
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return [{k: v for k, v in row.items() if k not in TIMINGS} for row in csv.DictReader(file)]


class Sweeps(Study):
    def __init__(self, args, rows):
        super().__init__(args, rows)
        self.data, self.maps = self.folder / "data", self.folder / "maps"
        self.data.mkdir()
        self.maps.mkdir()
        (self.folder / "scene.yaml").write_text(SCENE)
        for name, roughness in MATERIALS.items():
            self.render("--out", self.folder / "any.exr", "--brdf-out", self.data / f"{name}.binary",
                        "--illumination-out", self.maps / "sky.exr",
                        "--set", f"reflectance.known.cook_torrance.roughness={roughness}")
        self.undisturbed = {}  # folder and seconds

    def solver(self, name, text, **fields):
        path = self.folder / name
        path.write_text(text.format(solver=self.program("ibrdf_solve"), **fields))
        path.chmod(0o755)
        return path

    def command(self, experiment, out, solver=None):
        solver = solver or self.solver(f"solve-{experiment}", SOLVER, iterations=ITERATIONS[experiment])
        return [self.program("ibrdf_bench"), experiment, "--data", str(self.data), "--maps", str(self.maps),
                "--materials", ",".join(MATERIALS), "--map-names", "sky", "--size", "16", "--threads", "1",
                "--solver-seconds", "1000000", "--solver-program", str(solver), "--quiet", "--out", str(out)]

    def whole(self, experiment):
        if experiment not in self.undisturbed:
            out = self.folder / "whole" / experiment
            start = time.monotonic()
            done = self.run(self.command(experiment, out))
            if done.returncode != 0 or len(rows(out)) != len(MATERIALS):
                raise RuntimeError(f"the undisturbed sweep failed: {done.stderr}")
            self.undisturbed[experiment] = out, time.monotonic() - start
        return self.undisturbed[experiment]

    def expect_whole(self, experiment, out, where, solver=None):
        """Ends with the undisturbed sweep's rows and files when the same command is run again."""
        whole = self.whole(experiment)[0]
        done = self.run(self.command(experiment, out, solver))
        if done.returncode != 0:
            self.fail(f"{where}: the sweep did not end: exit {done.returncode}: {done.stderr!r}")
        if rows(out) != rows(whole):
            self.fail(f"{where}: other rows: {rows(out)} {rows(whole)}")
        for path in (whole / "cases").rglob("*"):
            other = out / path.relative_to(whole)
            if path.suffix in (".binary", ".exr") and not (
                    other.exists() and path.read_bytes() == other.read_bytes()):
                self.fail(f"{where}: {other} is another")
        if list(out.rglob(".tmp-*")):
            self.fail(f"{where}: temporary files left")

    def sweep(self):
        """Killed with its solver at random moments and started again, until it is done."""
        seconds = self.whole("known-light")[1]
        kills, orphans = 0, 0
        out = self.folder / "killed"
        for attempt in range(self.args.sweep_kills):
            with subprocess.Popen(self.command("known-light", out), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as process:
                # The first ones early, so that the sweep is not done before the last one.
                share = self.random.uniform(0, 1) * (attempt + 1) / self.args.sweep_kills
                try:
                    process.wait(share * seconds)
                except subprocess.TimeoutExpired:
                    process.kill()
                    kills += 1
            time.sleep(1)
            orphans += self.solvers_of(out)
        if orphans:
            self.fail(f"{orphans} solvers went on after their sweep was killed")
        self.expect_whole("known-light", out, "killed sweep")
        self.row(f"sweep of {len(MATERIALS)} cases killed (SIGKILL)", kills,
                 f"resumed to its end: the same rows of results.csv but for {' and '.join(TIMINGS)}, the same files bit "
                 f"by bit, no solver that went on, no temporary files")

    @staticmethod
    def solvers_of(folder):
        """Processes that still write below `folder`."""
        count = 0
        for path in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
            try:
                line = path.read_bytes()
            except OSError:
                continue  # ended meanwhile
            count += b"ibrdf_solve" in line and os.fsencode(folder) in line
        return count

    def sweep_files(self):
        """Of the map or a table, from some moment after the first case on."""
        ends, kept = collections.Counter(), collections.Counter()
        times = 0
        for experiment in ITERATIONS:
            per_case = self.whole(experiment)[1] / len(MATERIALS)
            for k, path in enumerate((self.maps / "sky.exr", self.data / "plastic.binary")):
                where = f"{experiment} without {path.name}"
                times += 1
                out = self.folder / f"vanished-{experiment}{k}"
                away = path.with_name(path.name + ".away")
                with subprocess.Popen(self.command(experiment, out), stdout=subprocess.DEVNULL,
                                      stderr=subprocess.PIPE, text=True) as process:
                    while process.poll() is None and not rows(out):
                        time.sleep(0.002)
                    time.sleep(self.random.uniform(0, 1) * per_case * (k > 0))
                    path.rename(away)
                    stderr = process.communicate()[1]
                ends[process.returncode] += 1
                found = rows(out)
                kept[len(found)] += 1
                if found != rows(self.whole(experiment)[0])[:len(found)] or not found:
                    self.fail(f"{where}: rows {found}")
                if process.returncode != 0 or len(found) < len(MATERIALS):
                    self.expect_refused(subprocess.CompletedProcess(None, process.returncode, None, stderr), where,
                                        path.name)
                self.expect_refused(self.run(self.command(experiment, out)), f"{where}, again", path.stem)
                if rows(out) != found:
                    self.fail(f"{where}: the rows changed")
                away.rename(path)
                self.expect_whole(experiment, out, f"{where}, which is back")
        self.row("map or table of a sweep of three cases (known-light, joint) removed after the first case", times,
                 f"{checks.words(ends)} (2: one line with the file and the case); rows kept: "
                 + ", ".join(f"{n} x {r}" for r, n in sorted(kept.items()))
                 + ", the undisturbed ones; run again without the file: exit 2 and one line with its name; once it is "
                   "back: the same rows, the same files bit by bit")

    def expect_refused(self, done, where, *what):
        if done.returncode != 2:
            self.fail(f"{where}: exit {done.returncode}")
        self.expect_one_line(done, where, *what)

    def sweep_disk(self):
        """At several sizes, then one that another program fills, then room."""
        plenty = 200000
        sizes = [8, 34600, 70500]  # KiB; results of a case take 35000
        found = []
        for kib in [*sizes, None]:
            where = f"sweep on a disk of {kib or plenty} KiB"
            with self.small_disk(kib or plenty) as disk:
                if disk is None:
                    self.row("full disk of a sweep", 0, "skipped: no right to mount a tmpfs")
                    return
                filler = disk / "filler"
                solver = None if kib else self.solver("solve-filling", FILLING, filler=filler)
                done = self.run(self.command("known-light", disk / "out", solver))
                self.expect_refused(done, where, disk / "out")
                found.append(len(rows(disk / "out")))
                if rows(disk / "out") != rows(self.whole("known-light")[0])[:found[-1]]:
                    self.fail(f"{where}: rows {rows(disk / 'out')}")
                if self.halves(disk / "out", where):
                    self.fail(f"{where}: temporary files left")
                if kib is None:
                    filler.unlink(missing_ok=True)
                self.enlarge(disk, plenty)
                self.expect_whole("known-light", disk / "out", f"{where}, then room")
        self.row(f"full disk of a sweep ({sizes[0]} KiB to {sizes[-1] // 1000} MB, or filled after a solve)",
                 len(found), f"each exit 2 and one line with the file; rows kept: {found}, the undisturbed ones; run "
                             f"again with room: the same rows, the same files bit by bit")
