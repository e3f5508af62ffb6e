"""What the faults share: a folder, the table's rows, and how a program is run and judged."""
import atexit
import collections
import contextlib
import pathlib
import random
import shutil
import subprocess
import tempfile

import checks

# Longer than any run here takes on a loaded machine: what is not done by then waits forever.
PATIENCE = 600


class Study:
    """The rows of its table are added to `rows`."""

    def __init__(self, args, rows):
        self.args = args
        self.random = random.Random(args.seed)
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="ibrdf-faults-"))
        atexit.register(self.close)  # also where a subclass fails to prepare
        self.failures = []
        self.told = 0  # of them, in rows
        self.rows = rows

    def close(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def fail(self, what):
        self.failures.append(what)
        print("FAILED:", what, flush=True)

    def row(self, fault, times, end):
        if len(self.failures) > self.told:
            end = f"FAILED ({len(self.failures) - self.told}); {end}"
            self.told = len(self.failures)
        self.rows.append((fault, times, end))
        print(f"{fault}, {times} times: {end}", flush=True)

    def program(self, name):
        return str(self.args.bin / name)

    @staticmethod
    def run(command, **options):
        """As subprocess.run; the exit status of one that waits forever is that of the signal that ends it."""
        options = {"stdout": subprocess.DEVNULL, **options}
        with subprocess.Popen([str(c) for c in command], stderr=subprocess.PIPE, text=True, **options) as process:
            try:
                _, stderr = process.communicate(timeout=PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()
                _, stderr = process.communicate()
        return subprocess.CompletedProcess(command, process.returncode, None, stderr)

    def halves(self, out, where):
        """Reports files that are not whole; returns how many strays there are."""
        strays = 0
        for path in out.rglob("*") if out.exists() else []:
            whole = checks.is_whole(path)
            if path.name.startswith(".tmp-"):
                strays += 1
            elif whole is not None and not whole:
                self.fail(f"{where}: {path.name} is not whole")
        return strays

    def expect_one_line(self, done, where, *what):
        """With each of the words `what`."""
        lines = done.stderr.strip().splitlines()
        if len(lines) != 1 or not lines[0].startswith("error: ") or not all(str(w) in lines[0] for w in what):
            self.fail(f"{where}: expected one line with {[str(w) for w in what]}: {done.stderr!r}")

    @contextlib.contextmanager
    def small_disk(self, kib):
        """Its folder; None without the right to mount one."""
        disk = self.folder / "disk"
        disk.mkdir(exist_ok=True)
        if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kib}k", "tmpfs", str(disk)], check=False,
                          capture_output=True).returncode != 0:
            yield None
            return
        try:
            yield disk
        finally:
            subprocess.run(["umount", str(disk)], check=True)

    @staticmethod
    def enlarge(disk, kib):
        subprocess.run(["mount", "-o", f"remount,size={kib}k", str(disk)], check=True)

    def render(self, *options):
        done = self.run([self.program("ibrdf_render"), "--scene", self.folder / "scene.yaml", "--quiet", *options])
        if done.returncode != 0:
            raise RuntimeError(f"ibrdf_render failed: {done.stderr}")


class Moments:
    """How many faults met a program before, in and after its iterations."""

    def __init__(self):
        self.counts = collections.Counter()

    def add(self, phase):
        self.counts[phase] += 1

    def __str__(self):
        return ", ".join(f"{self.counts[p]} {p}" for p in ("before", "in", "after")) + " the iterations"
