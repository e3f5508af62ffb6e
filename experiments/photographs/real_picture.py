#!/usr/bin/env python3
"""One picture of the lights and reflectances that real.py found. See README.md.

usage: real_picture.py OUT_OF_REAL PICTURE.png
Needs Debian's python3-matplotlib (scripts/install_plots.sh).
"""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "plots"))
from results import open_pyplot  # noqa: E402


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    with (folder / "results.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    pyplot = open_pyplot()
    columns = 2
    lines = -(-len(rows) // columns)
    figure, axes = pyplot.subplots(lines, 2 * columns, figsize=(13, 2.1 * lines), squeeze=False)
    for ax in axes.flat:
        ax.axis("off")
    for k, row in enumerate(rows):
        at = axes[k // columns][2 * (k % columns):]
        for ax, name in zip(at, ("illumination.png", "brdf.png")):
            ax.imshow(pyplot.imread(folder / row["object"] / name))
        at[0].set_title(f"{row['object']}: misfit {row['misfit']}, light {row['light_directions']}, gloss {row['gloss']}",
                        fontsize=9, loc="left")
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=100)


if __name__ == "__main__":
    main()
