#!/usr/bin/env python3
"""Gloss of photographed painted objects against what was measured.

    experiments/painted/gloss.py PHOTOGRAPHS OUT

OUT: as photographs.py left it, with solves of the light `original`, which alone has a measured specular.png. By object:
Pearson's correlation of the two images of gloss, means of the channels inside the mask; the energy of the estimate over
the true one; and the true gloss's share of the light. Needs Debian's python3-numpy.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from files import read_exr, read_png  # noqa: E402
from solved_objects import print_table  # noqa: E402


def compare(photograph, solved):
    """Correlation, energy over the true energy, true share."""
    seen = read_png(photograph / "mask.png")[..., 0] > 0.5
    estimate = read_exr(solved / "gloss.exr").mean(-1)
    seen &= np.isfinite(estimate) & (estimate > 0)
    estimate = estimate[seen]
    truth, light = (read_png(photograph / f"{name}.png").mean(-1)[seen] for name in ("specular", "original"))
    return np.corrcoef(estimate, truth)[0, 1], estimate.sum() / truth.sum(), truth.sum() / light.sum()


def row(photograph, solved, name, _):
    correlation, energy, share = compare(photograph, solved)
    return f"{name},{correlation:.3f},{energy:.2f},{share:.3f}"


if __name__ == "__main__":
    print_table(__doc__, "object,correlation,energy_over_true,true_share", "*_original_*", row)
