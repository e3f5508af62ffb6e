#!/usr/bin/env python3
"""What accuracy costs in time, from the table of `ibrdf_bench pareto`.

usage: plot.py RESULTS.csv [--out pareto.png] [--front pareto.csv]
A point for each setting: medians over the cases that every setting has solved,
of the BRDF's error, the map's (both aligned) and the misfit against the time
the program took. A thin upright line goes from the lower to the upper quartile.
The line is the Pareto front: no setting is faster and
better. The star is what `method: auto` does by default. --front lists the
points. Needs Debian's python3-matplotlib (scripts/install_plots.sh).
"""
import argparse
import csv
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "plots"))
from results import (front, median, numbers, open_pyplot, percentile,
                     place_labels, read_rows)

CASE = ("material", "map", "geometry")
SETTING = ("setting", "estimator", "method", "budget_seconds", "size",
           "map_width", "lobes", "prior", "unet_channels", "quadrature")
# Tables of before they were varied lack these.
NEW_SETTING = ("search", "turns", "models")
PANELS = (("brdf_log_rmse_aligned", "BRDF log-RMSE, aligned"),
          ("illumination_relative_log_rmse_aligned",
           "map, relative log-RMSE, aligned"),
          ("misfit", "misfit, mean |log L_o - log I|"))
# By what a setting changes, the word before its dash.
FAMILIES = {"default": "tab:red", "method": "tab:purple",
            "maximum": "tab:brown", "adam": "black", "seconds": "tab:red",
            "size": "tab:blue", "map": "tab:cyan", "lobes": "tab:green",
            "prior": "tab:olive", "unet": "tab:pink",
            "quadrature": "tab:orange", "small": "tab:gray",
            "models": "tab:blue", "search": "tab:green", "turns": "tab:orange"}
# Families that differ in the time that a solve may take, and in nothing else.
BUDGETS = ("default", "seconds")
BAND = "_quartiles"  # after a column's name: the lower and the upper one


def family(name):
    return name.split("-")[0]


def settings(rows):
    """[(name, {column: median, column + BAND: quartiles})] over the cases that
    all settings share, in the table's order, and the number of those cases.

    Raises ValueError where no case is shared or one setting is there twice
    with different defaults.
    """
    groups = {}
    for row in rows:
        group = groups.setdefault(
            tuple(row[c] for c in SETTING) +
            tuple(row.get(c, "") for c in NEW_SETTING), {})
        group[tuple(row[c] for c in CASE)] = row
    names = [key[0] for key in groups]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise ValueError(f"the setting {twice[0]} has rows of different "
                         "defaults; expected one sweep")
    shared = set.intersection(*(set(group) for group in groups.values()))
    if not shared:
        raise ValueError("expected a case that every setting has solved")
    columns = ("seconds",) + tuple(column for column, _ in PANELS)
    points = []
    for key, group in groups.items():
        chosen = [row for case, row in group.items() if case in shared]
        values = {}
        for c in columns:
            v = numbers(chosen, c)
            known = len(v) == len(shared)
            values[c] = median(v) if known else None
            values[c + BAND] = (tuple(percentile(v, q) for q in (0.25, 0.75))
                                if known else None)
        points.append((key[0], values))
    return points, len(shared)


def draw(points, num_cases, out):
    pyplot = open_pyplot()
    figure, panels = pyplot.subplots(1, 3, figsize=(16, 7))
    to_label = []
    for axes, (column, title) in zip(panels, PANELS):
        shown = [(name, (v["seconds"], v[column])) for name, v in points
                 if v[column] is not None]
        if not shown:
            axes.set_title(title + ": not measured")
            continue
        names = [name for name, _ in shown]
        xy = [at for _, at in shown]
        best = [xy[i] for i in front(xy)]
        axes.step([x for x, _ in best], [y for _, y in best], where="post",
                  color="0.6", lw=1.2, zorder=1, label="Pareto front")
        budget = sorted(at for name, at in shown
                        if family(name) in BUDGETS)
        if len(budget) > 1:
            axes.plot(*zip(*budget), ":", color="tab:red", lw=1, zorder=1,
                      label="other time budgets")
        quartiles = dict((name, v[column + BAND]) for name, v in points)
        for name, at in shown:
            axes.plot([at[0]] * 2, quartiles[name], "-", lw=1, alpha=0.35,
                      color=FAMILIES.get(family(name), "0.3"), zorder=1)
            if name == "default":
                axes.plot(*at, "*", ms=15, color="tab:red", zorder=3,
                          label="auto, the default")
            else:
                axes.plot(*at, "o", ms=5, zorder=2,
                          color=FAMILIES.get(family(name), "0.3"))
        axes.set_xscale("log")
        ticks = [t for t in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000,
                             5000) if min(xy)[0] / 1.6 <= t <= max(xy)[0] * 1.6]
        axes.set_xticks(ticks, [str(t) for t in ticks])
        axes.minorticks_off()
        axes.set_xlim(min(xy)[0] / 1.5, max(xy)[0] * 1.9)
        span = [y for name, _ in shown for y in quartiles[name]]
        pad = 0.12 * ((max(span) - min(span)) or max(span) or 1.0)
        axes.set_ylim(max(min(span) - pad, 0.0), max(span) + 2 * pad)
        axes.set_xlabel("seconds, wall clock (median)")
        axes.set_title(title)
        legend = axes.legend(loc="upper right")
        to_label.append((axes, xy, names, [legend]))
    figure.suptitle(f"Medians over {num_cases} case"
                    f"{'s' if num_cases != 1 else ''} that every setting "
                    "solved")
    figure.tight_layout()
    for axes, xy, names, avoid in to_label:
        place_labels(axes, xy, names, avoid)
    figure.savefig(out)


def write_front(points, path):
    """A line per setting: its medians and on which fronts it lies."""
    columns = ("seconds",) + tuple(column for column, _ in PANELS)
    on = {column: set() for column, _ in PANELS}
    for column in on:
        known = [(name, (v["seconds"], v[column])) for name, v in points
                 if v[column] is not None]
        on[column] = {known[i][0] for i in front([at for _, at in known])}
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("setting",) + columns +
                        tuple(column + quartile for column in on
                              for quartile in ("_25", "_75")) +
                        tuple("front_" + column for column in on))
        for name, v in sorted(points, key=lambda p: p[1]["seconds"]):
            writer.writerow(
                [name] + ["" if v[c] is None else f"{v[c]:.6g}"
                          for c in columns] +
                ["" if q is None else f"{q:.6g}" for column in on
                 for q in v[column + BAND] or (None, None)] +
                [int(name in on[column]) for column in on])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("results", help="results.csv of ibrdf_bench pareto")
    parser.add_argument("--out", default="pareto.png", help="the picture")
    parser.add_argument("--front", help="CSV of the points, optional")
    options = parser.parse_args()
    try:
        rows = read_rows(options.results, CASE + SETTING + ("seconds",) +
                         tuple(column for column, _ in PANELS))
        points, num_cases = settings(rows)
        draw(points, num_cases, options.out)
        if options.front:
            write_front(points, options.front)
    except (OSError, ValueError) as error:
        parser.exit(2, f"error: {error}\n")


if __name__ == "__main__":
    main()
