#!/usr/bin/env python3
"""Joint estimates from a first view and a chosen, a far or a random second one. See README.md."""

import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from cases import (FOV, fibonacci_sphere, geometry_of, look_at_origin, model_without, perspective_view,  # noqa: E402
                   solve, write_problem)

COLUMNS = (
    "material", "map", "shape", "second", "candidate", "gain_nats",
    "information_nats", "seconds", "misfit", "brdf_log_rmse_aligned",
    "illumination_relative_log_rmse_aligned",
)


class Case:
    def __init__(self, args, material, light, shape):
        self.args, self.material, self.light, self.shape = args, material, light, shape
        self.folder = args.out / f"{material}-{light}-{shape}"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.mesh = None if shape == "sphere" else args.meshes / f"{shape}.obj"
        self.poses = {"front": look_at_origin((0.0, 0.0, 1.0))}
        for i, direction in enumerate(fibonacci_sphere(args.candidates)):
            self.poses[f"c{i}"] = look_at_origin(direction)
        frames = [{"file_path": f"{name}.exr", "transform_matrix": pose}
                  for name, pose in self.poses.items() if name != "front"]
        write_problem(self.folder / "candidates.json", {"camera_angle_x": math.radians(FOV), "frames": frames})

    def truth(self):
        return {"brdf": str(self.args.data / f"{self.material}.binary"),
                "illumination": str(self.args.maps / f"{self.light}.hdr")}

    def render(self, name):
        if (self.folder / f"views/{name}/mask.png").exists():
            return
        truth = self.truth()
        write_problem(self.folder / f"{name}.yaml", {
            "image": {"width": self.args.size, "height": self.args.size},
            "views": [perspective_view(name, self.poses[name])],
            "geometry": geometry_of(self.mesh),
            "reflectance": {"known": truth["brdf"]},
            "illumination": {"known": truth["illumination"]}, "noise": 0.02})
        subprocess.run([self.args.bin / "ibrdf_render", "--scene", self.folder / f"{name}.yaml",
                        "--out", self.folder / f"input_{name}", "--seed", "1", "--quiet",
                        "--threads", str(self.args.threads)], check=True)
        (self.folder / "views").mkdir(exist_ok=True)
        views = self.folder / f"input_{name}/views/{name}"
        source = views if views.exists() else self.folder / f"input_{name}"
        (self.folder / f"views/{name}").symlink_to(source.resolve())

    def solve(self, names, add):
        """result.json of a joint estimate from some views; of an earlier run, if there is one."""
        for name in names:
            self.render(name)
        tag = "_".join(names)
        write_problem(self.folder / f"joint_{tag}.yaml", {
            "problem": "joint",
            "views": [perspective_view(n, self.poses[n], "views") for n in names],
            "geometry": geometry_of(self.mesh),
            "reflectance": {"model": str(model_without(self.args.models, self.material)),
                            "lobes": 2, "variation": "none"},
            "illumination": {"width": 128, "height": 64},
            "solver": {"seconds": self.args.seconds}, "truth": self.truth()})
        out = self.folder / f"result_{tag}"
        command = [self.args.bin / "ibrdf_solve", "--problem", self.folder / f"joint_{tag}.yaml",
                   "--out", out, "--quiet", "--threads", str(self.args.threads)]
        if add:
            command += ["--add", "1", "--candidates", self.folder / "candidates.json"]
        seconds = out / "wall.txt"
        if seconds.exists():
            return {**json.loads((out / "result.json").read_text()), "wall": float(seconds.read_text())}
        start = time.time()
        result = solve(command, out)
        wall = round(time.time() - start, 1)
        seconds.write_text(f"{wall}\n")
        return {**result, "wall": wall}


def run(case, seed, rows):
    first = case.solve(["front"], add=True)
    chosen = first["next_views"]
    gains = {c["candidate"]: c["gain_nats"] for c in chosen["as_the_next_one"]}
    seconds = [("chosen", chosen["chosen"][0]["candidate"]),
               ("farthest", chosen["farthest_points"][0])]
    if case.args.least:
        seconds.append(("least", min(gains, key=gains.get)))
    generator = random.Random(seed)
    rest = sorted(set(gains) - {name for _, name in seconds})
    seconds += [("random", name) for name in generator.sample(rest, case.args.random)]
    solved = {}

    def add(kind, name, result):
        metrics = result["metrics"]
        row = {"material": case.material, "map": case.light, "shape": case.shape,
               "second": kind, "candidate": name, "gain_nats": gains.get(name),
               "information_nats": chosen["information_nats"], "seconds": result["wall"]}
        row.update({key: metrics.get(key) for key in COLUMNS[8:]})
        rows(row)

    add("none", "", first)
    for kind, name in seconds:
        if name not in solved:
            solved[name] = case.solve(["front", name], add=False)
        add(kind, name, solved[name])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default="build/release/bin")
    parser.add_argument("--data", type=pathlib.Path, required=True, help="MERL tables")
    parser.add_argument("--maps", type=pathlib.Path, required=True)
    parser.add_argument("--meshes", type=pathlib.Path, required=True)
    parser.add_argument("--models", type=pathlib.Path, required=True,
                        help="folder of fold0.ibrdf and fold1.ibrdf")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--cases", required=True, help="material:map:shape, comma between")
    parser.add_argument("--candidates", type=int, default=12)
    parser.add_argument("--random", type=int, default=1, help="random second views of a case")
    parser.add_argument("--least", action="store_true", help="the view of the least gain, too")
    parser.add_argument("--size", type=int, default=48, help="pixels a side")
    parser.add_argument("--seconds", type=float, default=900)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    args.bin, args.data, args.maps, args.meshes, args.models, args.out = (
        p.resolve() for p in (args.bin, args.data, args.maps, args.meshes, args.models, args.out))
    args.out.mkdir(parents=True, exist_ok=True)
    with open(args.out / "results.csv", "w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()

        def rows(row):
            table.writerow(row)
            file.flush()
            print(row, flush=True)

        for k, name in enumerate(args.cases.split(",")):
            run(Case(args, *name.split(":")), k, rows)


if __name__ == "__main__":
    main()
