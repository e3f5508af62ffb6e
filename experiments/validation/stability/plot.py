#!/usr/bin/env python3
"""The page of stability plots: one panel per axis, ours beside naive float.

usage: plot.py RESULTS.csv [--out FILE.png]
Lines are medians, bands reach to the worst finite error; a cross at the top is
a place where some result was not finite. Needs Debian's python3-matplotlib
(scripts/install_plots.sh).
"""
import argparse
import csv
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "plots"))
from results import open_pyplot

COLOURS = {"library": "tab:blue", "naive": "tab:red",
           "naive masked": "tab:orange"}
MARKERS = ("o", "s", "^")
# Sweep, title, label of x, label of y, the quantities in order of line style,
# limits of y, places of the ticks of x or none.
RELATIVE = "relative error"
LOG_RMS = "RMS difference of log BRDF"
PANELS = (
    ("range", "Dynamic range of the light",
     "radiance of one texel over the mean",
     "relative error; fit: " + LOG_RMS,
     ("radiance", "gradient by log map", "fitted reflectance"), (1e-8, 30),
     None),
    ("units", "Units of radiance", "unit of the image, W/(m$^2$ sr)", RELATIVE,
     ("radiance", "gradient by log map", "Gauss-Newton product"), (1e-8, 30),
     (1e-36, 1e-24, 1e-12, 1, 1e12, 1e24, 1e36)),
    ("noise", "Additive noise: fitted reflectance",
     "standard deviation over mean radiance", LOG_RMS,
     ("fitted reflectance",), (1e-4, 30), None),
    ("outliers", "Wrong pixels: fitted reflectance", "share of pixels",
     LOG_RMS, ("fitted reflectance",), (1e-4, 30), None),
    ("roughness", "Roughness", "RMS slope of the facets, falling", RELATIVE,
     ("BRDF", "radiance"), (1e-17, 1e4), None),
    ("code norm", "Norm of the code", "norm (training codes: at most 1)",
     "log density: nats; gradient: relative",
     ("log density", "gradient by code"), (1e-8, 30),
     (0, 1, 10, 100, 1000)),
)
STYLES = ("-", "--", ":")


def read(path):
    """{(sweep, quantity, implementation): [(x, median, worst, bad)]}"""
    series = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            key = (row["sweep"], row["quantity"], row["implementation"])
            series.setdefault(key, []).append(
                (float(row["x"]), float(row["median"]), float(row["worst"]),
                 int(row["not_finite"])))
    return series


def draw_panel(axes, series, panel):
    from matplotlib.lines import Line2D
    sweep, title, x_label, y_label, quantities, (low, high), ticks = panel
    axes.set_yscale("log")
    axes.set_ylim(low, high)
    if sweep == "code norm":  # has the norm 0
        axes.set_xscale("symlog", linthresh=0.25)
    else:
        axes.set_xscale("log")
    if sweep == "roughness":
        axes.invert_xaxis()
    crosses = 0
    for implementation, colour in COLOURS.items():
        for index, quantity in enumerate(quantities):
            points = series.get((sweep, quantity, implementation))
            if points is None:
                continue
            x = [p[0] for p in points]
            middle = [p[1] if math.isfinite(p[1]) else math.nan
                      for p in points]
            worst = [p[2] if math.isfinite(p[1]) else math.nan
                     for p in points]
            axes.plot(x, middle, STYLES[index], color=colour, lw=1.3,
                      marker=MARKERS[index], ms=3)
            axes.fill_between(x, middle, worst, color=colour, alpha=0.1, lw=0)
            bad = [p[0] for p in points if p[3] > 0]
            if bad:
                height = high / 2.2 ** (1 + crosses)
                axes.plot(bad, [height] * len(bad), "x", color=colour, ms=6,
                          mew=1.5, clip_on=False)
                if len(quantities) > 1:
                    at_end = bad[-1] == x[-1]
                    axes.annotate(
                        quantity, (bad[0] if at_end else bad[-1], height),
                        (-6 if at_end else 6, 0), textcoords="offset points",
                        fontsize=7, color=colour, va="center",
                        ha="right" if at_end else "left")
                crosses += 1
    axes.set_title(title)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    if ticks is not None:
        axes.set_xticks(ticks)
    if len(quantities) > 1:
        axes.legend(
            [Line2D([], [], color="0.3", ls=STYLES[i], marker=MARKERS[i], ms=3)
             for i in range(len(quantities))], quantities,
            loc="lower right" if low == 1e-8 else "upper left", fontsize=7)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("results", help="output of the program `stability`")
    parser.add_argument("--out", default="stability.png", help="picture")
    options = parser.parse_args()
    try:
        series = read(options.results)
    except (OSError, KeyError, ValueError) as error:
        parser.exit(2, f"error: {error}\n")
    pyplot = open_pyplot()
    from matplotlib.lines import Line2D
    figure, grid = pyplot.subplots(2, 3, figsize=(12.5, 7.6))
    for axes, panel in zip(grid.flat, PANELS):
        draw_panel(axes, series, panel)
    figure.legend(
        [Line2D([], [], color=c, lw=2) for c in COLOURS.values()] +
        [Line2D([], [], color="0.3", ls="", marker="x", ms=6, mew=1.5)],
        ["library", "naive float", "naive float, pixels <= 0 left out",
         "a result that is not finite"], loc="upper center", ncol=4,
        fontsize=9)
    figure.tight_layout(rect=(0, 0, 1, 0.955))
    figure.savefig(options.out)
    pyplot.close(figure)


if __name__ == "__main__":
    main()
