#!/usr/bin/env python3
"""A picture of albedo from one photograph, from four, and as measured. See README.md.

    experiments/painted/several_lights.py PHOTOGRAPHS OUT PICTURE.png [--objects apple,turtle,squirrel]

OUT: as photographs.py left it, with solves of `original` and of original+light01+light04+light07. Each albedo is brought
to the measured one by the best scale per channel. Needs Debian's python3-matplotlib (scripts/install_plots.sh).
"""
import argparse
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "common"), str(ROOT / "plots")]
from files import read_exr, read_png  # noqa: E402
from results import open_pyplot  # noqa: E402

FOUR = "original+light01+light04+light07"


def srgb(radiance):
    x = np.clip(radiance, 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x**(1 / 2.4) - 0.055)


def aligned(albedo, measured, seen):
    """Brought to the measured one, and the error that is left."""
    off = np.log(albedo[seen] / measured[seen])
    mean = off.mean(0)
    return albedo * np.exp(-mean), np.sqrt(((off - mean)**2).mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("photographs", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--objects", default="apple,turtle,squirrel")
    arguments = parser.parse_args()
    objects = arguments.objects.split(",")
    pyplot = open_pyplot()
    figure, axes = pyplot.subplots(len(objects), 4, figsize=(11, 2.7 * len(objects)), squeeze=False)
    for row, name in zip(axes, objects):
        folder = arguments.photographs / name
        image, measured = (read_png(folder / f"{file}.png") for file in ("original", "reflectance"))
        solved = [read_exr(arguments.out / f"{name}_{lights}_auto" / "albedo.exr") for lights in ("original", FOUR)]
        seen = (read_png(folder / "mask.png")[..., 0] > 0.5) & (measured > 0).all(-1)
        for albedo in solved:
            seen &= (albedo > 0).all(-1)
        one, four = (aligned(albedo, measured, seen) for albedo in solved)
        white = np.percentile(measured[seen], 99)
        shown = [("photograph", image / np.percentile(image[seen], 99)),
                 (f"albedo from one: {one[1]:.2f}", one[0] / white),
                 (f"albedo from four: {four[1]:.2f}", four[0] / white), ("measured", measured / white)]
        ys, xs = np.nonzero(seen)
        box = np.s_[ys.min():ys.max() + 1, xs.min():xs.max() + 1]
        for ax, (title, pixels) in zip(row, shown):
            ax.imshow(np.where(seen[..., None], srgb(pixels), 1.0)[box])
            ax.set_title(title, fontsize=10)
            ax.axis("off")
    figure.tight_layout()
    figure.savefig(arguments.picture, dpi=80)


if __name__ == "__main__":
    main()
