#!/usr/bin/env python3
"""Previews of a sphere: what `effects: auto` chooses, its time and its error, beside every point and interpolation by normal.

    experiments/benchmarks/render_speed/previews.py OUT [--bin build/release/bin] [--size 128] [--rounds 2]

The programs take turns; seconds are of their processes' time on the processor, threads together, least of the rounds, with
the planning. Errors (mean |log radiance|) are from an image at reference quality, orthographic ones only: in perspective that
takes minutes. OUT/previews.csv has a row a scene.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys

CAMERAS = {"orthographic": "{type: orthographic}", "perspective": "{type: perspective, fov_degrees: 30, from: [0, 0, 4]}"}
MATERIALS = {
    "matte": "{lambertian: 0.5}",
    "rough_0.4": "{cook_torrance: {diffuse: 0.2, specular: 1, roughness: 0.4, f0: 0.04}}",
    "glossy": "{cook_torrance: {diffuse: 0.2, specular: 1, roughness: 0.15, f0: 0.04}}",
    "mirror": "{cook_torrance: {diffuse: 0, specular: 1, roughness: 0.02, f0: 0.9}}",
}
LIGHTS = {"soft": "{sky: {sun_irradiance: 0}}", "hard": "{sky: {sun_radius_degrees: 0.5}}"}
SETTINGS = {"auto": "auto", "each_point": "none", "by_normal": "[reflectance_map]"}


def run(*command):
    """Seconds on the processor, and what the program said."""
    process = subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, text=True)
    said = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{command[0]}: status {status}")
    return usage.ru_utime + usage.ru_stime, said


def scene_row(args, camera, material, light):
    row = {"camera": camera, "material": material, "light": light}
    folder = args.out / f"{camera}-{material}-{light}"
    folder.mkdir(parents=True, exist_ok=True)
    mask = folder / "mask.png"

    def render(name, effects, quality):
        scene = folder / f"{name}.yaml"
        scene.write_text(f"image: {{width: {args.size}, height: {args.size}}}\ngeometry: {{sphere: {{}}}}\n"
                         f"camera: {CAMERAS[camera]}\nreflectance: {{known: {MATERIALS[material]}}}\n"
                         f"illumination: {{known: {LIGHTS[light]}, width: 256, height: 128}}\n"
                         f"effects: {effects}\nquality: {quality}\n")
        # Of the previews: the reference sees pixels whose centres they do not.
        return run(args.bin / "ibrdf_render", "--scene", scene, "--out", folder / f"{name}.exr",
                   "--mask", mask if quality == "preview" else folder / "any.png")

    settings = {n: e for n, e in SETTINGS.items() if n != "by_normal" or camera == "orthographic"}
    least = {}
    for _ in range(args.rounds):
        for name, effects in settings.items():
            seconds, said = render(name, effects, "preview")
            least[name] = min(least.get(name, seconds), seconds)
            if name == "auto":
                row["words"] = next(x for x in said.splitlines() if x.startswith("effects: "))[9:]
    for name in settings:
        row[f"seconds_{name}"] = f"{least[name]:.2f}"
    if camera == "orthographic":
        render("reference", "auto", "reference")
        for name in settings:
            _, said = run(args.bin / "ibrdf_eval", "image", folder / f"{name}.exr", folder / "reference.exr", "--mask", mask)
            row[f"error_{name}"] = f"{json.loads(said)['image_mean_abs_log']:.4f}"
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--bin", type=pathlib.Path, default="build/release/bin")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--rounds", type=int, default=2)
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    columns = (["camera", "material", "light"] + [f"seconds_{s}" for s in SETTINGS] + [f"error_{s}" for s in SETTINGS] + ["words"])
    with open(args.out / "previews.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        for camera in CAMERAS:
            for light in LIGHTS:
                for material in MATERIALS:
                    writer.writerow(scene_row(args, camera, material, light))
                    file.flush()


if __name__ == "__main__":
    main()
