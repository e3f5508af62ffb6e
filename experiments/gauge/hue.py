#!/usr/bin/env python3
"""The hue of estimated BRDFs by the prior's gauge and by grey_light's. See README.md."""
import argparse
import csv
import json
import pathlib
import statistics
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from files import read_exr, read_merl  # noqa: E402

COLUMNS = ("case", "prior", "grey_light", "grey_object")


def mean_radiance(light):
    """Over the sphere, by channel. light: [H, W, 3], equirectangular."""
    theta = np.pi * (np.arange(light.shape[0]) + 0.5) / light.shape[0]
    return np.average(light.mean(axis=1), axis=0, weights=np.sin(theta))


def deviation(log_scale):
    """Of three channels' logarithms, their mean taken off: what is left is hue."""
    return float(np.std(log_scale))


def mean_log_ratio(estimate, truth):
    """By channel, over the bins where both are known."""
    known = (truth > 0).all(axis=0) & (estimate > 0).all(axis=0)
    return np.log(estimate[:, known] / truth[:, known]).mean(axis=1)


def hues(folder, data):
    result = json.loads((folder / "result.json").read_text())
    if result["problem"]["solver"]["gauge"] != "prior":
        raise SystemExit(f"{folder}: not solved with solver.gauge: prior")
    truth = result["problem"].get("truth", {}).get("brdf")
    if truth is None:
        return None
    estimate = read_merl(folder / "brdf.binary")
    truth = read_merl((data or pathlib.Path(truth).parent) / pathlib.Path(truth).name)
    prior = mean_log_ratio(estimate, truth)
    # The light times k is grey, so the BRDF is divided by k.
    log_k = -np.log(mean_radiance(read_exr(folder / "illumination.exr")))
    # The BRDF that is grey on average: what no gauge may be worse than.
    known = (truth > 0).all(axis=0)
    return deviation(prior), deviation(prior - log_k), deviation(np.log(truth[:, known]).mean(axis=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=pathlib.Path, help="results of ibrdf_solve with gauge: prior and a true BRDF")
    parser.add_argument("--data", type=pathlib.Path, help="where the true BRDFs are now")
    parser.add_argument("--out", type=pathlib.Path, help="a CSV file of all cases")
    args = parser.parse_args()
    rows = []
    for folder in args.folders:
        found = hues(folder, args.data)
        if found is not None:
            name = folder.parent.name if folder.name.startswith("photograph_") else folder.name
            rows.append((name, *found))
    if not rows:
        parser.error("no folder has a true BRDF")
    if args.out:
        with args.out.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(COLUMNS)
            writer.writerows((row[0], *(f"{x:.4f}" for x in row[1:])) for row in rows)
    for k, gauge in enumerate(COLUMNS[1:], start=1):
        values = sorted(row[k] for row in rows)
        print(f"{gauge:12} median {statistics.median(values):.3f}, 90 % {values[int(0.9 * (len(values) - 1))]:.3f}, "
              f"worst {values[-1]:.3f}, {len(values)} cases")
    nearer = sum(row[1] < row[2] for row in rows)
    print(f"the prior is nearer than grey_light in {nearer} of {len(rows)}")


if __name__ == "__main__":
    main()
