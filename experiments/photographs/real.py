#!/usr/bin/env python3
"""Solves real photographs by flags alone and lists what the verdict says of each. See README.md."""
import argparse
import csv
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import cases  # noqa: E402

# The files of each object, and what the photographer knows of them.
OBJECTS = {
    "bunny_hdr": ["image.exr", "--normals", "normal.npy"],
    **{name: ["original.png", "--normals", "normals.exr", "--response", "linear"]
       for name in ("apple", "pear", "cup1", "teabag2", "turtle", "squirrel")},
}
COLUMNS = ("object", "seconds", "status", "misfit", "floor", "materials", "variation", "light_directions", "hue", "gloss", "level",
           "trust", "doubt", "next")


def solve(program, folder, out, threads):
    photograph, *flags = OBJECTS[folder.name]
    flags = [str(folder / word) if "." in word else word for word in flags]
    began = time.monotonic()
    result = cases.solve([program, folder / photograph, *flags, "--mask", folder / "mask.png", "--out", out / folder.name,
                          "--quiet", "--threads", str(threads)], out / folder.name)
    seconds = time.monotonic() - began
    verdict, check = result["verdict"], result["check"]
    ratings = verdict["ratings"]
    return [folder.name, f"{seconds:.0f}", result["status"], f"{result['metrics']['misfit']:.3f}",
            f"{check['like_normals']['misfit_floor']:.3f}", check["materials"]["verdict"], result.get("variation", "none"),
            ratings["light_directions"], ratings["hue"], ratings["gloss"], ratings["level"],
            verdict["trust"], verdict["doubt"], verdict["next"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path, help="ibrdf_solve")
    parser.add_argument("photographs", type=pathlib.Path, help="a folder with a folder for each object")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--objects", default=",".join(OBJECTS))
    parser.add_argument("--threads", type=int, default=0)
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    table = args.out / "results.csv"
    rows = list(csv.reader(table.open())) if table.exists() else [COLUMNS]
    for name in args.objects.split(","):
        if any(row[0] == name for row in rows[1:]):
            continue
        rows.append(solve(args.program, args.photographs / name, args.out, args.threads))
        with table.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
        print(*rows[-1], sep="\n  ", flush=True)


if __name__ == "__main__":
    main()
