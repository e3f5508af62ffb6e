#!/usr/bin/env python3
"""Spheres of two and three materials beside the same materials alone: made, solved and measured.

    experiments/labels/labels.py CASES MODELS TABLES MAPS OUT [--bin DIR]

CASES: the folder `cases` of `ibrdf_bench render-inputs`, whose images are put together pixel by pixel. MODELS:
fold0.ibrdf and fold1.ibrdf, trained without the materials. A row of OUT/results.csv for each material of a case, as its
solve finishes; the same command goes on where it was stopped. Needs Debian's python3-opencv.

together, alone: aligned log-RMSE of the material's BRDF. map, best_map: aligned relative log-RMSE of the light from the
whole picture, and the least of those from its materials alone.
"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402
import numpy as np  # noqa: E402

PATCH = 24  # pixels a side
# Of each map: the fold of the model that saw none of them, and four materials.
OBJECTS = {
    "city": (0, ["pink-jasper", "green-plastic", "aluminium", "white-marble"]),
    "studio": (1, ["pink-fabric2", "polyethylene", "dark-blue-paint", "silicon-nitrade"]),
    "forest": (0, ["black-oxidized-steel", "red-plastic", "blue-metallic-paint2", "nickel"]),
    "night": (1, ["pure-rubber", "dark-specular-fabric", "tungsten-carbide", "brass"]),
    "lobby": (0, ["specular-green-phenolic", "green-latex", "pink-jasper", "red-plastic"]),
}
# Which of the four share a sphere, and how they lie on it.
SPHERES = [((0, 1), "patches"), ((1, 2), "stripes"), ((2, 3), "patches"), ((0, 2, 3), "patches")]
COLUMNS = ["case", "map", "where", "material", "together", "alone", "map_error", "best_map", "misfit", "seconds"]
FRAME = "ibrdf_0_1"  # in which ibrdf_bench renders with the maps
NO_IMPROVEMENT = 3  # exit status
PROBLEM = """problem: joint
image: {{file: input.exr, mask: mask.png}}
geometry: {{sphere: {{}}}}
reflectance: {{model: {model}, {reflectance}}}
solver: {{seconds: 6000}}
"""


def read(path):
    return cv2.imread(str(path), cv2.IMREAD_UNCHANGED)


def places(where, count, shape):
    """Which of `count` materials is at each pixel. Stripes are as wide as the sphere over `count`."""
    y, x = np.mgrid[0:shape[0], 0:shape[1]]
    return x * count // shape[1] if where == "stripes" else (x // PATCH + y // PATCH) % count


def parser_of(description, folders):
    """With the folders as positional arguments, and --bin."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in folders:
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--bin", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parents[2] / "build/release/bin")
    return parser


class Table:
    """A CSV file of results, begun or gone on with."""

    def __init__(self, path, columns):
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        self.rows = list(csv.reader(path.open())) if path.exists() else [columns]

    def has(self, case):
        return case in [row[0] for row in self.rows]

    def add(self, rows):
        self.rows += rows
        with self.path.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(self.rows)


def copy_image(source, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("input.exr", "mask.png"):
        shutil.copy(source / name, folder)


class Labels:
    def __init__(self, arguments):
        self.arguments = arguments

    def metric(self, name, *command):
        done = subprocess.run([self.arguments.bin / "ibrdf_eval", *command], capture_output=True, text=True, check=True)
        return json.loads(done.stdout)[name]

    def command(self, folder, fold, reflectance):
        """The solve of what is in the folder, whose problem is written."""
        problem = folder / "problem.yaml"
        model = (self.arguments.models / f"fold{fold}.ibrdf").resolve()
        problem.write_text(PROBLEM.format(model=model, reflectance=reflectance))
        return [self.arguments.bin / "ibrdf_solve", "--problem", problem, "--out", folder / "out", "--threads", "1"]

    def solve(self, folder, fold, reflectance):
        """Solves what is in the folder, once."""
        if (folder / "out" / "result.json").exists():
            return
        done = subprocess.run([*self.command(folder, fold, reflectance), "--quiet"], capture_output=True, text=True)
        if done.returncode not in (0, NO_IMPROVEMENT):
            raise RuntimeError(done.stderr)

    def brdf_error(self, estimate, material):
        return self.metric("brdf_log_rmse_aligned", "brdf", estimate, self.arguments.tables / f"{material}.binary")

    def map_error(self, folder, light):
        return self.metric("illumination_relative_log_rmse_aligned", "illumination", folder / "out" / "illumination.exr",
                           self.arguments.maps / f"{light}.hdr", "--frame-b", FRAME)

    def alone(self, material, light, fold):
        """Errors of the BRDF and of the map from the image of one material."""
        folder = self.arguments.out / "alone" / f"{material}_{light}"
        copy_image(self.arguments.cases / f"{material}_{light}", folder)
        self.solve(folder, fold, "variation: none")
        return self.brdf_error(folder / "out" / "brdf.binary", material), self.map_error(folder, light)

    def compose(self, folder, materials, light, where):
        """Labels 40, 80, ... are the materials in their order."""
        sources = [self.arguments.cases / f"{material}_{light}" for material in materials]
        images = [read(source / "input.exr") for source in sources]
        place = places(where, len(materials), images[0].shape)
        cv2.imwrite(str(folder / "input.exr"), np.choose(place[..., None], images))
        cv2.imwrite(str(folder / "labels.png"), (40 * (place + 1)).astype(np.uint8))
        shutil.copy(sources[0] / "mask.png", folder)

    def rows(self, case, light, where, fold, materials):
        folder = self.arguments.out / case
        folder.mkdir(parents=True, exist_ok=True)
        self.compose(folder, materials, light, where)
        self.solve(folder, fold, "labels: labels.png")
        alone = [self.alone(material, light, fold) for material in materials]
        result = json.loads((folder / "out" / "result.json").read_text())
        light_error = self.map_error(folder, light)
        for k, material in enumerate(materials):
            together = self.brdf_error(folder / "out" / f"brdf_{40 * (k + 1)}.binary", material)
            yield [case, light, where, material, f"{together:.3f}", f"{alone[k][0]:.3f}", f"{light_error:.4f}",
                   f"{min(error for _, error in alone):.4f}", f"{result['metrics']['misfit']:.4f}",
                   f"{result['metrics']['seconds']:.0f}"]


def main():
    arguments = parser_of(__doc__, ("cases", "models", "tables", "maps", "out")).parse_args()
    table = Table(arguments.out / "results.csv", COLUMNS)
    for number, (members, where) in enumerate(SPHERES):
        for light, (fold, four) in OBJECTS.items():
            case = f"{light}_{number}"
            if table.has(case):
                continue
            materials = [four[m] for m in members]
            table.add(Labels(arguments).rows(case, light, where, fold, materials))
            print(case, flush=True)


if __name__ == "__main__":
    main()
