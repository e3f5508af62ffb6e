#!/usr/bin/env python3
"""Medians of the table that scenes.py writes, for all cases and by kind, and the worst.

    experiments/painted/medians.py RESULTS.csv [SETTING]

SETTING: `auto`, `albedo` (without it) or `none`.
"""
import csv
import statistics
import sys

KINDS = ["texture", "coat", "shape", "map"]


def median(values):
    values = [float(v) for v in values if v != ""]
    return statistics.median(values) if values else float("nan")


def ratios(cases, column, setting):
    """Of a setting's errors to those of the same object unpainted."""
    return [float(c[setting][column]) / float(c["unpainted"][column]) for c in cases if {setting, "unpainted"} <= c.keys()]


def line(name, cases, setting):
    painted = [c[setting] for c in cases if setting in c]
    words = [f"{name:14s} {len(painted):3d}"]
    words += [f"{median(row[column] for row in painted):7.3f}" for column in ("albedo", "constant", "brdf", "gloss", "map_error")]
    words += [f"{median(ratios(cases, column, setting)):7.2f}" for column in ("brdf", "gloss", "map_error")]
    words.append(f"{median(row['cpu_seconds'] for row in painted):5.0f}")
    print(" ".join(words))


def main():
    with open(sys.argv[1]) as file:
        rows = list(csv.DictReader(file))
    setting = sys.argv[2] if len(sys.argv) > 2 else "albedo"
    cases = {}
    for row in rows:
        cases.setdefault(row["case"], {})[row["setting"]] = row
    print(f"{'':14s}   n  albedo  const.    brdf   gloss     map | over unpainted: brdf, gloss, map |  s")
    line("all", list(cases.values()), setting)
    for kind in KINDS:
        for value in sorted({row[kind] for row in rows}):
            line(value, [c for c in cases.values() if next(iter(c.values()))[kind] == value], setting)
    took = [row["variation"] for row in rows if row["setting"] == setting]
    print(f"{setting} took:", {word: took.count(word) for word in sorted(set(took))})
    worst = sorted((row for row in rows if row["albedo"] != ""), key=lambda row: -float(row["albedo"]))
    for row in worst[:10]:
        print(f"{row['case']} albedo {row['albedo']} misfit {row['misfit']}")


if __name__ == "__main__":
    main()
