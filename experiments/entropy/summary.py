#!/usr/bin/env python3
"""Prints the tables of README.md from the study's rows.

    experiments/entropy/summary.py experiments/entropy/results.csv
    experiments/entropy/summary.py experiments/entropy/views.csv
"""
import csv
import statistics
import sys


def rows_by(path, key):
    out = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            out.setdefault(row[key], []).append(row)
    return out


def correlation(groups):
    print("evaluator | correlation, mean | least | partial, mean | least | AUC, mean | least | roughness error")
    for name, rows in groups.items():
        column = {c: [float(r[c]) for r in rows] for c in ("pearson", "partial", "auc", "roughness_error")}
        cells = [f"{f(column[c]):.3f}" for c in ("pearson", "partial", "auc") for f in (statistics.mean, min)]
        print(" | ".join([name, *cells, f"{statistics.mean(column['roughness_error']):.3f}"]))


def views(groups):
    print("search | views, median | quartiles | entropy less by | error less by | scenes with less entropy, error")
    for name, rows in groups.items():
        count = [int(r["views_that_reach_20"]) for r in rows]
        less = {w: [float(r[f"{w}_farthest"]) - float(r[f"{w}_best"]) for r in rows] for w in ("entropy", "error")}
        quartiles = statistics.quantiles(count)
        print(f"{name} | {statistics.median(count):g} | {quartiles[0]:g} to {quartiles[2]:g} | "
              f"{statistics.mean(less['entropy']):.4f} | {statistics.mean(less['error']):.4f} | "
              f"{sum(x > 0 for x in less['entropy'])}, {sum(x > 0 for x in less['error'])} of {len(rows)}")


def main(paths):
    for path in paths:
        with open(path, newline="") as file:
            is_views = "search" in file.readline()
        (views if is_views else correlation)(rows_by(path, "search" if is_views else "evaluator"))


if __name__ == "__main__":
    main(sys.argv[1:])
