#!/usr/bin/env python3
"""Retinex on photographed painted objects, to hold our albedo against.

    experiments/painted/retinex.py PHOTOGRAPHS OUT.csv

Colour Retinex (Grosse et al. 2009, Sec. 4): a step of log luminance from pixel to pixel is paint's where it, or that of
log chroma, is above a threshold, and else 0; the albedo is the least squares' solution of those steps, with the image's
chroma. Of the light `original`, and of the median of the steps under all lights (Weiss 2001). The two thresholds of an
object are those with the least mean error on the other objects. Log-RMSE after one scale per channel, as ibrdf_eval
albedo. Needs Debian's python3-numpy.
"""
import argparse
import csv
import itertools
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from files import read_png  # noqa: E402

OBJECTS = ("apple", "pear", "cup1", "teabag2", "turtle", "squirrel")
LIGHTS = ("original", "light01", "light04", "light07")
LUMINANCE = (0.0, 0.02, 0.05, 0.1, 0.2, 0.4, np.inf)
CHROMA = (0.02, 0.05, 0.1, 0.2, np.inf)


def steps(image):
    """From pixel to pixel to the right and down; 0 at the ends."""
    right, down = np.zeros_like(image), np.zeros_like(image)
    right[:, :-1] = np.diff(image, axis=1)
    down[:-1] = np.diff(image, axis=0)
    return right, down


def divergence(right, down):
    out = right + down
    out[:, 1:] -= right[:, :-1]
    out[1:] -= down[:-1]
    return out


def integrate(wanted, pairs, start):
    """The image whose steps between pairs of pixels are as wanted, by conjugate gradients."""
    def normal(x):
        return divergence(*(s * p for s, p in zip(steps(x), pairs)))

    x = start.copy()
    residual = divergence(*(s * p for s, p in zip(wanted, pairs))) - normal(x)
    direction, size = residual.copy(), (residual**2).sum()
    target = 1e-6 * size
    for _ in range(1500):
        if size <= target:
            break
        image = normal(direction)
        length = size / (direction * image).sum()
        x += length * direction
        residual -= length * image
        direction *= (residual**2).sum() / size
        direction += residual
        size = (residual**2).sum()
    return x


class Photographs:
    """Of one object: log luminance and chroma under each light, and the measured log albedo."""

    def __init__(self, folder, lights):
        images = [read_png(folder / f"{light}.png") for light in lights]
        truth = read_png(folder / "reflectance.png")
        seen = read_png(folder / "mask.png")[..., 0] > 0.5
        for image in images + [truth]:
            seen &= (image > 0).all(-1)
        self.seen = seen
        logs = [np.log(np.where(seen[..., None], image, 1.0)) for image in images]
        self.truth = np.log(np.where(seen[..., None], truth, 1.0))
        self.pairs = np.zeros(seen.shape), np.zeros(seen.shape)
        self.pairs[0][:, :-1] = seen[:, :-1] & seen[:, 1:]
        self.pairs[1][:-1] = seen[:-1] & seen[1:]
        self.first = logs[0].mean(-1)
        self.chroma = np.median([log - log.mean(-1, keepdims=True) for log in logs], axis=0)
        self.luminance_steps = [np.median(each, axis=0) for each in zip(*(steps(log.mean(-1)) for log in logs))]
        self.chroma_steps = [np.sqrt((s**2).sum(-1)) for s in steps(self.chroma)]

    def error(self, luminance_edge, chroma_edge):
        wanted = [np.where((np.abs(s) > luminance_edge) | (c > chroma_edge), s, 0.0)
                  for s, c in zip(self.luminance_steps, self.chroma_steps)]
        albedo = integrate(wanted, self.pairs, self.first * self.seen)[..., None] + self.chroma
        off = (albedo - self.truth)[self.seen]
        return np.sqrt(((off - off.mean(0))**2).mean())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("photographs", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    arguments = parser.parse_args()
    thresholds = list(itertools.product(LUMINANCE, CHROMA))
    rows = []
    for lights in (LIGHTS[:1], LIGHTS):
        errors = {}
        for name in OBJECTS:
            photographs = Photographs(arguments.photographs / name, lights)
            errors[name] = np.array([photographs.error(*t) for t in thresholds])
        for name in OBJECTS:
            best = np.argmin(sum(errors[other] for other in OBJECTS if other != name))
            rows.append([name, len(lights), *thresholds[best], f"{errors[name][best]:.3f}", f"{errors[name].min():.3f}"])
            print(*rows[-1], flush=True)
    with arguments.out.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["object", "lights", "luminance_edge", "chroma_edge", "log_rmse", "with_its_own_best_edges"])
        out.writerows(rows)


if __name__ == "__main__":
    main()
