#!/usr/bin/env python3
"""Does the check find what is wrong with a normal map?

    experiments/photograph_check/normals.py BIN MESHES OUT [--only N]

Traces normals of four meshes at ten orientations each, writes each map in every wrong frame and encoding, and runs
`ibrdf_solve --check` on all. Prints how often the first of the ranking is what was done to the map, and writes
OUT/normals.csv. Needs numpy. A map in OpenCV's frame must be refused with a message that names the right key.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import pathlib
import subprocess

import numpy as np

from mesh_normals import read_obj, rotation, trace

MESHES = ("spot_low_resolution", "bunny", "torus", "armadillo")
ORIENTATIONS = [(36 * k + 7, (-35, 10, 50, -10, 25)[k % 5]) for k in range(10)]  # yaw and pitch, degrees
# What is done to right normals, and the verdict that says so.
WRONG = {
    "right": ("as given", lambda n: n, "float"),
    "x": ("x flipped", lambda n: n * [-1, 1, 1], "float"),
    "y": ("y flipped", lambda n: n * [1, -1, 1], "float"),
    "xy": ("x and y flipped", lambda n: n * [-1, -1, 1], "float"),
    "swapped": ("x, y swapped", lambda n: n[..., [1, 0, 2]], "float"),
    "opencv": ("refused", lambda n: n * [1, -1, -1], "float"),
    "encoded": ("0..1 encoded", lambda n: (n + 1) / 2, "float"),
    "encoded, auto": ("as given", lambda n: (n + 1) / 2, "auto"),
    "float": ("float, not 0..1", lambda n: n, "unit_0_1"),
}


def verdict(program, folder, normals, mask, encoding):
    """The first of the ranking, and by how much it leads."""
    out = folder / "out"
    command = [program, folder / "image.npy", "--normals", normals, "--mask", mask, "--check", "--quiet", "--threads",
               "1", "--out", out, "--set", f"geometry.encoding={encoding}"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode == 2 and "face away" in run.stderr:
        return "refused", 1.0
    if run.returncode != 0:
        raise SystemExit(run.stderr)
    ranking = json.loads((out / "check.json").read_text())["check"]["normals"]
    return ranking[0]["hypothesis"], ranking[1]["disagreement"] - ranking[0]["disagreement"]


def write_mask(path, mask):
    """An 8-bit grey PNG with the standard library."""
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes(row) for row in (mask * 255).astype(np.uint8))
    height, width = mask.shape
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def run_case(arguments, mesh, vertices, triangles, yaw, pitch):
    folder = pathlib.Path(arguments.out) / f"{mesh}_{yaw}_{pitch}"
    folder.mkdir(parents=True, exist_ok=True)
    normals = trace(vertices, triangles, rotation(yaw, pitch), 256)
    mask = np.abs(normals).max(-1) > 0
    write_mask(folder / "mask.png", mask)
    shade = 0.1 + np.maximum(normals @ (np.array([-1, 1, 1.2]) / np.sqrt(3.44)), 0)
    np.save(folder / "image.npy", np.repeat(shade[..., None], 3, 2).astype(np.float32))
    rows = []
    for wrong, (expected, change, encoding) in WRONG.items():
        changed = np.where(mask[..., None], change(normals), 0).astype(np.float32)
        np.save(folder / "normals.npy", changed)
        found, lead = verdict(arguments.bin, folder, folder / "normals.npy", folder / "mask.png", encoding)
        rows.append((mesh, yaw, pitch, wrong, expected, found, f"{lead:.4f}"))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("bin")
    parser.add_argument("meshes")
    parser.add_argument("out")
    parser.add_argument("--only", type=int, default=len(ORIENTATIONS), help="orientations of each mesh")
    arguments = parser.parse_args()
    rows = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = []
        for mesh in MESHES:
            vertices, triangles = read_obj(pathlib.Path(arguments.meshes) / f"{mesh}.obj")
            jobs += [pool.submit(run_case, arguments, mesh, vertices, triangles, yaw, pitch)
                     for yaw, pitch in ORIENTATIONS[:arguments.only]]
        for job in jobs:
            rows += job.result()
    with open(pathlib.Path(arguments.out) / "normals.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("mesh", "yaw", "pitch", "done", "expected", "first", "lead"))
        writer.writerows(rows)
    right = collections.Counter(row[3] for row in rows if row[4] == row[5])
    all_ = collections.Counter(row[3] for row in rows)
    for wrong in WRONG:
        leads = sorted(float(row[6]) for row in rows if row[3] == wrong)
        print(f"{wrong:14s} {right[wrong]:3d} of {all_[wrong]}  least lead {leads[0]:.3f}, median "
              f"{leads[len(leads) // 2]:.3f}")


if __name__ == "__main__":
    main()
