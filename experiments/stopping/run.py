#!/usr/bin/env python3
"""Does the error rise after the solver's own stop?

    experiments/stopping/run.py PROBLEM.yaml ... [--bin build/release/bin] [--results FILE.csv]

For each joint problem that states its truth: the search's last descent goes on far past its stop (`evidence --further`); the
whole solve as the file asks for it, without a clock, and without a clock for 40 rounds at a tolerance of 1e-9. The
solver never sees the truth; this script reads it after the fact.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# Name, and what is set.
SOLVES = (("as asked", ()),
          ("no clock", ("solver.seconds=100000",)),
          ("no clock, tolerance 1e-9, 40 rounds",
           ("solver.seconds=100000", "solver.tolerance=1e-9", "solver.max_iterations=40")))
COLUMNS = ("problem", "what", "seconds", "rounds", "cost", "misfit", "brdf_log_rmse_aligned",
           "illumination_relative_log_rmse_aligned")
POINT = re.compile(r"^  (found|further) +cost +(\S+) .* misfit (\S+) .*BRDF aligned (\S+)", re.M)
STEPS = re.compile(r"^  (\d+) steps further", re.M)


def run(command):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
    # 3: not better than its initial guess; a result all the same.
    if done.returncode not in (0, 3):
        sys.exit(f"{command[0]}: exit {done.returncode}: {done.stderr}")
    return done.stdout


def descents(args, problem):
    out = run([args.bin / "evidence", "--found", "--further", problem])
    steps = STEPS.search(out)
    for what, cost, misfit, error in POINT.findall(out):
        yield {"what": "search, " + ("its stop" if what == "found" else "further"),
               "rounds": steps.group(1) if what == "further" and steps else "", "cost": cost, "misfit": misfit,
               "brdf_log_rmse_aligned": error}


def solves(args, problem, folder):
    for name, values in SOLVES:
        sets = [part for value in values for part in ("--set", value)]
        run([args.bin / "ibrdf_solve", "--problem", problem, "--out", folder, "--quiet", *sets])
        result = json.loads((folder / "result.json").read_text())
        metrics = result["metrics"]
        yield {"what": name, "seconds": f"{metrics['seconds']:.1f}", "rounds": len(result["trace"]),
               "cost": f"{result['cost']['end']:.1f}", "misfit": f"{metrics['misfit']:.4g}",
               **{c: f"{metrics[c]:.4g}" for c in COLUMNS[-2:] if c in metrics}}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("problems", nargs="+", type=pathlib.Path, help="joint problems with truth")
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--results", type=pathlib.Path, help="table to write (CSV)")
    args = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory(prefix="ibrdf-stopping-") as name:
        for problem in args.problems:
            for part in (descents(args, problem), solves(args, problem, pathlib.Path(name) / "out")):
                for row in part:
                    rows.append({"problem": f"{problem.parent.name}/{problem.stem}", **row})
                    print(*(rows[-1].get(c, "-") for c in COLUMNS), flush=True)
    if args.results is not None:
        with open(args.results, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
