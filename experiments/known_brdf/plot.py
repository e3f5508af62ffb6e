#!/usr/bin/env python3
"""Light of a known reflectance with the deep illumination prior and without,
from the table of `ibrdf_bench known-brdf` (Chen et al. 2020, Fig. 4 and
supplement, Table 2).

usage: plot.py RESULTS.csv [--out known_brdf.png] [--table FILE.md]
Draws, for each map, the error of every material with each prior; --table
writes the means by map and says on how many maps the prior lowers them. Cases
that not every prior has solved are left out. Needs Debian's python3-matplotlib
(scripts/install_plots.sh); --table alone does not.
"""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "plots"))
from results import numbers, open_pyplot, table_and_picture

ERROR = "illumination_relative_log_rmse_aligned"
CONSTANT = "constant_map_relative_log_rmse_aligned"
METRICS = (("illumination_relative_log_rmse", "as it is"),
           (ERROR, "aligned"),
           ("mirror_log_rmse", "mirror sphere, log-RMSE"),
           ("diffuse_log_rmse", "diffuse sphere, log-RMSE"),
           ("glossy_log_rmse", "glossy sphere, log-RMSE"),
           ("misfit", "misfit"), ("seconds", "seconds"))
COLOURS = {"unet": "tab:red", "process": "tab:olive", "none": "0.45"}


def shared(rows):
    """{map: {prior: rows}} of the cases that every prior has solved, priors in
    the table's order."""
    priors = list(dict.fromkeys(row["prior"] for row in rows))
    cases = {}
    for row in rows:
        if row[ERROR]:
            case = (row["map"], row["material"], row["geometry"])
            cases.setdefault(case, {})[row["prior"]] = row
    groups = {}
    for (name, _, _), of in cases.items():
        if len(of) == len(priors):
            for prior in priors:
                groups.setdefault(name, {}).setdefault(prior, []).append(
                    of[prior])
    if not groups:
        raise ValueError("expected a case that every prior has solved")
    return groups


def mean(rows, column):
    values = numbers(rows, column)
    return sum(values) / len(values) if values else None


def wins(groups, prior, other, column):
    """On how many maps the mean error with `prior` is the smaller."""
    return sum(mean(of[prior], column) < mean(of[other], column)
               for of in groups.values())


def table(rows):
    """Markdown: means, a line for each map and prior, then the counts."""
    groups = shared(rows)
    priors = list(next(iter(groups.values())))
    lines = ["| map | prior | cases | " + " | ".join(t for _, t in METRICS) +
             " | constant map, aligned |",
             "|---" * (len(METRICS) + 4) + "|"]
    everything = {p: [r for of in groups.values() for r in of[p]]
                  for p in priors}
    for name, of in list(groups.items()) + [("all", everything)]:
        for prior in priors:
            cells = [mean(of[prior], c)
                     for c, _ in METRICS + ((CONSTANT, ""),)]
            lines.append(f"| {name} | {prior} | {len(of[prior])} | " + " | ".join(
                "" if v is None else f"{v:.3g}" for v in cells) + " |")
    lines.append("")
    for prior in priors[:-1]:
        for column, title in METRICS[:2]:
            lines.append(
                f"With `{prior}` the mean relative log-RMSE, {title}, is below "
                f"that with `{priors[-1]}` on "
                f"{wins(groups, prior, priors[-1], column)} of {len(groups)} "
                "maps.")
    return "\n".join(lines) + "\n"


def draw(rows, out):
    groups = shared(rows)
    priors = list(next(iter(groups.values())))
    pyplot = open_pyplot()
    figure, axes = pyplot.subplots(figsize=(1.5 + 0.85 * len(groups), 4.2))
    width = 0.7 / len(priors)
    for k, prior in enumerate(priors):
        colour = COLOURS.get(prior, "tab:blue")
        for i, of in enumerate(groups.values()):
            x = i + (k - (len(priors) - 1) / 2) * width
            values = numbers(of[prior], ERROR)
            axes.bar(x, sum(values) / len(values), 0.9 * width, color=colour,
                     alpha=0.45, label=f"{prior}, mean" if i == 0 else None)
            axes.plot([x] * len(values), values, "_", ms=7, color=colour)
    for i, of in enumerate(groups.values()):
        constant = mean(of[priors[0]], CONSTANT)
        if constant is not None:
            axes.plot([i - 0.4, i + 0.4], [constant] * 2, ":", color="black",
                      lw=1, label="constant map" if i == 0 else None)
    axes.set_xticks(range(len(groups)), list(groups), rotation=30, ha="right")
    axes.set_ylim(0.0, None)
    axes.set_ylabel("map, relative log-RMSE, aligned")
    axes.set_title("reflectance known; marks: materials")
    axes.legend()
    figure.tight_layout()
    figure.savefig(out)
    pyplot.close(figure)


if __name__ == "__main__":
    table_and_picture(__doc__, "known-brdf",
                      ("material", "map", "geometry", "prior", CONSTANT) +
                      tuple(c for c, _ in METRICS),
                      table, draw)
