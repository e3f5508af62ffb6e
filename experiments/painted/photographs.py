#!/usr/bin/env python3
"""Albedo of photographed painted objects against what was measured.

    experiments/painted/photographs.py PHOTOGRAPHS OUT [--lights original,light01] [--bin DIR]

PHOTOGRAPHS: a folder with a folder for each object: the image of each light, mask.png, normals.exr and
reflectance.png, all linear (MIT intrinsic images, Grosse et al. 2009). A light may be several, as original+light01: one
solve of both photographs, its image's error that of the first. A row of OUT/results.csv as each solve finishes;
the same command goes on where it was stopped. Log-RMSE and LMSE are aligned by a scale per channel (ibrdf_eval albedo).
"""
import argparse
import csv
import json
import pathlib
import subprocess
import time

COLUMNS = ["object", "light", "variation", "log_rmse", "constant", "image", "lmse", "seconds"]
PROBLEM = """problem: joint
images: [{files}]
image: {{mask: {folder}/mask.png, response: linear}}
geometry: {{normals: {folder}/normals.exr}}
reflectance: {{variation: {variation}}}
solver: {{seconds: 300}}
"""


def evaluate(binaries, estimate, folder):
    """The metrics of an albedo file against the measured one."""
    done = subprocess.run([binaries / "ibrdf_eval", "albedo", estimate, folder / "reflectance.png", "--mask", folder / "mask.png"],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def solve(binaries, folder, light, variation, out):
    """Solves one photograph; a row of COLUMNS."""
    case = out / f"{folder.name}_{light}_{variation}"
    case.mkdir(parents=True, exist_ok=True)
    problem = case / "problem.yaml"
    lights = light.split("+")
    files = ", ".join(f"{folder.resolve()}/{one}.png" for one in lights)
    problem.write_text(PROBLEM.format(folder=folder.resolve(), files=files, variation=variation))
    began = time.monotonic()
    subprocess.run([binaries / "ibrdf_solve", "--problem", problem, "--out", case, "--quiet"], check=True)
    seconds = time.monotonic() - began
    metrics = evaluate(binaries, case / "albedo.exr", folder)
    # The mask is white: a constant albedo.
    constant = evaluate(binaries, folder / "mask.png", folder)["albedo_log_rmse_aligned"]
    image = evaluate(binaries, folder / f"{lights[0]}.png", folder)["albedo_log_rmse_aligned"]
    return [folder.name, light, variation, f"{metrics['albedo_log_rmse_aligned']:.3f}", f"{constant:.3f}", f"{image:.3f}",
            f"{metrics['albedo_lmse']:.4f}", f"{seconds:.0f}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("photographs", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--lights", default="original")
    parser.add_argument("--objects", default="apple,pear,cup1,teabag2,turtle,squirrel")
    parser.add_argument("--variation", default="auto")
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2] / "build/release/bin")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    table = arguments.out / "results.csv"
    rows = list(csv.reader(table.open())) if table.exists() else [COLUMNS]
    done = {tuple(row[:3]) for row in rows[1:]}
    for name in arguments.objects.split(","):
        for light in arguments.lights.split(","):
            if (name, light, arguments.variation) in done:
                continue
            row = solve(arguments.bin, arguments.photographs / name, light, arguments.variation, arguments.out)
            rows.append(row)
            with table.open("w", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows(rows)
            print(" ".join(row), flush=True)


if __name__ == "__main__":
    main()
