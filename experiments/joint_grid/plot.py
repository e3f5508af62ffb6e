#!/usr/bin/env python3
"""Errors of the sweep `ibrdf_bench joint` as sorted curves, and its worst cases.

usage: plot.py RESULTS.csv [--cases DIR] [--out DIR]
Writes DIR/errors.png: the share of cases below each error of the BRDF, beside
Cook-Torrance given the true map, with medians and 90th percentiles, and each
map's error against that of the constant map of the true mean, all aligned; and
DIR/worst.png:
the overview pictures of the ten cases of the largest BRDF error, from the
sweep's folder `cases` (by default beside RESULTS.csv). Needs Debian's
python3-matplotlib (scripts/install_plots.sh).
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "plots"))
from results import median, numbers, open_pyplot, percentile, read_rows

BRDF = "brdf_log_rmse_aligned"
MAP = "illumination_relative_log_rmse_aligned"
COOK_TORRANCE = "cook_torrance_brdf_log_rmse_aligned"
CONSTANT_MAP = "constant_map_relative_log_rmse_aligned"
# Label, column, colour.
CURVES = (("joint estimate", BRDF, "tab:red"),
          ("Cook-Torrance given the true map", COOK_TORRANCE, "0.45"))
CASE = ("material", "map", "geometry", "lobes", "method", "model", "prior")
NUM_WORST = 10
WORST_COLUMNS = 5


def overview(row, cases):
    """Where the sweep leaves a row's picture."""
    name = f"{row['material']}_{row['map']}"
    if row["geometry"] != "sphere":
        name += f"_{row['geometry']}"
    estimate = f"estimate_{row['prior']}_{row['lobes']}_{row['method']}"
    if row["model"] != "default":
        estimate += "_" + row["model"].replace("/", "-")
    return Path(cases) / name / estimate / "overview.png"


def better(rows, column, baseline):
    """How many rows have the smaller error, and of how many that have both."""
    both = [row for row in rows if row[column] and row[baseline]]
    return (sum(float(row[column]) < float(row[baseline]) for row in both),
            len(both))


def worst(rows, count):
    scored = [row for row in rows if row[BRDF]]
    return sorted(scored, key=lambda row: -float(row[BRDF]))[:count]


def draw_shares(axes, rows):
    largest = 0.0
    for label, column, colour in CURVES:
        values = sorted(numbers(rows, column))
        if not values:
            raise ValueError(f"expected numbers in the column {column}")
        shares = [(i + 1) / len(values) for i in range(len(values))]
        middle, high = median(values), percentile(values, 0.9)
        axes.step([0.0] + values, [0.0] + shares, where="post", color=colour,
                  label=f"{label}\nmedian {middle:.3g}, 90 %: {high:.3g}")
        axes.plot([middle, high], [0.5, 0.9], "o", ms=4, color=colour)
        largest = max(largest, values[-1])
    wins, of = better(rows, BRDF, COOK_TORRANCE)
    axes.set_title(f"BRDF log-RMSE, aligned: {wins} of {of} better")
    axes.set_xlim(0.0, 1.03 * largest)
    axes.set_ylim(0.0, 1.02)
    axes.set_xlabel("error")
    axes.set_ylabel("share of cases at most that")
    axes.legend(loc="lower right")


def draw_maps(axes, rows):
    both = [row for row in rows if row[MAP] and row[CONSTANT_MAP]]
    if not both:
        raise ValueError(f"expected numbers in the column {MAP}")
    for name in dict.fromkeys(row["map"] for row in both):
        chosen = [row for row in both if row["map"] == name]
        axes.plot(numbers(chosen, CONSTANT_MAP), numbers(chosen, MAP), "o",
                  ms=4, alpha=0.6, label=name)
    largest = 1.05 * max(numbers(both, MAP) + numbers(both, CONSTANT_MAP))
    axes.plot([0.0, largest], [0.0, largest], "--", color="0.6", lw=1,
              label="as good as constant")
    wins, of = better(rows, MAP, CONSTANT_MAP)
    axes.set_title(f"map, relative log-RMSE, aligned: {wins} of {of} better")
    axes.set_xlim(0.0, largest)
    axes.set_ylim(0.0, largest)
    axes.set_xlabel("error of the constant map of the true mean")
    axes.set_ylabel("error of the estimate, each case")
    axes.legend(loc="upper left")


def draw_errors(rows, out):
    pyplot = open_pyplot()
    figure, panels = pyplot.subplots(1, 2, figsize=(10, 4.2))
    draw_shares(panels[0], rows)
    draw_maps(panels[1], rows)
    figure.suptitle(f"{len(rows)} cases")
    figure.tight_layout()
    figure.savefig(out)
    pyplot.close(figure)


def halved(picture):
    """Means of 2x2 pixels of an array [rows, columns, channels]."""
    h, w = picture.shape[0] // 2 * 2, picture.shape[1] // 2 * 2
    p = picture[:h, :w, :3]
    return (p[::2, ::2] + p[1::2, ::2] + p[::2, 1::2] + p[1::2, 1::2]) / 4


def short(cell):
    return f"{float(cell):.3g}" if cell else "-"


def draw_worst(rows, cases, out):
    pyplot = open_pyplot()
    chosen = worst(rows, NUM_WORST)
    lines = -(-len(chosen) // WORST_COLUMNS)
    figure, grid = pyplot.subplots(
        lines, WORST_COLUMNS, squeeze=False,
        figsize=(4.4 * WORST_COLUMNS, 5.5 * lines))
    for axes in grid.flat:
        axes.axis("off")
    for rank, (axes, row) in enumerate(zip(grid.flat, chosen)):
        picture = overview(row, cases)
        if picture.is_file():
            axes.imshow(halved(pyplot.imread(picture)),
                        interpolation="antialiased")
        else:
            axes.text(0.5, 0.5, "no overview.png", ha="center",
                      transform=axes.transAxes)
        axes.set_title(
            f"{rank + 1}. {row['material']}, {row['map']}\n"
            f"BRDF {short(row[BRDF])}, map {short(row[MAP])}, "
            f"misfit {short(row['misfit'])}", fontsize=10)
    figure.tight_layout()
    figure.savefig(out)
    pyplot.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("results", help="results.csv of ibrdf_bench joint")
    parser.add_argument("--cases", help="the sweep's folder of cases")
    parser.add_argument("--out", default=".", help="folder of the pictures")
    options = parser.parse_args()
    cases = options.cases or Path(options.results).parent / "cases"
    try:
        rows = read_rows(options.results, CASE + ("misfit", BRDF, MAP, COOK_TORRANCE,
                                                CONSTANT_MAP))
        Path(options.out).mkdir(parents=True, exist_ok=True)
        draw_errors(rows, Path(options.out) / "errors.png")
        draw_worst(rows, cases, Path(options.out) / "worst.png")
    except (OSError, ValueError) as error:
        parser.exit(2, f"error: {error}\n")


if __name__ == "__main__":
    main()
