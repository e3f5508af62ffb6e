#!/usr/bin/env python3
"""What the check says of the materials of photographs and of renders of one material.

    experiments/photograph_check/materials.py BIN OUT [--photographs FOLDER] [--grid FOLDER] [--scenes FOLDER]

Prints a line per photograph, and of the two others how many are said to be of several materials. --photographs: the
folders bunny_hdr, apple, ...; --grid: the inputs of `ibrdf_bench render-inputs`; --scenes: folders with scene.yaml (a
mesh and its camera), image.exr and mask.png, as scenes.py writes them. Writes OUT/materials.csv.
"""
import argparse
import csv
import json
import pathlib
import subprocess

PAINTED = ("apple", "pear", "cup1", "teabag2", "turtle", "squirrel")


def check(program, out, arguments):
    """The check of one problem, and its seconds as a user sees them."""
    run = subprocess.run([program, *map(str, arguments), "--check", "--quiet", "--out", str(out)], capture_output=True,
                         text=True, check=False)
    if run.returncode != 0:
        raise SystemExit(f"{arguments}: {run.stderr}")
    return json.loads((out / "check.json").read_text())["check"]


def photographs(folder):
    yield "bunny_hdr", [folder / "bunny_hdr/image.exr", "--normals", folder / "bunny_hdr/normal.npy", "--mask",
                        folder / "bunny_hdr/mask.png"]
    for name in PAINTED:
        yield name, [folder / name / "original.png", "--response", "linear", "--normals", folder / name / "normals.exr",
                     "--mask", folder / name / "mask.png"]


def grid(folder):
    for image in sorted(folder.glob("**/input.exr")):
        yield image.parent.name, [image, "--mask", image.parent / "mask.png"]


def scenes(folder):
    for problem in sorted(folder.glob("*/problem.yaml")):
        if not (problem.parent / "image.exr").exists():
            continue  # not rendered yet
        yield problem.parent.name, ["--problem", problem]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("bin")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--photographs", type=pathlib.Path)
    parser.add_argument("--grid", type=pathlib.Path)
    parser.add_argument("--scenes", type=pathlib.Path)
    arguments = parser.parse_args()
    rows = []
    for kind, cases in (("photographs", photographs), ("grid", grid), ("scenes", scenes)):
        folder = getattr(arguments, kind)
        if folder is None:
            continue
        for name, options in cases(folder):
            look = check(arguments.bin, arguments.out / kind / name, options)
            materials, like = look["materials"], look["like_normals"]
            rows.append((kind, name, materials["verdict"], materials["colour_spread"], materials["far"]["across"],
                         materials["near"]["across"], materials["share_of_pixels"], like["log_radiance"], like["log_colour"],
                         like["misfit_floor"]))
    with open(arguments.out / "materials.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("kind", "name", "verdict", "colour_spread", "far", "near", "share", "log_radiance",
                         "log_colour", "misfit_floor"))
        writer.writerows(rows)
    for row in rows:
        if row[0] == "photographs":
            print(row[1], row[2], *(f"{value:.3f}" for value in row[3:] if value is not None))
    for kind in ("grid", "scenes"):
        of_kind = [row for row in rows if row[0] == kind]
        several = sum(row[2] == "several materials" for row in of_kind)
        spreads = [row[3] for row in of_kind if row[3] is not None]
        if of_kind:
            print(f"{kind}: several materials in {several} of {len(of_kind)}; not told in "
                  f"{len(of_kind) - len(spreads)}; largest colour spread {max(spreads, default=0):.3f}")


if __name__ == "__main__":
    main()
