"""Faults of ibrdf_solve: kills, interrupts, full disks, unwritable folders, vanished files, missing memory."""
import collections
import json
import math
import re
import resource
import signal
import subprocess
import time

import checks
from study import Moments, Study

SCENE = """
image: {width: 24, height: 24}
geometry: {sphere: {}}
reflectance: {known: {cook_torrance: {diffuse: [0.3, 0.2, 0.1], specular: 0.5, roughness: 0.2, f0: 0.1}}}
illumination: {known: {sky: {}}, width: 32, height: 16}
quality: preview
noise: 0.02
"""
# Iterations end each solve, never the clock: its end is the same bits at any load.
PROBLEM = """
problem: {problem}
image: {{file: input.exr}}
geometry: {{sphere: {{}}}}
reflectance: {{{reflectance}}}
illumination: {{width: 32, height: 16{light}}}
solver: {{seconds: 1000000, max_iterations: {iterations}, estimator: {estimator}}}
"""
Kind = collections.namedtuple("Kind", "problem reflectance light iterations estimator file")
# file: what the problem names, to vanish.
KINDS = {
    "reflectance": Kind("reflectance", "lobes: 2", ", known: map.exr", 2, "marginal", "map.exr"),
    "illumination": Kind("illumination", "known: table.binary", "", 40, "marginal", "table.binary"),
    "maximum": Kind("joint", "lobes: 2", "", 2, "maximum", "input.exr"),
    "joint": Kind("joint", "lobes: 1", "", 1, "marginal", "input.exr"),
}
# Their bytes hold seconds.
TIMED = ("result.json", "report.html", "overview.png")
# Of the look before a solve: they are there before its results, so that an ended run's may stand beside another's look.
LOOK = ("check.json", "check.png", "check_light.png")
SOLVED = (0, 3)
FIRST_FILE = 0.03  # seconds that the table of 35 MB takes
# A line of progress: after the first one the solve iterates, until that of the stage "end".
PROGRESS = re.compile(r"^ *[\d.]+ s +\d+ %  (.*?) +misfit ", re.MULTILINE)


def phase(log):
    stages = PROGRESS.findall(log.read_text() if log.exists() else "")
    return "before" if not stages else "after" if "end" in stages else "in"


class Solves(Study):
    def __init__(self, args, rows):
        super().__init__(args, rows)
        self.seconds = {}  # of an undisturbed run
        self.writing = {}  # from its first file to its last
        self.log = self.folder / "progress.txt"
        (self.folder / "scene.yaml").write_text(SCENE)
        self.render("--out", self.folder / "input.exr", "--illumination-out", self.folder / "map.exr", "--brdf-out",
                    self.folder / "table.binary")
        for name, kind in KINDS.items():
            (self.folder / f"{name}.yaml").write_text(PROBLEM.format(**kind._asdict()))

    def command(self, out, kind, threads=1):
        return [self.program("ibrdf_solve"), "--problem", str(self.folder / f"{kind}.yaml"), "--out", str(out),
                "--threads", str(threads)]

    def start(self, out, kind, **options):
        """The process, its progress in self.log."""
        with open(self.log, "w", encoding="utf-8") as log:
            return subprocess.Popen(self.command(out, kind), stdout=log,
                                    **{"stderr": subprocess.DEVNULL, **options})

    def whole(self, kind):
        """Folder of the undisturbed run, made when it is first asked for."""
        out = self.folder / "whole" / kind
        if kind not in self.seconds:
            start = time.monotonic()
            done = self.run(self.command(out, kind))
            self.seconds[kind] = time.monotonic() - start
            if done.returncode not in SOLVED:
                raise RuntimeError(f"the undisturbed solve of {kind} failed: {done.stderr}")
            times = [path.stat().st_mtime for path in out.iterdir()]
            self.writing[kind] = max(times) - min(times)
        return out

    def kind(self, k):
        """By turns."""
        kind = self.args.kinds[k % len(self.args.kinds)]
        self.whole(kind)
        return kind

    def moment(self, kind):
        return self.random.uniform(0, 1) * self.seconds[kind]

    def mixture(self, out, where):
        """Where there is a result.json, all else but the look is of the run that it names; returns that run's kind."""
        self.expect_look(out, where, self.args.kinds)
        if not (out / "result.json").exists():
            return None
        result = json.loads((out / "result.json").read_text())
        for kind in self.args.kinds:
            whole = self.whole(kind)
            expected = json.loads((whole / "result.json").read_text())
            if result["problem"] != expected["problem"]:
                continue
            for key in ("status", "cost", "posterior", "likelihood"):
                if result[key] != expected[key]:
                    self.fail(f"{where}: {key} of result.json is not the undisturbed run's")
            here, there = ({p.name for p in folder.iterdir()} - set(LOOK) for folder in (out, whole))
            other = {n for n in here ^ there if not n.startswith(".tmp-")} - {"report.html"}
            if other:
                self.fail(f"{where}: {sorted(other)} and the result.json of {kind}")
            for name in sorted((here & there) - set(TIMED)):
                if (out / name).read_bytes() != (whole / name).read_bytes():
                    self.fail(f"{where}: {name} is not of the run of result.json, {kind}")
            return kind
        self.fail(f"{where}: result.json is of no run")
        return None

    def expect_look(self, out, where, kinds):
        """Each file of the look before a solve is that of one of `kinds`."""
        for path in (out / name for name in LOOK if (out / name).exists()):
            looks = [self.whole(kind) / path.name for kind in kinds]
            if path.read_bytes() not in [look.read_bytes() for look in looks if look.exists()]:
                self.fail(f"{where}: {path.name} is of no run of {', '.join(kinds)}")

    def finite(self, out, where):
        for path in out.iterdir():
            if path.suffix in (".exr", ".binary") and not checks.is_finite(path):
                self.fail(f"{where}: {path.name} is not finite")

    def kills(self):
        """At any moment; problems of all kinds by turns into the same folder, where their files must not mix.

        The folder holds results from the start: of the kind whose turn comes last."""
        out = self.folder / "killed"
        self.run_again(out, self.args.kinds[-1:])
        moments, ends, results, left = Moments(), collections.Counter(), 0, 0
        for k in range(self.args.kills):
            kind = self.kind(k)
            with self.start(out, kind) as process:
                time.sleep(self.moment(kind))
                process.kill()
            moments.add(phase(self.log))
            ends[process.returncode] += 1
            left += self.halves(out, f"kill {k}") > 0
            results += self.mixture(out, f"kill {k}") is not None
        self.run_again(out, self.args.kinds)
        self.row(f"killed (SIGKILL): {', '.join(self.args.kinds)} by turns", self.args.kills,
                 f"{moments}; {checks.words(ends)}; temporary files left by {left}, 0 after the next whole runs; "
                 f"result.json there after {results}, with all files of its run; the next run's results are the "
                 f"undisturbed one's, bit by bit")

    def run_again(self, out, kinds):
        for kind in kinds:
            self.whole(kind)
            done = self.run(self.command(out, kind))
            if done.returncode not in SOLVED:
                self.fail(f"{kind} after the kills: exit {done.returncode}: {done.stderr!r}")
            if self.mixture(out, f"{kind} after the kills") != kind:
                self.fail(f"{kind} after the kills: no result.json of it")
            self.expect_look(out, f"{kind} after the kills", [kind])
        # A stray goes when its file is written again.
        strays = self.halves(out, "after the kills")
        if strays:
            self.fail(f"after the kills {strays} temporary files are left")

    def writing_kills(self):
        """While results are written, half of the times the first and largest file."""
        out = self.folder / "killed_writing"
        kinds = self.args.kinds[:2]
        ends, results, left = collections.Counter(), 0, 0
        for k in range(self.args.writing_kills):
            kind = kinds[k % len(kinds)]
            self.whole(kind)
            before = set(out.glob(".tmp-*"))
            with self.start(out, kind) as process:
                while process.poll() is None and not set(out.glob(".tmp-*")) - before:
                    time.sleep(0.0005)
                time.sleep(self.random.uniform(0, 1) * (self.writing[kind] if k // 2 % 2 else FIRST_FILE))
                process.kill()
            ends[process.returncode] += 1
            left += self.halves(out, f"writing, kill {k}") > 0
            results += self.mixture(out, f"writing, kill {k}") is not None
        self.run_again(out, kinds)
        self.row("killed (SIGKILL) while results are written", self.args.writing_kills,
                 f"{checks.words(ends)}; temporary files left by {left}, 0 after the next whole runs; result.json there "
                 f"after {results}, with all files of its run; the next run's results are the undisturbed one's, bit by "
                 f"bit")

    def interrupts(self):
        times = 12
        moments, ends = Moments(), collections.Counter()
        waits = collections.defaultdict(float)
        for k in range(times):
            kind = self.kind(k)
            where = f"interrupt {k}, {kind}"
            out = self.folder / f"interrupted{k}"
            with self.start(out, kind) as process:
                time.sleep(self.moment(kind))
                met = phase(self.log)
                process.send_signal(signal.SIGINT)
                sent = time.monotonic()
                process.wait()
                waits[kind] = max(waits[kind], time.monotonic() - sent)
            moments.add(met)
            code = process.returncode
            ends[code] += 1
            if self.halves(out, where):
                self.fail(f"{where} left temporary files")
            # Before the problem is read there is nothing to keep.
            if not (code == 130 or met == "before" and code == -signal.SIGINT or met == "after" and code in SOLVED):
                self.fail(f"{where}, {met} the iterations: exit {code}")
            if code == 130:
                self.expect_best(out, kind, where)
        self.row("interrupted (SIGINT)", times,
                 f"{moments}; {checks.words(ends)} (signal 2: before the problem was read); with 130 all files of an "
                 f"undisturbed run, finite, 'interrupted', cost no higher than the start's; at most "
                 + ", ".join(f"{w:.1f} s ({k})" for k, w in waits.items()) + " later")

    def expect_best(self, out, kind, where):
        """The folder holds an interrupted run's whole and finite results."""
        names, expected = ({p.name for p in folder.iterdir()} for folder in (out, self.whole(kind)))
        if names - {"illumination_log_std.exr"} != expected - {"illumination_log_std.exr"}:
            self.fail(f"{where}: other files than of a whole run: {sorted(names ^ expected)}")
            return
        self.finite(out, where)
        result = json.loads((out / "result.json").read_text())
        cost, misfit = result["cost"], result["metrics"]["misfit"]
        if result["status"] != "interrupted":
            self.fail(f"{where}: status {result['status']}")
        if not all(isinstance(v, (int, float)) and math.isfinite(v) for v in (*cost.values(), misfit)):
            self.fail(f"{where}: {cost}, misfit {misfit}")
        elif cost["end"] > cost["start"]:
            self.fail(f"{where}: ends above its start: {cost}")

    def full_disk(self):
        sizes = [4, 64, 1024, 30000, 34250]  # KiB; the table alone takes 34172
        said = 0
        for kib in sizes:
            where = f"disk of {kib} KiB"
            with self.small_disk(kib) as disk:
                if disk is None:
                    self.row("full disk", 0, "skipped: no right to mount a tmpfs")
                    return
                done = self.run(self.command(disk / "out", "reflectance"))
                if done.returncode in SOLVED:
                    self.fail(f"{where} was large enough")
                self.expect_one_line(done, where)
                if self.halves(disk / "out", where):
                    self.fail(f"{where}: temporary files left")
                if (disk / "out" / "result.json").exists():
                    self.fail(f"{where}: a result.json")
                said += "No space left" in done.stderr
        self.row(f"full disk ({sizes[0]} KiB to {sizes[-1] // 1000} MB)", len(sizes),
                 f"each an error of one line, {said} of them 'No space left'; no temporary file, no result.json")

    def unwritable(self):
        # Before the solve: one that never ends by itself.
        endless = ["--set", "solver.max_iterations=100000000", "--set", "solver.tolerance=0"]
        folders = ("/proc/ibrdf", str(self.folder / "input.exr"), "/dev/null/x")
        slowest = 0
        for out in folders:
            start = time.monotonic()
            done = self.run(self.command(out, "reflectance") + endless)
            slowest = max(slowest, time.monotonic() - start)
            if done.returncode != 2:
                self.fail(f"{out}: exit {done.returncode}")
            self.expect_one_line(done, out, out)
        if slowest > 60:
            self.fail("an unwritable folder is found out after the solve")
        self.row("unwritable folder", len(folders), "exit 2 and one line, before the solve")

    def vanishing(self):
        times = 12
        moments, ends = Moments(), collections.Counter()
        for k in range(times):
            kind = self.kind(k)
            where = f"vanished file {k}, {kind}"
            path = self.folder / KINDS[kind].file
            away = path.with_name(path.name + ".away")
            out = self.folder / f"vanished{k}"
            with self.start(out, kind, stderr=subprocess.PIPE, text=True) as process:
                time.sleep(0 if k == 0 else self.moment(kind))
                path.rename(away)
                moments.add(phase(self.log))
                stderr = process.communicate()[1]
            away.rename(path)
            code = process.returncode
            ends[code] += 1
            if code == 2 and path.name not in stderr or code not in (2, *SOLVED):
                self.fail(f"{where}: exit {code}: {stderr!r}")
            self.halves(out, where)
            if code in SOLVED and self.mixture(out, where) != kind:
                self.fail(f"{where}: no result.json")
        self.row("known map, known table or image removed during the run", times,
                 f"{moments}; {checks.words(ends)} (2: before it was read, and named; else the undisturbed results)")

    def memory(self):
        self.limited_memory("reflectance", halvings=3)

    def joint_memory(self):
        self.limited_memory("joint", halvings=1)

    def limited_memory(self, kind, halvings):
        """Address space: limits from the loader's own need to plenty, then others towards the least that suffices."""
        ends, moments, least = collections.Counter(), Moments(), []
        for threads in (1, 2):
            enough = {}
            for mb in (60, 150, 200, 250, 300, 400, 500, 600, 700, 850, 1200):
                enough[mb] = self.with_memory(kind, threads, mb, ends, moments)
                if enough[mb]:
                    break
            else:
                self.fail(f"{kind}, {threads} threads: {mb} MB are not enough")
                continue
            for _ in range(halvings):
                low = max(m for m in enough if not enough[m])
                high = min(m for m in enough if enough[m])
                enough[(low + high) // 2] = self.with_memory(kind, threads, (low + high) // 2, ends, moments)
            least.append(min(m for m in enough if enough[m]))
        self.row(f"{kind}, address space from 60 MB to what suffices, one and two threads", sum(ends.values()),
                 f"{checks.words(ends)} (127: the loader has no room for the libraries); memory ran out {moments}; "
                 f"{' and '.join(map(str, least))} MB were enough; with enough the undisturbed results, else one line")

    def with_memory(self, kind, threads, mb, ends, moments):
        """Whether it was enough."""
        library_error = 127  # the loader's, before the program has begun
        where = f"{kind}, {mb} MB, {threads} threads"
        out = self.folder / f"memory-{kind}-{mb}-{threads}"
        with open(self.log, "w", encoding="utf-8") as log:
            done = self.run(self.command(out, kind, threads), stdout=log, preexec_fn=lambda: resource.setrlimit(
                resource.RLIMIT_AS, (mb << 20, mb << 20)))
        ends[done.returncode] += 1
        if done.returncode == 1:
            moments.add(phase(self.log))
            self.expect_one_line(done, where, "memory")
        elif done.returncode not in (library_error, *SOLVED):
            self.fail(f"{where}: exit {done.returncode}: {done.stderr[-200:]!r}")
        if self.halves(out, where):
            self.fail(f"{where}: temporary files left")
        if done.returncode in SOLVED and self.mixture(out, where) != kind:
            self.fail(f"{where}: no result.json")
        return done.returncode in SOLVED
