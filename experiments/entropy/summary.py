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


def numbers(rows, column):
    return [float(r[column]) for r in rows if r[column]]


def correlation(groups):
    print("| evaluator | correlation | partial | AUC | with error | error of roughness |\n|---|---|---|---|---|---|")
    for name, rows in groups.items():
        cells = []
        for column in ("pearson", "partial", "auc"):
            values = numbers(rows, column)
            cells.append(f"{statistics.mean(values):.3f}, {min(values):.3f}")
        cells.append(f"{statistics.mean(numbers(rows, 'with_error')):.2f}")
        errors = numbers(rows, "roughness_error")
        cells.append(f"{statistics.mean(errors):.3f}" if errors else "")
        print("| " + " | ".join([name, *cells]) + " |")


def views(groups):
    print("| search | views, median | quartiles | entropy less by | scenes with less entropy | with less error |\n"
          "|---|---|---|---|---|---|")
    for name, rows in groups.items():
        count = numbers(rows, "views_that_reach_20")
        less = {w: [a - b for a, b in zip(numbers(rows, f"{w}_farthest"), numbers(rows, f"{w}_best"))]
                for w in ("entropy", "error")}
        quartiles = statistics.quantiles(count)
        print(f"| {name} | {statistics.median(count):g} | {quartiles[0]:g} to {quartiles[2]:g} | "
              f"{statistics.mean(less['entropy']):.3f} | {sum(x > 0 for x in less['entropy'])} of {len(rows)} | "
              f"{sum(x > 0 for x in less['error'])} |")


def main(paths):
    for path in paths:
        with open(path, newline="") as file:
            is_views = "search" in file.readline()
        (views if is_views else correlation)(rows_by(path, "search" if is_views else "evaluator"))


if __name__ == "__main__":
    main(sys.argv[1:])
