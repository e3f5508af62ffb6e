#!/usr/bin/env python3
"""Solves the pictures of make_scenes.py and measures what comes out.

    experiments/painted/scenes.py TABLES MAPS MESHES OUT MODELS [--only 1/5] [--settings auto,unpainted,none] [--bin DIR]

MODELS: fold0.ibrdf and fold1.ibrdf, trained without the materials. Settings: `auto`, `albedo` and `none` are values of
`reflectance.variation`; `unpainted` is unpainted.exr with `none`. A row of OUT/results.csv as each solve finishes; the
same command goes on where it was stopped. Needs Debian's python3-numpy.

Errors are root mean squares of natural logarithms, after the best scale of each channel. brdf: of the table of the
object's mean paint. gloss: of f_matte + s f_gloss, f_matte the truth's and s the best for each channel, so that gloss
alone is measured. map: as in joint_grid. variation: what the solve took.
"""
import argparse
import csv
import fcntl
import json
import pathlib
import resource
import subprocess
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from files import read_exr, read_merl, write_pfm  # noqa: E402
from make_scenes import add_arguments, cases, make, write_meshes  # noqa: E402

COLUMNS = ["case", "setting", "texture", "coat", "material", "shape", "map", "albedo", "constant", "brdf", "gloss",
           "map_error", "misfit", "variation", "seconds", "cpu_seconds"]
FLOOR = 1e-6  # of raw MERL values, as in ibrdf_eval brdf
PROBLEM = """problem: joint
image: {{file: {picture}.exr}}
geometry: {geometry}
reflectance: {{model: {model}, variation: {variation}}}
solver: {{seconds: 3600}}
"""


# A ball of 8x8 pixels: for its table, not its picture.
TABLE_SCENE = """image: {{width: 8, height: 8}}
geometry: {{sphere: {{}}}}
reflectance: {{known: {{{material}, albedo: {paint}, unpainted_albedo: auto}}}}
illumination: {{width: 16, height: 8, known: {{sky: {{}}}}}}
quality: preview
"""
NO_IMPROVEMENT = 3  # exit status


def run(*command, allowed=(0,)):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in allowed:
        raise RuntimeError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


def metric(arguments, name, *command):
    return json.loads(run(arguments.bin / "ibrdf_eval", *command))[name]


def gloss_error(estimate, truth):
    """estimate: gloss [3, bins]; truth: (whole, gloss) likewise."""
    whole, gloss = truth
    used = whole[0] > 0
    total = 0.0
    for c in range(3):
        target = np.log(np.maximum(whole[c, used], 0) + FLOOR)
        matte = np.maximum(whole[c, used] - gloss[c, used], 0)
        lobe = np.maximum(estimate[c, used], 0)

        def error(log_scale, step):
            return np.mean((np.log(matte[::step] + np.exp(log_scale) * lobe[::step] + FLOOR) - target[::step])**2)

        scales = np.linspace(-6, 6, 49)
        best = scales[np.argmin([error(s, 41) for s in scales])]
        fine = np.linspace(best - 0.25, best + 0.25, 21)
        total += error(fine[np.argmin([error(s, 11) for s in fine])], 1)
    return np.sqrt(total / 3)


class Solved:
    """What is measured of one solve."""

    def __init__(self, arguments, case, setting):
        self.arguments, self.case, self.setting = arguments, case, setting
        self.scene = arguments.out / case.name
        self.folder = self.scene / setting
        self.mean_albedo = np.frombuffer((self.scene / "even.pfm").read_bytes()[-12:], "<f4")

    def table(self, material, paint, name):
        """The table of a material whose paint is of an albedo [3]."""
        name = f"table_{name}"  # beside gloss.exr and others of the solve
        scene, path = self.folder / f"{name}.yaml", self.folder / f"{name}.binary"
        write_pfm(self.folder / f"{name}.pfm", np.broadcast_to(paint, (8, 8, 3)))
        scene.write_text(TABLE_SCENE.format(material=material, paint=f"{name}.pfm"))
        run(self.arguments.bin / "ibrdf_render", "--scene", scene, "--out", self.folder / f"{name}.exr", "--brdf-out", path)
        return path

    def solve(self):
        picture = "unpainted" if self.setting == "unpainted" else "painted"
        variation = "none" if self.setting == "unpainted" else self.setting
        self.folder.mkdir(exist_ok=True)
        problem = self.scene / f"{self.setting}_problem.yaml"
        problem.write_text(PROBLEM.format(picture=picture, geometry=self.case.geometry(self.arguments.out),
                                          model=(self.arguments.models / f"fold{self.case.fold}.ibrdf").resolve(),
                                          variation=variation))
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        began = time.monotonic()
        run(self.arguments.bin / "ibrdf_solve", "--problem", problem, "--out", self.folder, "--quiet", "--threads", "1",
            allowed=(0, NO_IMPROVEMENT))
        self.seconds = time.monotonic() - began
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def albedo_errors(self):
        """Of the estimate and of a constant."""
        mask, truth = self.scene / "mask.png", self.scene / "albedo.pfm"
        errors = []
        for estimate in (self.folder / "albedo.exr", mask):
            if self.setting != "unpainted" and estimate.exists():
                found = metric(self.arguments, "albedo_log_rmse_aligned", "albedo", estimate, truth, "--mask", mask)
                errors.append(f"{found:.3f}")
            else:
                errors.append("")
        return errors

    def brdf_errors(self):
        """Of the object's mean paint, and of its gloss."""
        black = np.zeros(3)
        known = self.case.material_line(self.arguments.tables)
        found = f"brdf: {(self.folder / 'brdf.binary').resolve()}"
        truth = self.table(known, self.mean_albedo, "truth")
        truth_gloss = self.table(known, black, "truth_gloss")
        gloss = self.table(found, black, "gloss")
        estimate = self.folder / "brdf.binary"
        if (self.folder / "albedo.exr").exists():
            albedo = read_exr(self.folder / "albedo.exr")
            estimate = self.table(found, albedo[albedo.min(-1) > 0].mean(0), "estimate")
        whole = metric(self.arguments, "brdf_log_rmse_aligned", "brdf", estimate, truth)
        of_gloss = gloss_error(read_merl(gloss), (read_merl(truth), read_merl(truth_gloss)))
        for name in ("truth", "truth_gloss", "gloss", "estimate"):
            (self.folder / f"table_{name}.binary").unlink(missing_ok=True)
        return f"{whole:.3f}", f"{of_gloss:.3f}"

    def row(self):
        self.solve()
        case = self.case
        light = metric(self.arguments, "illumination_relative_log_rmse_aligned", "illumination",
                       self.folder / "illumination.exr", self.arguments.maps / f"{case.map}.hdr")
        result = json.loads((self.folder / "result.json").read_text())
        misfit = result["metrics"]["misfit"]
        return [case.name, self.setting, case.texture, case.coat, case.material, case.shape, case.map, *self.albedo_errors(),
                *self.brdf_errors(), f"{light:.4f}", f"{misfit:.4f}", result["variation"], f"{self.seconds:.0f}", f"{self.cpu:.0f}"]


def read_rows(table):
    return list(csv.reader(table.open())) if table.exists() else [COLUMNS]


def add_row(table, row):
    """Several runs may write to one table."""
    with table.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        rows = read_rows(table) + [row]
        with table.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    parser.add_argument("models", type=pathlib.Path)
    parser.add_argument("--settings", default="auto,unpainted,none")
    arguments = parser.parse_args()
    write_meshes(arguments)
    table = arguments.out / "results.csv"
    for case in cases(arguments.only):
        make(case, arguments)
        for setting in arguments.settings.split(","):
            if [case.name, setting] in [row[:2] for row in read_rows(table)]:
                continue
            row = Solved(arguments, case, setting).row()
            add_row(table, row)
            print(" ".join(row), flush=True)


if __name__ == "__main__":
    main()
