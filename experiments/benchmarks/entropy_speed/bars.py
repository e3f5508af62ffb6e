#!/usr/bin/env python3
"""Times and memory of maps of uncertainty, beside their goals. See README.md.

Renders a hundred views of a mesh once, then times `ibrdf_uncertainty` from files to maps, and `entropy_speed`. Needs an
idle machine.
"""
import argparse
import csv
import io
import json
import os
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "common"))
from cases import fibonacci_sphere, geometry_of, look_at_origin, perspective_view, write_problem  # noqa: E402


def views_of(args, folder):
    return [perspective_view(f"v{k:03}", look_at_origin(back), folder)
            for k, back in enumerate(fibonacci_sphere(args.views))]


def prepare(args):
    """Photographs and the problem that names them."""
    geometry = geometry_of(args.mesh and args.mesh.resolve())
    light = {"known": str(args.map.resolve())}
    write_problem(args.out / "views.yaml", {
        "problem": "textures", "geometry": geometry, "illumination": light, "views": views_of(args, "renders/views"),
        "texture": {"width": args.texels, "height": args.texels}})
    if (args.out / f"renders/views/v{args.views - 1:03}/render.exr").exists():
        return
    write_problem(args.out / "scene.yaml", {
        "image": {"width": args.pixels, "height": args.pixels}, "views": views_of(args, None), "geometry": geometry,
        "reflectance": {"known": {"lambertian": 0.5}}, "illumination": light, "quality": "preview", "effects": ["harmonics"]})
    subprocess.run([args.bin / "ibrdf_render", "--scene", args.out / "scene.yaml", "--out", args.out / "renders",
                    "--quiet", "--threads", str(args.threads)], check=True)


def run_map(args):
    """Seconds and peak memory, MB, from files to maps; seconds of its stages."""
    command = [str(args.bin / "ibrdf_uncertainty"), "--problem", str(args.out / "views.yaml"), "--out",
               str(args.out / "maps"), "--quiet", "--threads", str(args.threads)]
    start = time.time()
    pid = os.posix_spawn(command[0], command, os.environ)
    _, status, usage = os.wait4(pid, 0)
    if status != 0:
        raise SystemExit(f"ibrdf_uncertainty ended with status {status}")
    stages = json.loads((args.out / "maps/result.json").read_text())["seconds"]
    return time.time() - start, usage.ru_maxrss / 1024.0, stages


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--map", type=pathlib.Path, required=True, help="the known light")
    parser.add_argument("--mesh", type=pathlib.Path, help="default: the sphere")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="photographs, kept for another run, and maps")
    parser.add_argument("--views", type=int, default=100)
    parser.add_argument("--texels", type=int, default=512, help="of a side of the texture")
    parser.add_argument("--pixels", type=int, default=512, help="of a side of a photograph")
    parser.add_argument("--rounds", type=int, default=3, help="the least time counts")
    parser.add_argument("--threads", type=int, default=2)
    args = parser.parse_args()
    args.bin = args.bin.resolve()
    args.out.mkdir(parents=True, exist_ok=True)
    prepare(args)
    # Goals, in the order of the table of entropy_speed.
    goals = {"harmonics: 26 M directions x 36": 1.0, "spectrum entropy: 512x512 texels, 8x8": 0.03,
             "spectrum entropy: 512x512 texels, 16x16": 0.1, "angular, fits included: 512x512 texels, 8x8x8": 5.0}
    print("part,goal,measured,met")
    text = subprocess.run([args.bin / "entropy_speed"], check=True, stdout=subprocess.PIPE, text=True).stdout
    for row in csv.DictReader(io.StringIO(text)):
        goal = goals.get(row["part"])
        seconds = float(row["seconds"])
        if goal is not None:
            print(f'"{row["part"]} (s)",{goal},{seconds:.4f},{"yes" if seconds <= goal else "no"}', flush=True)
    runs = [run_map(args) for _ in range(args.rounds)]
    seconds, _, stages = min(runs, key=lambda r: r[0])
    memory = max(r[1] for r in runs)
    what = f"{args.views} views, {args.texels}x{args.texels} texels"
    print(f'"files to maps: {what} (s)",20,{seconds:.1f},{"yes" if seconds <= 20 else "no"}')
    print(f'"files to maps: {what} (MB at the peak)",1536,{memory:.0f},{"yes" if memory <= 1536 else "no"}')
    for stage, value in stages.items():
        print(f'"  of which {stage} (s)",,{value:.1f},')


if __name__ == "__main__":
    main()
