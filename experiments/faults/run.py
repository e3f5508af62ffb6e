#!/usr/bin/env python3
"""Breaks ibrdf_solve and a sweep from outside: kills, full disks, missing memory and files.

    experiments/faults/run.py [--bin build/release/bin] [--kills 50] [--seed 1]
                              [--data TABLES --maps MAPS] [--table FILE] [--only PART,...]

TABLES is a folder of MERL files and MAPS one of maps (experiments/joint_grid); without them the sweep is skipped, and
the full disk without the right to mount a small tmpfs (root). Prints a table, also into FILE, and exits with 1 where
something half-written is found, what was killed does not end the same when it is run again, or a failure is not said
in one line.
"""
import argparse
import csv
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

SCENE = """
image: {width: 48, height: 48}
geometry: {sphere: {}}
reflectance: {known: {cook_torrance: {diffuse: [0.3, 0.2, 0.1], specular: 0.5, roughness: 0.2, f0: 0.1}}}
illumination: {known: {sky: {}}, width: 64, height: 32}
quality: preview
noise: 0.02
"""
# No iteration: what is tried here lies before and after them.
PROBLEM = """
problem: reflectance
image: {file: input.exr}
geometry: {sphere: {}}
reflectance: {model: default, lobes: 2}
illumination: {width: 64, height: 32, known: map.exr}
solver: {seconds: 100, max_iterations: 0}
"""
PARTS = ("kills", "interrupts", "full_disk", "unwritable", "vanishing", "memory", "sweep")
RESULTS = ("brdf.binary", "brdf.json", "illumination.exr", "render.exr", "residual.exr")
# Longer than any run here takes on a loaded machine: what is not done by then waits forever.
PATIENCE = 300
FIRST_FILE = 0.03  # seconds that the table of 35 MB takes
SWEEP = ("pink-felt,gray-plastic", "studio")
TIMINGS = ("seconds", "peak_mb")


def exr_is_whole(path):
    """Header, and an offset table whose last scanline block ends the file."""
    data = path.read_bytes()
    if data[:4] != b"\x76\x2f\x31\x01":
        return False
    window = data.index(b"dataWindow\0box2i\0") + 17 + 4
    _, y0, _, y1 = struct.unpack_from("<4i", data, window)
    blocks = -(-(y1 - y0 + 1) // 16)  # ZIP: 16 lines each
    at = 8
    while data[at] != 0:  # name, type, size, value
        at = data.index(b"\0", at) + 1
        at = data.index(b"\0", at) + 1
        at += 4 + struct.unpack_from("<i", data, at)[0]
    offsets = struct.unpack_from(f"<{blocks}Q", data, at + 1)
    last = max(offsets)
    return last > 0 and last + 8 + struct.unpack_from("<i", data, last + 4)[0] == len(data)


def is_whole(path):
    """None: a name that no result has, as a temporary file's."""
    if path.name.startswith(".tmp-"):
        return None
    if path.suffix == ".json":
        try:
            json.loads(path.read_text())
            return True
        except ValueError:
            return False
    if path.suffix == ".exr":
        return exr_is_whole(path)
    if path.suffix == ".binary":
        return path.stat().st_size == 12 + 3 * 8 * 90 * 90 * 180
    if path.suffix == ".png":
        return path.read_bytes()[-8:-4] == b"IEND"
    if path.suffix == ".html":
        return path.read_text().rstrip().endswith("</html>")
    return None


def words(ends):
    return ", ".join(f"{n} x {'signal ' + str(-c) if c < 0 else 'exit ' + str(c)}" for c, n in sorted(ends.items()))


class Faults:
    def __init__(self, args):
        self.args = args
        self.random = random.Random(args.seed)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ibrdf-faults-"))
        self.failures = []
        self.told = 0  # of them, in rows
        self.rows = []

    def fail(self, what):
        self.failures.append(what)
        print("FAILED:", what, flush=True)

    def row(self, fault, times, end):
        if len(self.failures) > self.told:
            end = f"FAILED ({len(self.failures) - self.told}); {end}"
            self.told = len(self.failures)
        self.rows.append((fault, times, end))
        print(f"{fault}, {times} times: {end}", flush=True)

    def command(self, out, lobes=2, threads=1):
        return [str(self.args.bin / "ibrdf_solve"), "--problem", str(self.folder / "problem.yaml"), "--out", str(out),
                "--set", f"reflectance.lobes={lobes}", "--threads", str(threads), "--quiet"]

    def run(self, out, lobes=2, command=None, **options):
        """As subprocess.run; the exit status of one that waits forever is that of the signal that ends it."""
        command = command or self.command(out, lobes)
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options) as process:
            try:
                _, stderr = process.communicate(timeout=PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
                _, stderr = process.communicate()
        return subprocess.CompletedProcess(command, process.returncode, None, stderr)

    def halves(self, out, where):
        """Reports files that are not whole; returns how many strays there are."""
        strays = 0
        for path in out.iterdir() if out.exists() else []:
            whole = is_whole(path)
            if whole is None:
                strays += 1
            elif not whole:
                self.fail(f"{where}: {path.name} is not whole")
        return strays

    def mixture(self, out, where):
        """Where there is a result.json, all else is of the run that it names."""
        if not (out / "result.json").exists():
            return False
        lobes = json.loads((out / "result.json").read_text())["problem"]["reflectance"]["lobes"]
        for name in RESULTS:
            if (out / name).read_bytes() != (self.whole(lobes) / name).read_bytes():
                self.fail(f"{where}: {name} is not of the run of result.json")
        return True

    def expect_one_line(self, done, where):
        lines = done.stderr.strip().splitlines()
        if len(lines) != 1 or not lines[0].startswith("error: "):
            self.fail(f"{where}: not one line: {done.stderr!r}")

    def whole(self, lobes):
        return self.folder / f"whole{lobes}"

    def prepare(self):
        (self.folder / "scene.yaml").write_text(SCENE)
        (self.folder / "problem.yaml").write_text(PROBLEM)
        subprocess.run([str(self.args.bin / "ibrdf_render"), "--scene", str(self.folder / "scene.yaml"), "--out",
                        str(self.folder / "input.exr"), "--illumination-out", str(self.folder / "map.exr"), "--quiet"],
                       check=True)
        for lobes in (1, 2):
            start = time.monotonic()
            done = self.run(self.whole(lobes), lobes)
            self.seconds = time.monotonic() - start
            if done.returncode not in (0, 3):
                sys.exit(f"the undisturbed solve failed: {done.stderr}")
        times = [path.stat().st_mtime for path in self.whole(2).iterdir()]
        self.writing = max(times) - min(times)
        self.row("undisturbed", 2, f"exit {done.returncode}")

    def kills(self):
        ends = {}
        left, results, most = 0, 0, 0
        out = self.folder / "killed"
        table = out / "brdf.binary"  # the first file
        for k in range(self.args.kills):
            before = table.stat().st_mtime_ns if table.exists() else 0
            # Runs of one lobe and of two by turns: their files must not mix.
            with subprocess.Popen(self.command(out, 1 + k // 2 % 2), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as process:
                if k % 2:
                    time.sleep(self.random.uniform(0, 1) * self.seconds)
                else:  # while files are written, from the first one's temporary on
                    while process.poll() is None and not list(out.glob(".tmp-*brdf.binary")) and (
                            not table.exists() or table.stat().st_mtime_ns == before):
                        time.sleep(0.0005)
                    time.sleep(self.random.uniform(0, 1) * (self.writing if k % 4 else FIRST_FILE))
                process.kill()
            ends[process.returncode] = ends.get(process.returncode, 0) + 1
            strays = self.halves(out, f"kill {k}")
            left += strays > 0
            most = max(most, strays)
            results += self.mixture(out, f"kill {k}")
        for lobes in (1, 2):
            self.run(out, lobes)
            after = self.halves(out, "after the kills")
            if after:
                self.fail(f"after the kills {after} temporary files are left")
            if not self.mixture(out, "after the kills"):
                self.fail("after the kills there is no result.json")
        self.row("killed (SIGKILL), half of them while results are written", self.args.kills,
                 f"{words(ends)}; temporary files left by {left}, at most {most}, {after} after the next whole run; "
                 f"result.json was there after {results}, always with all files of its run; the next run's results are "
                 f"the undisturbed one's, bit by bit")

    def interrupts(self):
        ends = {}
        for k in range(10):
            out = self.folder / f"interrupted{k}"
            with subprocess.Popen(self.command(out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                time.sleep(self.random.uniform(0.05, 0.9) * self.seconds)
                process.send_signal(signal.SIGINT)
            code = process.returncode
            ends[code] = ends.get(code, 0) + 1
            if self.halves(out, f"interrupt {k}"):
                self.fail(f"interrupt {k} left temporary files")
            if code not in (130, 0, 3, -signal.SIGINT):
                self.fail(f"interrupt {k}: exit {code}")
            if code in (130, 0, 3) and not (out / "report.html").exists():
                self.fail(f"interrupt {k}: exit {code} without results")
        self.row("interrupted (SIGINT)", 10, words(ends) + " (signal 2: before the solve began)")

    def full_disk(self):
        disk = self.folder / "disk"
        disk.mkdir()
        sizes = [4, 64, 1024, 30000, 34250]  # KiB; the table alone takes 34172
        said = 0
        for kib in sizes:
            if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kib}k", "tmpfs", str(disk)],
                              capture_output=True).returncode != 0:
                print("SKIPPED: the full disk needs the right to mount a tmpfs")
                self.row("full disk", 0, "skipped: no right to mount")
                return
            try:
                done = self.run(disk / "out")
                if done.returncode == 0 or done.returncode == 3:
                    self.fail(f"a disk of {kib} KiB was large enough")
                self.expect_one_line(done, f"disk of {kib} KiB")
                if self.halves(disk / "out", f"disk of {kib} KiB"):
                    self.fail(f"a disk of {kib} KiB has temporary files left")
                if (disk / "out" / "result.json").exists():
                    self.fail(f"a disk of {kib} KiB has a result.json")
                said += "No space left" in done.stderr
            finally:
                subprocess.run(["umount", str(disk)], check=True)
        self.row(f"full disk ({sizes[0]} KiB to {sizes[-1] // 1000} MB)", len(sizes),
                 f"each an error of one line, {said} of them 'No space left'; no temporary file, no result.json")

    def unwritable(self):
        for out in ("/proc/ibrdf", str(self.folder / "input.exr"), "/dev/null/x"):
            done = self.run(out)
            if done.returncode != 2:
                self.fail(f"{out}: exit {done.returncode}")
            self.expect_one_line(done, out)
        # Before the solve: a budget that only a refusal keeps.
        start = time.monotonic()
        self.run("/proc/ibrdf", command=self.command("/proc/ibrdf") + ["--set", "solver.max_iterations=1000000"])
        if time.monotonic() - start > 60:
            self.fail("an unwritable folder is found out after the solve")
        self.row("unwritable folder", 4, "exit 2 and one line, before the solve")

    def vanishing(self):
        kept = (self.folder / "map.exr").read_bytes()
        ends = {}
        for k in range(10):
            out = self.folder / f"vanished{k}"
            with subprocess.Popen(self.command(out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  text=True) as process:
                time.sleep(0 if k == 0 else self.random.uniform(0, 1) * self.seconds)
                (self.folder / "map.exr").unlink()
                stderr = process.communicate()[1]
            (self.folder / "map.exr").write_bytes(kept)
            code = process.returncode
            ends[code] = ends.get(code, 0) + 1
            if code == 2 and "map.exr" not in stderr or code not in (0, 2, 3):
                self.fail(f"vanished map: exit {code}: {stderr!r}")
            self.halves(out, f"vanished map {k}")
            if code in (0, 3):
                self.mixture(out, f"vanished map {k}")
        self.row("map file removed during the run", 10,
                 words(ends) + " (2: before it was read, and named; else the undisturbed results)")

    def memory(self):
        """Address space: the loader's own need, then limits between it and plenty, with one thread and with two."""
        library_error = 127  # the loader's, before the program has begun
        ends = {}
        times = 0
        for threads in (1, 2):
            for mb in (60, 150, 200, 250, 300, 350, 400, 450, 500, 600, 800, 1200):
                where = f"{mb} MB, {threads} threads"
                out = self.folder / f"memory{mb}-{threads}"
                command = self.command(out, threads=threads)
                done = self.run(out, command=command, preexec_fn=lambda mb=mb: resource.setrlimit(
                    resource.RLIMIT_AS, (mb << 20, mb << 20)))
                times += 1
                ends[done.returncode] = ends.get(done.returncode, 0) + 1
                if done.returncode == 1:
                    self.expect_one_line(done, where)
                    if "memory" not in done.stderr:
                        self.fail(f"{where}: not said that memory was short: {done.stderr!r}")
                elif done.returncode not in (0, 3, library_error):
                    self.fail(f"{where}: exit {done.returncode}: {done.stderr[-200:]!r}")
                if self.halves(out, where):
                    self.fail(f"{where}: temporary files left")
                if done.returncode in (0, 3):
                    self.mixture(out, where)
        self.row("address space of 60 to 1200 MB, one and two threads", times,
                 words(ends) + " (127: the loader has no room for the libraries)")

    def sweep(self):
        """A sweep killed with its solver at random moments and started again, until it is done."""
        if self.args.data is None or self.args.maps is None:
            print("SKIPPED: the sweep needs --data and --maps")
            self.row("sweep killed", 0, "skipped: no tables and maps given")
            return

        def command(out):
            return [str(self.args.bin / "ibrdf_bench"), "known-light", "--data", str(self.args.data), "--maps",
                    str(self.args.maps), "--materials", SWEEP[0], "--map-names", SWEEP[1], "--size", "16", "--threads",
                    "1", "--solver-seconds", "10000", "--quiet", "--out", str(out)]

        def rows(out):
            with open(out / "results.csv", newline="") as file:
                return [{k: v for k, v in row.items() if k not in TIMINGS} for row in csv.DictReader(file)]

        start = time.monotonic()
        undisturbed = self.folder / "sweep"
        subprocess.run(command(undisturbed), check=True, capture_output=True)
        seconds = time.monotonic() - start
        kills, orphans = 0, 0
        killed = self.folder / "sweep-killed"
        for attempt in range(self.args.sweep_kills):
            with subprocess.Popen(command(killed), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                # The first ones early, so that the sweep is not done before the last one.
                share = self.random.uniform(0, 1) * (attempt + 1) / self.args.sweep_kills
                try:
                    process.wait(share * seconds)
                except subprocess.TimeoutExpired:
                    process.kill()
                    kills += 1
            time.sleep(1)
            orphans += self.solvers_of(killed)
        done = self.run(None, command=command(killed))
        if done.returncode != 0:
            self.fail(f"the sweep did not end: exit {done.returncode}: {done.stderr!r}")
        if orphans:
            self.fail(f"{orphans} solvers went on after their sweep was killed")
        if rows(killed) != rows(undisturbed):
            self.fail(f"the sweep's rows differ: {rows(killed)} {rows(undisturbed)}")
        for path in (undisturbed / "cases").rglob("*"):
            other = killed / path.relative_to(undisturbed)
            if path.name in RESULTS and path.read_bytes() != other.read_bytes():
                self.fail(f"the sweep's {other} is another")
        strays = len(list(killed.rglob(".tmp-*")))
        if strays:
            self.fail(f"the sweep has {strays} temporary files left")
        self.row("sweep of two cases killed (SIGKILL)", kills,
                 f"resumed to its end: the same rows of results.csv but for {' and '.join(TIMINGS)}, the same files bit "
                 f"by bit, no solver that went on, {strays} temporary files")

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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--data", type=pathlib.Path, help="folder of MERL tables")
    parser.add_argument("--maps", type=pathlib.Path, help="folder of maps")
    parser.add_argument("--kills", type=int, default=50, help="of the solver")
    parser.add_argument("--sweep-kills", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1, help="of the random moments")
    parser.add_argument("--table", type=pathlib.Path, help="file for the table")
    parser.add_argument("--only", default=",".join(PARTS), help="parts: " + ",".join(PARTS))
    args = parser.parse_args()
    faults = Faults(args)
    try:
        faults.prepare()
        for part in args.only.split(","):
            getattr(faults, part)()
    finally:
        shutil.rmtree(faults.folder, ignore_errors=True)
    table = "| fault | times | end |\n|---|---|---|\n"
    for row in faults.rows:
        table += "| " + " | ".join(str(c) for c in row) + " |\n"
    print(table)
    if args.table is not None:
        args.table.write_text(table)
    sys.exit(1 if faults.failures else 0)


if __name__ == "__main__":
    main()
