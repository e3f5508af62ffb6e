#!/usr/bin/env python3
"""What the errors of a sweep's reflectances are made of.

usage: shape.py DATA SWEEP [SWEEP ...]
DATA: the folder of true MERL tables; SWEEP: the --out of `ibrdf_bench joint` or `known-light`, whose cases hold the
estimates. For each case the root mean square of d = log(estimate) - log(truth) less its mean, over bins of the truth
below 70 degrees of theta_d, in three parts whose squares add up: hue (one factor a channel), shape that the channels
have in common, shape of single channels; then the common shape's mean in bands of theta_h. The largest first; the last
line has the means of the squares. Needs Debian's python3-numpy.
"""
import argparse
from pathlib import Path

import numpy as np

SCALE = np.array([1.0, 1.15, 1.66]) / 1500.0  # of a table's channels (Matusik et al. 2003)
BINS = (90, 90, 180)
MOST_THETA_D = 70
FLOOR = 1e-3  # 1/sr, added to both
BANDS = (0, 1, 3, 6, 12, 25, 50, 90)  # degrees of theta_h


def table(path):
    """[3, 90, 90, 180], 1/sr; bins without a value are negative."""
    with open(path, "rb") as file:
        bins = np.fromfile(file, np.int32, 3)
        values = np.fromfile(file, np.float64)
    if tuple(bins) != BINS or values.size != 3 * np.prod(BINS):
        raise ValueError(f"{path}: expected a MERL table of 90x90x180 bins")
    return values.reshape(3, *BINS) * SCALE[:, None, None, None]


def parts(estimate, truth):
    """(hue, common, single), and the common shape by BANDS."""
    used = (truth > 0).all(0)
    used[:, MOST_THETA_D:] = False
    d = np.log(np.maximum(estimate[:, used], 0) + FLOOR) - np.log(truth[:, used] + FLOOR)
    d -= d.mean()
    hue = d.mean(1, keepdims=True)
    common = (d - hue).mean(0)
    single = d - hue - common
    theta_h = (np.arange(BINS[0]) / BINS[0])**2 * 90.0
    at = np.broadcast_to(theta_h[:, None, None], BINS)[used]
    band = np.digitize(at, BANDS[1:-1])
    profile = [common[band == k].mean() if (band == k).any() else np.nan for k in range(len(BANDS) - 1)]
    return [np.sqrt((x**2).mean()) for x in (hue, common, single)], profile


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("sweeps", nargs="+", type=Path)
    args = parser.parse_args()
    cases = []
    try:
        for sweep in args.sweeps:
            for path in sorted(sweep.glob("cases/*/*/brdf.binary")):
                name = path.parent.parent.name
                material = name.split("_", 1)[0]
                cases.append((name, *parts(table(path), table(args.data / f"{material}.binary"))))
    except (OSError, ValueError) as error:
        parser.exit(2, f"error: {error}\n")
    if not cases:
        parser.exit(2, "error: no sweep holds a case with brdf.binary\n")
    cases.sort(key=lambda c: -sum(x * x for x in c[1]))
    print(f"{'':36} total   hue common single |" + "".join(f"{a:>4}-{b:<2}" for a, b in zip(BANDS, BANDS[1:])))
    for name, rms, profile in cases:
        print(f"{name:36} {np.linalg.norm(rms):5.2f}" + "".join(f" {x:6.2f}" for x in rms)[1:] + " |" +
              "".join(f" {x:+6.2f}" for x in profile))
    squares = np.mean([np.square(c[1]) for c in cases], 0)
    print(f"{'mean of squares':36} {squares.sum():5.3f}" + "".join(f" {x:6.3f}" for x in squares)[1:])


if __name__ == "__main__":
    main()
