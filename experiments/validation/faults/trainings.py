"""Faults of ibrdf_train: kills, a full disk, an unwritable folder."""
import collections
import re
import signal
import subprocess
import time

import checks
from solves import SCENE
from study import Study

STEPS = 2500
STOPPED = re.compile(r"training stopped at step (\d+)")
FOLDERS = ("/proc/ibrdf", "/dev/null/x")


class Trainings(Study):
    def __init__(self, args, rows):
        super().__init__(args, rows)
        self.data = self.folder / "data"
        self.data.mkdir()
        (self.folder / "scene.yaml").write_text(SCENE)
        for name, roughness in (("matte", 1.0), ("glossy", 0.2)):
            self.render("--out", self.folder / "any.exr", "--brdf-out", self.data / f"{name}.binary",
                        "--set", f"reflectance.known.cook_torrance.roughness={roughness}")
        model = self.folder / "whole.ibrdf"
        start = time.monotonic()
        done = self.run(self.command(model))
        self.seconds = time.monotonic() - start
        if done.returncode != 0:
            raise RuntimeError(f"the undisturbed training failed: {done.stderr}")
        self.model = model.read_bytes()

    def command(self, out, steps=STEPS):
        # A checkpoint every few steps: kills meet its writing.
        return [self.program("ibrdf_train"), "--data", str(self.data), "--out", str(out), "--threads", "1", "--columns",
                "64", "--analytic", "2", "--codes-per-step", "8", "--steps", str(steps), "--checkpoint-seconds", "0.02",
                "--report-seconds", "0.02"]

    def expect_whole(self, out, where):
        if out.exists() and out.read_bytes() != self.model:
            self.fail(f"{where}: the model is another")
        return out.exists()

    def training(self):
        """Killed and interrupted by turns and started again, until it is done; then anew."""
        ends, met, resumed, models, left = collections.Counter(), collections.Counter(), 0, 0, 0
        folder = self.folder / "killed"
        out = folder / "model.ibrdf"
        checkpoint = folder / "model.ibrdf.checkpoint"
        log = self.folder / "progress.txt"
        stopped, faults, k = 0, 0, 0
        while faults < self.args.training_kills:
            k += 1
            where = f"training {k}"
            began_with = checkpoint.exists()
            with open(log, "w", encoding="utf-8") as file:
                with subprocess.Popen(self.command(out), stdout=file, stderr=subprocess.PIPE, text=True) as process:
                    try:
                        process.wait(self.random.uniform(0, 1) * self.seconds)
                    except subprocess.TimeoutExpired:
                        process.send_signal(signal.SIGINT if k % 2 else signal.SIGKILL)
                        faults += 1
                        steps = re.findall(r"^step +(\d+) /", log.read_text(), re.MULTILINE)
                        met["before" if not steps else "after" if int(steps[-1]) == STEPS else "in"] += 1
                        resumed += began_with
                    stderr = process.communicate()[1]
            ends[process.returncode] += 1
            strays = len(list(folder.glob(".tmp-*"))) if folder.exists() else 0
            left += strays > 0
            there = self.expect_whole(out, where)
            code = process.returncode
            if code == 130:
                step = int((STOPPED.search(stderr) or [0, STEPS])[1])  # after the steps none is named
                if step < stopped or not checkpoint.exists():
                    self.fail(f"{where}: stopped at step {step} after {stopped}")
                stopped = step
            elif code not in (0, -signal.SIGKILL, -signal.SIGINT):  # SIGINT: while it reads the tables
                self.fail(f"{where}: exit {code}: {stderr!r}")
            if code == 0:
                models += there
                if not there or checkpoint.exists() or strays:
                    self.fail(f"{where}: ended with {[p.name for p in folder.iterdir()]}")
                out.unlink()
                stopped = 0
        done = self.run(self.command(out))
        if done.returncode != 0 or not self.expect_whole(out, "resumed training") or len(list(folder.iterdir())) > 1:
            self.fail(f"the training did not end: exit {done.returncode}: {done.stderr!r}")
        moments = ", ".join(f"{met[p]} {p}" for p in ("before", "in", "after"))
        self.row("training killed (SIGKILL) or interrupted (SIGINT), by turns", faults,
                 f"{moments} the steps, {resumed} in runs that went on from a checkpoint; {checks.words(ends)} (signal "
                 f"2: before the tables were read)")
        self.row("what those trainings left", "the same",
                 f"temporary files left by {left}, 0 by a run that ended; no checkpoint that the next run refused, no "
                 f"step lost by SIGINT; {models + 1} resumed runs ended, each with the undisturbed model, bit by bit")

    def training_disk(self):
        checkpoint = 0
        sizes = []
        with self.small_disk(200000) as disk:
            if disk is None:
                self.row("full disk of a training", 0, "skipped: no right to mount a tmpfs")
                return
            with subprocess.Popen(self.command(disk / "model.ibrdf"), stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as process:
                path = disk / "model.ibrdf.checkpoint"
                while process.poll() is None and not path.exists():
                    time.sleep(0.001)
                process.kill()
            checkpoint = path.stat().st_size // 1024
        # Less than a checkpoint; one but not its successor beside it.
        sizes = [4, checkpoint // 2, checkpoint * 3 // 2]
        for kib in sizes:
            where = f"training on a disk of {kib} KiB"
            with self.small_disk(kib) as disk:
                out = disk / "model.ibrdf"
                self.refused(self.run(self.command(out)), where, disk / "model.ibrdf")
                self.enlarge(disk, 200000)
                done = self.run(self.command(out))
                if done.returncode != 0 or not self.expect_whole(out, where) or len(list(disk.iterdir())) > 1:
                    self.fail(f"{where}, then room: exit {done.returncode}: {done.stderr!r}")
        # The model itself.
        model = self.folder / "whole.ibrdf"
        kib = len(self.model) // 2048
        with self.small_disk(kib) as disk:
            out = disk / "model.ibrdf"
            self.refused(self.run([self.program("ibrdf_train"), "--refit", model, "--out", out, "--threads", "1"]),
                         "refit on a full disk", out)
            if list(disk.iterdir()):
                self.fail(f"refit on a full disk left {list(disk.iterdir())}")
        for out in FOLDERS:
            start = time.monotonic()
            self.refused(self.run(self.command(f"{out}/model.ibrdf", steps=100000000)), out, out)
            if time.monotonic() - start > 60:
                self.fail(f"{out} is found out after steps")
        self.row("full disk of a training (4 KiB, half and one and a half of a checkpoint; half of a model)",
                 len(sizes) + 1, "each exit 2 and one line with the file, nothing half-written; run again with room: "
                                 "the undisturbed model, bit by bit")
        self.row("unwritable folder of a training", len(FOLDERS), "exit 2 and one line, before its first step")

    def refused(self, done, where, *what):
        if done.returncode != 2:
            self.fail(f"{where}: exit {done.returncode}")
        self.expect_one_line(done, where, *what)
