#!/usr/bin/env python3
"""Stated deviations of albedo against the errors that photographed painted objects have.

    experiments/painted/certainty.py PHOTOGRAPHS OUT

OUT: as photographs.py left it. By object and light, over the pixels inside the mask: Spearman's rank correlation of
albedo_log_std.exr and |error|; the shares of pixels whose error is below 1 and below 1.64 stated deviations, which
should be 0.68 and 0.90; the medians of both; the stated 90 % quantile. The error is that of log luminance, the mean of
the channels' logarithms, after one scale. Needs Debian's python3-numpy.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from files import read_exr, read_png  # noqa: E402
from solved_objects import print_table  # noqa: E402


def ranks(values):
    """Equal values share their mean rank."""
    _, which, counts = np.unique(values, return_inverse=True, return_counts=True)
    return (np.cumsum(counts) - (counts - 1) / 2)[which]


def compare(photograph, solved):
    """Correlation, both shares, median deviation, its 90 % quantile, median error."""
    measured = read_png(photograph / "reflectance.png")
    albedo, deviation = read_exr(solved / "albedo.exr"), read_exr(solved / "albedo_log_std.exr")[..., 0]
    seen = (read_png(photograph / "mask.png")[..., 0] > 0.5) & (measured > 0).all(-1) & (albedo > 0).all(-1)
    error = np.log(albedo[seen] / measured[seen]).mean(-1)
    error, deviation = np.abs(error - error.mean()), deviation[seen]
    return (np.corrcoef(ranks(deviation), ranks(error))[0, 1], (error < deviation).mean(), (error < 1.64 * deviation).mean(),
            np.median(deviation), np.quantile(deviation, 0.9), np.median(error))


def row(photograph, solved, name, light):
    if not (solved / "albedo_log_std.exr").exists():
        return None
    return f"{name},{light}," + ",".join(f"{number:.3f}" for number in compare(photograph, solved))


if __name__ == "__main__":
    print_table(__doc__, "object,light,correlation,below_1,below_1_64,median,quantile_90,median_error", "*_*_*", row)
