#!/usr/bin/env python3
"""The verdict's ratings beside the errors against the truth. See README.md."""
import argparse
import csv
import json
import pathlib
import statistics

RATINGS = ("good", "fair", "poor", "not determined")
# What is rated, and the metric that is its error.
RATED = {
    "gloss": "brdf_log_rmse_aligned",
    "light_directions": "illumination_relative_log_rmse_aligned",
}
COLUMNS = ("case", "warnings", "brdf_expected", *(f"{name}_{what}" for name in RATED for what in ("rating", "error")))


def rank_correlation(x, y):
    """Spearman's, without ties."""
    def ranks(values):
        order = sorted(range(len(values)), key=values.__getitem__)
        out = [0] * len(values)
        for rank, k in enumerate(order):
            out[k] = rank
        return out

    a, b = ranks(x), ranks(y)
    n = len(a)
    return 1 - 6 * sum((p - q) ** 2 for p, q in zip(a, b)) / (n * (n * n - 1))


def read(folder):
    result = json.loads((folder / "result.json").read_text())
    metrics, verdict = result.get("metrics", {}), result.get("verdict", {})
    if any(metrics.get(key) is None for key in RATED.values()):
        return None
    name = folder.parent.name if folder.name.startswith("photograph_") else folder.name
    row = {"case": name, "warnings": len(result["warnings"]),
           "brdf_expected": result["posterior"].get("brdf_log_rmse_expected")}
    for rated, metric in RATED.items():
        row[f"{rated}_rating"] = verdict["ratings"][rated]
        row[f"{rated}_error"] = metrics[metric]
    return row


def show(rows, rated):
    print(f"{rated}: errors by rating")
    for rating in RATINGS:
        errors = sorted(row[f"{rated}_error"] for row in rows if row[f"{rated}_rating"] == rating)
        if errors:
            print(f"  {rating:15} {len(errors):3}   median {statistics.median(errors):.3f}, "
                  f"{errors[0]:.3f} to {errors[-1]:.3f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=pathlib.Path, help="results of ibrdf_solve with a truth")
    parser.add_argument("--out", type=pathlib.Path, help="a CSV file of all cases")
    args = parser.parse_args()
    rows = [row for row in map(read, args.folders) if row is not None]
    if not rows:
        parser.error("no folder has metrics of both")
    if args.out:
        with args.out.open("w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    for rated in RATED:
        show(rows, rated)
    known = [row for row in rows if row["brdf_expected"] is not None]
    if len(known) > 2:
        expected = [row["brdf_expected"] for row in known]
        errors = [row["gloss_error"] for row in known]
        print(f"BRDF: expected error to true one, rank correlation {rank_correlation(expected, errors):.2f}; "
              f"true over expected {statistics.median(e / x for e, x in zip(errors, expected)):.2f} in the median, {len(known)} cases")


if __name__ == "__main__":
    main()
