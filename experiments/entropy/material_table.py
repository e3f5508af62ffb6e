#!/usr/bin/env python3
"""Writes src/ibrdf/uncertainty/measured_materials.cc's table from the rows of `ibrdf_bench material-parameters`.

    experiments/entropy/material_table.py experiments/entropy/materials.csv
"""
import csv
import sys


def main(path):
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            numbers = [f"{float(row[c]):.4g}" for c in ("roughness", "ks_red", "ks_green", "ks_blue")]
            print(f"      {{{numbers[0]}, {{{', '.join(numbers[1:])}}}}},  // {row['material']}")


if __name__ == "__main__":
    main(sys.argv[1])
