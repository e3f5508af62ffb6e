#!/usr/bin/env python3
"""What an estimate is worth after so many seconds, by kind of material.

usage: budget.py RESULTS.csv --data build/merl [--out budget.png]
RESULTS.csv is the table of `ibrdf_bench pareto` with the settings seconds-5,
seconds-10, ... and default. A line is the median over the cases of a kind, the
band goes from the lower to the upper quartile; errors are after the best scale
per channel. Prints the medians as a table. A kind is told by the BRDF's table
(MERL, luminance, theta_d = 2 degrees): the highlight over the value at
theta_h = 40 degrees is below 10 for matte, above 4000 for mirror-like
materials, and between for glossy ones. Needs Debian's python3-matplotlib
(scripts/install_plots.sh).
"""
import argparse
import array
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "plots"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
from plot import BUDGETS, PANELS, family
from results import median, numbers, open_pyplot, percentile, read_rows

KINDS = (("matte", 10.0), ("glossy", 4000.0), ("mirror-like", float("inf")))
ERRORS = PANELS[:2]  # of BRDF and map
THETA_H, THETA_D, PHI_D = 90, 90, 180  # bins of a table
HEADER = 12  # bytes
# Of luminance, times the scale of the file's channels.
WEIGHTS = (0.2126 / 1500, 0.7152 * 1.15 / 1500, 0.0722 * 1.66 / 1500)


def luminance(file, theta_h, theta_d=2):
    """Mean over phi_d at the bins theta_h, theta_d."""
    total = 0.0
    for channel, weight in enumerate(WEIGHTS):
        values = array.array("d")
        row = (channel * THETA_H + theta_h) * THETA_D + theta_d
        file.seek(HEADER + 8 * PHI_D * row)
        values.fromfile(file, PHI_D)
        total += weight * sum(values) / PHI_D
    return total


def kind(path):
    """The first of KINDS that a table's highlight is low enough for."""
    with open(path, "rb") as file:
        peak = sum(luminance(file, h) for h in range(3)) / 3
        at_40 = luminance(file, 60)  # 90 (60 / 90)^2 degrees
    return next(name for name, most in KINDS if peak / at_40 < most)


def by_kind(rows, data):
    """{kind: {budget in seconds: rows}}, budgets as numbers."""
    budgets = [row for row in rows if family(row["setting"]) in BUDGETS]
    kinds = {m: kind(Path(data) / f"{m}.binary")
             for m in {row["material"] for row in budgets}}
    out = {name: {} for name, _ in KINDS}
    for row in budgets:
        group = out[kinds[row["material"]]]
        group.setdefault(float(row["budget_seconds"]), []).append(row)
    return {name: group for name, group in out.items() if group}


def print_medians(groups):
    print("| kind | cases | budget, s | seconds | BRDF | map | misfit |")
    print("|---|---|---|---|---|---|---|")
    for name, group in groups.items():
        for budget, rows in sorted(group.items()):
            cells = [f"{median(numbers(rows, column)):.{digits}f}"
                     for column, digits in (("seconds", 1), (ERRORS[0][0], 2),
                                            (ERRORS[1][0], 3), ("misfit", 3))]
            print(f"| {name} | {len(rows)} | {budget:g} | " +
                  " | ".join(cells) + " |")


def draw(groups, out):
    pyplot = open_pyplot()
    figure, panels = pyplot.subplots(1, 2, figsize=(12, 5))
    for axes, (column, title) in zip(panels, ERRORS):
        for (name, group), colour in zip(groups.items(),
                                         ("tab:blue", "tab:green", "tab:red")):
            rows = [group[budget] for budget in sorted(group)]
            x = [median(numbers(r, "seconds")) for r in rows]
            low, middle, high = ([percentile(numbers(r, column), share)
                                  for r in rows] for share in (0.25, 0.5, 0.75))
            axes.fill_between(x, low, high, color=colour, alpha=0.15, lw=0)
            axes.plot(x, middle, "o-", color=colour,
                      label=f"{name}, {len(rows[-1])} cases")
        axes.set_xscale("log")
        axes.set_xticks([5, 10, 20, 40], ["5", "10", "20", "40"])
        axes.minorticks_off()
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel("seconds, wall clock (median)")
        axes.set_title(title)
    panels[0].legend()
    figure.suptitle("Medians and quartiles by the time that a solve may take")
    figure.tight_layout()
    figure.savefig(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("results", help="results.csv of ibrdf_bench pareto")
    parser.add_argument("--data", required=True, help="folder of MERL tables")
    parser.add_argument("--out", default="budget.png", help="the picture")
    options = parser.parse_args()
    try:
        rows = read_rows(options.results, ("material", "setting", "seconds",
                                           "budget_seconds", "misfit") +
                         tuple(column for column, _ in ERRORS))
        groups = by_kind(rows, options.data)
        if not groups:
            raise ValueError(f"{options.results}: expected the setting default")
        print_medians(groups)
        draw(groups, options.out)
    except (OSError, EOFError, ValueError) as error:
        parser.exit(2, f"error: {error}\n")


if __name__ == "__main__":
    main()
