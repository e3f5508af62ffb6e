#!/usr/bin/env python3
"""Errors of a sweep `photographs` over those of the HDR images.

    summary.py RESULTS.csv

Prints, for each setting, the median over the cases of its error over that of `hdr`, for the aligned BRDF error and the
aligned map error, and the share of cases in which it is nearer to the truth than the settings it is compared with.
"""
import csv
import statistics
import sys

BRDF = "brdf_log_rmse_aligned"
MAP = "illumination_relative_log_rmse_aligned"
# A setting and those that make something else of the same values.
RIVALS = {"_as_data": "", "_as_missing": "", "_as_srgb": "_unknown"}


def read(path):
    """Errors by setting and case."""
    table = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["status"] != "ok":
                continue
            case = row["material"], row["map"]
            table.setdefault(row["setting"], {})[case] = (float(row[BRDF]), float(row[MAP]), float(row["seconds"]))
    return table


def median_ratio(setting, base, column):
    cases = setting.keys() & base.keys()
    return statistics.median(setting[c][column] / base[c][column] for c in cases) if cases else float("nan")


def rival_of(name, table):
    for ending, other in RIVALS.items():
        if name.endswith(ending):
            rival = name[: -len(ending)] + other
            return rival if rival in table else None
    return None


def main():
    table = read(sys.argv[1])
    base = table["hdr"]
    print("| setting | cases | BRDF error over HDR's | map error over HDR's | seconds over HDR's | beaten by intervals |")
    print("|---|---|---|---|---|---|")
    for name, setting in table.items():
        cases = setting.keys() & base.keys()
        rival = rival_of(name, table)
        beaten = ""
        if rival:
            both = setting.keys() & table[rival].keys()
            brdf = sum(table[rival][c][0] < setting[c][0] for c in both)
            light = sum(table[rival][c][1] < setting[c][1] for c in both)
            beaten = f"BRDF {brdf}, map {light} of {len(both)} ({rival})"
        ratios = " | ".join(f"{median_ratio(setting, base, k):.2f}" for k in range(3))
        print(f"| `{name}` | {len(cases)} | {ratios} | {beaten} |")


if __name__ == "__main__":
    main()
