#!/usr/bin/env python3
"""What `effects: auto` chooses, on five meshes, three materials and three lights, against everything on.

    experiments/effects/run.py MESHES MAPS OUT [--bin build/release/bin] [--size 64] [--only torus]

MESHES: folder with torus.obj, spot_low_resolution.obj, bunny.obj, armadillo.obj; MAPS: with the maps of LIGHTS.
Each scene is rendered with everything on at reference quality, and as previews with everything, shadows alone, nothing
and what `auto` chooses. OUT/results.csv has a row a scene; scenes that have one are not rendered
again. Seconds are of whole programs.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys
import time

ORTHOGRAPHIC = "{type: orthographic}"
SCENES = {  # the torus is looked at from above, into its hole
    "sphere": ("{sphere: {}}", ORTHOGRAPHIC),
    "torus": ("torus.obj", "{type: perspective, fov_degrees: 32, from: [0, 1.6, 3.6]}"),
    "spot": ("spot_low_resolution.obj", ORTHOGRAPHIC),
    "bunny": ("bunny.obj", ORTHOGRAPHIC),
    "armadillo": ("armadillo.obj", ORTHOGRAPHIC),
}
MATERIALS = {
    "matte": "{lambertian: [0.7, 0.5, 0.3]}",
    "glossy": "{cook_torrance: {diffuse: [0.3, 0.2, 0.1], specular: 0.5, roughness: 0.2, f0: 0.1}}",
    "mirror": "{cook_torrance: {diffuse: [0, 0, 0], specular: 1, roughness: 0.05, f0: 0.9}}",
}
LIGHTS = {
    "soft": "kloofendal_overcast_1k.hdr",
    "medium": "forest.hdr",
    "hard": "{sky: {sun_theta_degrees: 50, sun_phi_degrees: 35}}",
}
SETTINGS = {  # name: effects, quality
    "reference": ("all", "reference"),
    "all": ("all", "preview"),
    "auto": ("auto", "preview"),
    "visibility": ("[visibility]", "preview"),
    "none": ("none", "preview"),
}
WORTH = 0.005  # what `auto` counts as worth simulating, mean |log radiance|
COLUMNS = (["mesh", "material", "light"] + [f"seconds_{s}" for s in SETTINGS] +
           [f"error_{s}" for s in SETTINGS if s != "reference"] +
           ["needed", "chosen", "words"])


def run(*command):
    start = time.monotonic()
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]}: exit {done.returncode}: {done.stderr}")
    return time.monotonic() - start, done.stdout


def render_all(args, mesh, material, light):
    """A row of the table."""
    shape, camera = SCENES[mesh]
    geometry = shape if shape.startswith("{") else f"{{mesh: {args.meshes / shape}, fit: unit_sphere}}"
    known = LIGHTS[light] if LIGHTS[light].startswith("{") else f"{args.maps / LIGHTS[light]}, frame: ibrdf_0_1"
    folder = args.out / f"{mesh}-{material}-{light}"
    folder.mkdir(parents=True, exist_ok=True)
    row = {"mesh": mesh, "material": material, "light": light}
    images = {}
    for setting, (effects, quality) in SETTINGS.items():
        scene = folder / f"{setting}.yaml"
        scene.write_text(f"image: {{width: {args.size}, height: {args.size}}}\ngeometry: {geometry}\n"
                         f"camera: {camera}\nreflectance: {{known: {MATERIALS[material]}}}\n"
                         f"illumination: {{known: {known}, width: 256, height: 128}}\n"
                         f"effects: {effects}\nquality: {quality}\n")
        images[setting] = folder / f"{setting}.exr"
        seconds, said = run(args.bin / "ibrdf_render", "--scene", scene, "--out", images[setting],
                            "--mask", folder / "mask.png", "--threads", args.threads)
        row[f"seconds_{setting}"] = f"{seconds:.2f}"
        if setting == "auto":
            row["words"] = next(line for line in said.splitlines() if line.startswith("effects: "))[9:]

    def error(a, b):
        _, said = run(args.bin / "ibrdf_eval", "image", images[a], images[b], "--mask", folder / "mask.png")
        return json.loads(said)["image_mean_abs_log"]

    for setting in SETTINGS:
        if setting != "reference":
            row[f"error_{setting}"] = f"{error(setting, 'reference'):.4f}"
    # At one quality: what each effect is worth by itself.
    if error("none", "all") <= WORTH:
        row["needed"] = "none"
    else:
        row["needed"] = "visibility" if error("visibility", "all") <= WORTH else "interreflection"
    chosen = row["words"].split(":")[0]
    row["chosen"] = "interreflection" if "interreflection" in chosen else chosen
    return row


def summary(rows):
    def number(row, name):
        return float(row[name])

    print(f"{len(rows)} scenes")
    worst = max(rows, key=lambda r: number(r, "error_auto"))
    print("auto from everything on at reference quality: mean %.4f, worst %.4f (%s)" % (
        sum(number(r, "error_auto") for r in rows) / len(rows), number(worst, "error_auto"),
        "-".join(worst[k] for k in ("mesh", "material", "light"))))
    print("within 0.02: %d" % sum(number(r, "error_auto") <= 0.02 for r in rows))
    ratios = sorted(number(r, "seconds_auto") / number(r, "seconds_reference") for r in rows)
    print("time of that at reference quality: mean %.3f, largest %.3f" % (sum(ratios) / len(ratios), ratios[-1]))
    same = sorted(number(r, "seconds_auto") / number(r, "seconds_all") for r in rows)
    print("time of everything on at the same quality: mean %.3f, largest %.3f" % (sum(same) / len(same), same[-1]))
    names = ["none", "visibility", "interreflection"]
    print("needed (rows) against chosen (columns):", *names)
    for needed in names:
        print(f"  {needed:16}", *(sum(r["needed"] == needed and r["chosen"] == c for r in rows) for c in names))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("maps", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    root = pathlib.Path(__file__).resolve().parents[2]
    parser.add_argument("--bin", type=pathlib.Path, default=root / "build/release/bin")
    parser.add_argument("--size", type=int, default=64)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--only", help="one mesh")
    args = parser.parse_args()
    for name in ("meshes", "maps", "out", "bin"):
        setattr(args, name, getattr(args, name).resolve())
    args.out.mkdir(parents=True, exist_ok=True)
    table = args.out / "results.csv"
    rows = list(csv.DictReader(table.open())) if table.exists() else []
    done = {(r["mesh"], r["material"], r["light"]) for r in rows}
    for mesh in SCENES if args.only is None else [args.only]:
        for material in MATERIALS:
            for light in LIGHTS:
                if (mesh, material, light) in done:
                    continue
                rows.append(render_all(args, mesh, material, light))
                print(mesh, material, light, *(rows[-1][c] for c in COLUMNS[3:-1]), flush=True)
                temporary = table.with_suffix(".part")
                with temporary.open("w", newline="") as file:
                    writer = csv.DictWriter(file, COLUMNS)
                    writer.writeheader()
                    writer.writerows(rows)
                temporary.replace(table)
    summary(rows)


if __name__ == "__main__":
    main()
