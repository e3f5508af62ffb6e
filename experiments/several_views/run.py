#!/usr/bin/env python3
"""Joint estimates of spheres from one view and from several. See README.md."""

import argparse
import csv
import math
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import cases  # noqa: E402

COLUMNS = (
    "material", "map", "size", "views", "seconds", "misfit",
    "brdf_log_rmse_aligned",
    "illumination_relative_log_rmse_aligned", "image_log_rmse",
)


def pose(azimuth):
    """A camera that looks at the origin, turned about y; rows of the pose."""
    s, c = math.sin(azimuth), math.cos(azimuth)
    return [[c, 0, s, 4 * s], [0, 1, 0, 0], [-s, 0, c, 4 * c], [0, 0, 0, 1]]


def views_of(count, files):
    views = []
    for k in range(count):
        # Bits of the index from the lowest: opposite views come first.
        turn = {0: 0, 1: 2, 2: 1, 3: 3}[k] / 4
        view = {"name": f"v{k}",
                "camera": {"type": "orthographic",
                           "world_from_camera": pose(2 * math.pi * turn)}}
        if files:
            view["file"] = f"input/views/v{k}/render.exr"
            view["mask"] = f"input/views/v{k}/mask.png"
        views.append(view)
    return views


def render(args, folder, material, light):
    if (folder / "input/views/v3/mask.png").exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    cases.write_problem(folder / "scene.yaml", {
        "image": {"width": args.size, "height": args.size},
        "views": views_of(4, files=False),
        "geometry": {"sphere": {}},
        "reflectance": {"known": str(args.data / f"{material}.binary")},
        "illumination": {"known": str(args.maps / f"{light}.hdr")},
        "noise": 0.02,
    })
    subprocess.run([args.bin / "ibrdf_render", "--scene",
                    folder / "scene.yaml", "--out", folder / "input",
                    "--seed", "1", "--quiet"], check=True)


def solve(args, folder, material, light, model, count):
    out = folder / f"{args.name}{count}"
    cases.write_problem(folder / f"joint{count}.yaml", {
        "problem": "joint",
        "views": views_of(count, files=True),
        "geometry": {"sphere": {}},
        "reflectance": {"model": str(model), "lobes": 2, "variation": "none"},
        "illumination": {"width": 128, "height": 64},
        "solver": {"seconds": args.seconds},
        "truth": {"brdf": str(args.data / f"{material}.binary"),
                  "illumination": str(args.maps / f"{light}.hdr")},
    })
    start = time.time()
    result = cases.solve(
        [args.bin / "ibrdf_solve", "--problem", folder / f"joint{count}.yaml",
         "--out", out, "--quiet", "--threads", str(args.threads)], out)
    seconds = round(time.time() - start, 1)
    metrics = result["metrics"]
    row = {"material": material, "map": light, "size": args.size, "views": count}
    row.update({key: metrics.get(key) for key in COLUMNS[5:]})
    row["seconds"] = seconds
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default="build/release/bin")
    parser.add_argument("--data", type=pathlib.Path, required=True,
                        help="MERL tables")
    parser.add_argument("--maps", type=pathlib.Path,
                        default="../shared/data/envmaps")
    parser.add_argument("--models", type=pathlib.Path, required=True,
                        help="folder of fold0.ibrdf and fold1.ibrdf")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--map-names", default="city,studio")
    parser.add_argument("--materials", default=",".join(cases.FOLDS))
    parser.add_argument("--views", default="1,4")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--name", default="solve", help="of results' folders")
    args = parser.parse_args()
    args.bin, args.data, args.maps, args.models = (
        p.resolve() for p in (args.bin, args.data, args.maps, args.models))
    args.out.mkdir(parents=True, exist_ok=True)
    with open(args.out / f"{args.name}.csv", "w", newline="") as file:
        rows = csv.DictWriter(file, COLUMNS)
        rows.writeheader()
        for material in args.materials.split(","):
            for light in args.map_names.split(","):
                folder = args.out / f"{material}-{light}"
                render(args, folder, material, light)
                for count in map(int, args.views.split(",")):
                    row = solve(args, folder, material, light,
                                cases.model_without(args.models, material), count)
                    rows.writerow(row)
                    file.flush()
                    print(row, flush=True)


if __name__ == "__main__":
    main()
