#!/usr/bin/env python3
"""RobIR's Figures 8 to 10, from the table that `response_curves` prints.

usage: plot.py TABLE.csv [--out curves.png]
Prints how far each ACES curve is from sRGB on [0, 1]; the picture needs
Debian's python3-matplotlib (scripts/install_plots.sh).
"""
import argparse
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "plots"))
from results import open_pyplot  # noqa: E402


def read(path):
    """{column: numbers}."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def report(table):
    for name in (n for n in table if n.startswith("aces_")):
        errors = [abs(a - s) for x, a, s in zip(table["x"], table[name], table["srgb"]) if x <= 1.0]
        print(f"{name:10} |ACES - sRGB| on [0, 1]: mean {sum(errors) / len(errors):.3f}, most {max(errors):.3f}")


def draw(table, out):
    pyplot = open_pyplot()
    figure, axes = pyplot.subplots(1, 3, figsize=(13, 4))
    x = table["x"]
    aces = [name for name in table if name.startswith("aces_")]
    clipped = [min(v, 1.0) for v in table["srgb"]]
    axes[0].plot(x, clipped, label="sRGB")
    axes[0].plot(x, [min(v, 1.0) for v in table["aces_1"]], label="ACES, gamma = 1")
    axes[0].set(title="Fig. 8: where codes end", xlim=(0, 8))
    for name in aces:
        axes[1].plot(x, table[name], label="gamma = " + name[5:])
    axes[1].axhline(1.0, color="grey", lw=0.8)
    axes[1].set(title="Fig. 9: ACES by gamma", xlim=(0, 8))
    axes[2].plot(x, clipped, label="sRGB")
    axes[2].plot(x, [min(v, 1.0) for v in table["aces_0.42"]], label="ACES, gamma = 0.42")
    axes[2].set(title="Fig. 10: ACES in sRGB's place", xlim=(0, 1))
    for ax in axes:
        ax.set(xlabel="radiance times exposure", ylabel="code value")
        ax.legend()
    figure.tight_layout()
    figure.savefig(out, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table", type=Path)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    table = read(args.table)
    report(table)
    if args.out:
        draw(table, args.out)


if __name__ == "__main__":
    main()
