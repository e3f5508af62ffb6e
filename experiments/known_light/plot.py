#!/usr/bin/env python3
"""Reflectance under known light, from the table of `ibrdf_bench known-light`
(Chen et al. 2020, Fig. 3).

usage: plot.py RESULTS.csv [--out known_light.png] [--table FILE.md]
Draws every material's error, a mark for each map, by the material's median;
--table writes median and 90th percentile of each metric by map. Needs Debian's
python3-matplotlib (scripts/install_plots.sh); --table alone does not.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "plots"))
from results import (median, numbers, open_pyplot, percentile,
                     table_and_picture)

ERROR = "brdf_log_rmse_aligned"
METRICS = ((ERROR, "BRDF log-RMSE, aligned"),
           ("brdf_log_rmse", "as it is"),
           ("brdf_log_rmse_below80", "as it is, below 80 degrees"),
           ("misfit", "misfit"), ("seconds", "seconds"),
           ("peak_mb", "memory, MB"))
MARKS = "osD^v<>Xp*hd"


def by(rows, column):
    """{value: rows}, in the table's order."""
    groups = {}
    for row in rows:
        groups.setdefault(row[column], []).append(row)
    return groups


def materials_by_error(rows):
    """Names by their median error, least first; those without one are left
    out."""
    errors = {name: numbers(group, ERROR)
              for name, group in by(rows, "material").items()}
    return sorted((n for n in errors if errors[n]),
                  key=lambda n: median(errors[n]))


def table(rows):
    """Markdown: a line for each map and one for all, "median; 90th percentile".
    """
    lines = ["| | cases | " + " | ".join(t for _, t in METRICS) + " |",
             "|---" * (len(METRICS) + 2) + "|"]
    groups = list(by(rows, "map").items())
    for name, group in groups + [("all", rows)] * (len(groups) > 1):
        cells = []
        for column, _ in METRICS:
            values = numbers(group, column)
            cells.append(f"{median(values):.3g}; {percentile(values, 0.9):.3g}"
                         if values else "")
        lines.append(f"| {name} | {len(group)} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def draw(rows, out):
    names = materials_by_error(rows)
    if not names:
        raise ValueError(f"expected numbers in the column {ERROR}")
    at = {name: i for i, name in enumerate(names)}
    pyplot = open_pyplot()
    figure, axes = pyplot.subplots(figsize=(max(6.0, 0.16 * len(names)), 4.6))
    for mark, (name, group) in zip(MARKS * len(rows), by(rows, "map").items()):
        shown = [(at[r["material"]], float(r[ERROR])) for r in group if r[ERROR]]
        axes.plot(*zip(*shown), mark, ms=4, alpha=0.8,
                  label=f"{name}, median {median([y for _, y in shown]):.3f}")
    values = numbers(rows, ERROR)
    axes.plot(range(len(names)),
              [median(numbers([r for r in rows if r["material"] == n], ERROR))
               for n in names], color="0.3", lw=1, label="material's median")
    axes.axhline(median(values), color="0.6", ls="--", lw=1,
                 label=f"median of all, {median(values):.3f}")
    axes.set_xticks(range(len(names)), names, rotation=90, fontsize=6)
    axes.set_xlim(-0.7, len(names) - 0.3)
    axes.set_ylim(0.0, None)
    axes.set_ylabel("BRDF log-RMSE, aligned")
    axes.set_title(f"{len(values)} cases, light known")
    axes.legend()
    figure.tight_layout()
    figure.savefig(out)
    pyplot.close(figure)


if __name__ == "__main__":
    table_and_picture(__doc__, "known-light",
                      ("material", "map") + tuple(c for c, _ in METRICS),
                      table, draw)
