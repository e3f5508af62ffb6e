#!/usr/bin/env python3
"""Joint estimates from a first view and a chosen, a far or a random second one. See README.md."""

import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import time

FOLDS = (
    "pink-jasper,green-plastic,aluminium,white-marble,black-oxidized-steel,"
    "red-plastic,blue-metallic-paint2,nickel,specular-green-phenolic,green-latex",
    "pink-fabric2,polyethylene,dark-blue-paint,silicon-nitrade,pure-rubber,"
    "dark-specular-fabric,tungsten-carbide,brass,red-fabric2,"
    "specular-orange-phenolic",
)
COLUMNS = (
    "material", "map", "shape", "second", "candidate", "gain_nats",
    "information_nats", "seconds", "misfit", "brdf_log_rmse_aligned",
    "illumination_relative_log_rmse_aligned",
)
FOV, DISTANCE = 32.0, 4.0


def look_at_origin(direction):
    """Rows of the pose of a camera that stands there, y up."""
    back = direction
    up = (0.0, 0.0, 1.0) if abs(back[1]) > 0.99 else (0.0, 1.0, 0.0)
    right = (up[1] * back[2] - up[2] * back[1], up[2] * back[0] - up[0] * back[2],
             up[0] * back[1] - up[1] * back[0])
    norm = math.sqrt(sum(x * x for x in right))
    right = tuple(x / norm for x in right)
    up = (back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
          back[0] * right[1] - back[1] * right[0])
    return [[right[i], up[i], back[i], DISTANCE * back[i]] for i in range(3)] + [[0, 0, 0, 1]]


def candidates(count):
    """Directions of a Fibonacci sphere."""
    golden = math.pi * (3.0 - math.sqrt(5.0))
    out = []
    for i in range(count):
        y = 1.0 - (2.0 * i + 1.0) / count
        r = math.sqrt(1.0 - y * y)
        out.append((r * math.sin(golden * i), y, r * math.cos(golden * i)))
    return out


def write(path, document):
    # JSON is YAML.
    path.write_text(json.dumps(document, indent=1) + "\n")


def view_of(name, pose, with_file):
    view = {"name": name, "camera": {"type": "perspective", "fov_degrees": FOV,
                                     "world_from_camera": pose}}
    if with_file:
        view["file"] = f"views/{name}/render.exr"
        view["mask"] = f"views/{name}/mask.png"
    return view


def geometry_of(args, shape):
    return {"sphere": {}} if shape == "sphere" else {"mesh": str(args.meshes / f"{shape}.obj"), "fit": "unit_sphere"}


class Case:
    def __init__(self, args, material, light, shape):
        self.args, self.material, self.light, self.shape = args, material, light, shape
        self.folder = args.out / f"{material}-{light}-{shape}"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.poses = {"front": look_at_origin((0.0, 0.0, 1.0))}
        for i, direction in enumerate(candidates(args.candidates)):
            self.poses[f"c{i}"] = look_at_origin(direction)
        frames = [{"file_path": f"{name}.exr", "transform_matrix": pose}
                  for name, pose in self.poses.items() if name != "front"]
        write(self.folder / "candidates.json",
              {"camera_angle_x": math.radians(FOV), "frames": frames})

    def truth(self):
        return {"brdf": str(self.args.data / f"{self.material}.binary"),
                "illumination": str(self.args.maps / f"{self.light}.hdr")}

    def render(self, name):
        if (self.folder / f"views/{name}/mask.png").exists():
            return
        truth = self.truth()
        write(self.folder / f"{name}.yaml", {
            "image": {"width": self.args.size, "height": self.args.size},
            "views": [view_of(name, self.poses[name], False)],
            "geometry": geometry_of(self.args, self.shape),
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
        fold = 0 if self.material in FOLDS[0].split(",") else 1
        write(self.folder / f"joint_{tag}.yaml", {
            "problem": "joint",
            "views": [view_of(n, self.poses[n], True) for n in names],
            "geometry": geometry_of(self.args, self.shape),
            "reflectance": {"model": str(self.args.models / f"fold{fold}.ibrdf"),
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
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
        if done.returncode not in (0, 3):
            raise SystemExit(f"{out}: {done.stderr}")
        wall = round(time.time() - start, 1)
        seconds.write_text(f"{wall}\n")
        return {**json.loads((out / "result.json").read_text()), "wall": wall}


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
