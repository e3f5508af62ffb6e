#!/usr/bin/env python3
"""Painted and unpainted balls of make_scenes.py whose map is known, rightly and in a wrong frame.

    experiments/painted/known_light.py TABLES MAPS MESHES OUT [--only 1/3] [--bin DIR]

Each picture is solved by `problem: reflectance` with the map in the frame that it was made with, camera, and in three
wrong frames. The models are the program's own. A row of OUT/known_light.csv as each solve finishes; the
same command goes on where it was stopped. Needs Debian's python3-numpy.

painted: whether albedo was sought. albedo, constant: log-RMSE of albedo, of the estimate and of an even one, after the
best scale of each channel. advice: the frame that the verdict asks for.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from make_scenes import add_arguments, cases, make, write_meshes  # noqa: E402

COLUMNS = ["case", "picture", "frame", "painted", "misfit", "albedo", "constant", "advice", "seconds"]
PROBLEM = """problem: reflectance
image: {{file: {picture}.exr, mask: mask.png}}
geometry: {{sphere: {{}}}}
illumination: {{known: {map}, frame: {frame}}}
"""
RUNS = [(picture, frame) for picture in ("painted", "unpainted")
        for frame in ("camera", "mitsuba", "blender", "ibrdf_0_1")]
NO_IMPROVEMENT = 3  # exit status


def run(*command, allowed=(0,)):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in allowed:
        raise RuntimeError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


class KnownLight:
    """The solves of one case."""

    def __init__(self, arguments, case):
        self.arguments, self.case = arguments, case
        self.scene = arguments.out / case.name

    def metric(self, name, *command):
        return f"{json.loads(run(self.arguments.bin / 'ibrdf_eval', *command))[name]:.3f}"

    def albedo_error(self, estimate):
        mask = self.scene / "mask.png"
        if not estimate.exists():
            return ""
        return self.metric("albedo_log_rmse_aligned", "albedo", estimate, self.scene / "albedo.pfm", "--mask", mask)

    def row(self, picture, frame):
        folder = self.scene / f"known_{picture}_{frame}"
        problem = self.scene / f"{folder.name}.yaml"
        problem.write_text(PROBLEM.format(picture=picture, frame=frame,
                                          map=(self.arguments.maps / f"{self.case.map}.hdr").resolve()))
        began = time.monotonic()
        said = run(self.arguments.bin / "ibrdf_solve", "--problem", problem, "--out", folder, "--threads", "1",
                   allowed=(0, NO_IMPROVEMENT))
        seconds = time.monotonic() - began
        advice = re.search(r"^Next, try illumination.frame: (\w+)|^Next, check (illumination.frame)", said, re.MULTILINE)
        painted = (folder / "albedo.exr").exists()
        of_paint = picture == "painted"
        return {
            "case": self.case.name, "picture": picture, "frame": frame, "painted": int(painted),
            "misfit": re.search(r"^  misfit (\S+)", said, re.MULTILINE)[1],
            "albedo": self.albedo_error(folder / "albedo.exr") if of_paint else "",
            "constant": self.albedo_error(self.scene / "mask.png") if of_paint else "",
            "advice": (advice[1] or advice[2]) if advice else "", "seconds": f"{seconds:.1f}"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    arguments = parser.parse_args()
    write_meshes(arguments)
    results = arguments.out / "known_light.csv"
    done = set()
    if results.exists():
        with open(results, newline="") as file:
            done = {(r["case"], r["picture"], r["frame"]) for r in csv.DictReader(file)}
    for case in cases(arguments.only):
        if case.shape != "sphere":
            continue
        make(case, arguments)
        for picture, frame in RUNS:
            if (case.name, picture, frame) in done:
                continue
            row = KnownLight(arguments, case).row(picture, frame)
            new = not results.exists()
            with open(results, "a", newline="") as file:
                writer = csv.DictWriter(file, COLUMNS)
                if new:
                    writer.writeheader()
                writer.writerow(row)
            print(row, flush=True)


if __name__ == "__main__":
    main()
