#!/usr/bin/env python3
"""The same solves at every instruction set, in double precision and with 1, 2 and 8 threads.

    experiments/validation/precision/run.py [--bin build/release/bin] [--results FILE.csv] [--quick] [--size 16]
                                 [--levels double,avx2,...] [--threads 1,2,8] [--problems joint,...]

Exits with 1 where two numbers of threads differ in a bit, or two levels by more than BOUNDS; with 77 where this machine
has but one level. --quick is for the tests.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

# What two levels of the same problem may differ by (README.md): log-RMSE of the reflectance below 80 degrees and of all
# its bins; of the map, relative to its range; cost and misfit relative. Of joint solves this is of the scene here: elsewhere
# a rounding may decide which of several almost equal ends wins.
BOUNDS = {
    "reflectance": {"brdf_below80": 5e-4, "brdf": 5e-4, "cost": 1e-4, "misfit": 1e-4},
    "illumination": {"map": 5e-3, "cost": 2e-2, "misfit": 2e-2},
    "joint": {"brdf_below80": 2e-2, "brdf": 2e-2, "map": 1e-2, "cost": 6e-2, "misfit": 2e-2},
}
ROUNDS = 100  # more than any needs: solves end where they converge
LEVELS = ("double", "portable", "avx2", "avx512")  # the first is what others are compared with
# No clock decides.
SCENE = """
image: {{width: {size}, height: {size}}}
geometry: {{sphere: {{}}}}
reflectance: {{known: {{cook_torrance: {{diffuse: [0.3, 0.2, 0.1], specular: 0.5, roughness: 0.2, f0: 0.1}}}}}}
illumination: {{known: {{sky: {{}}}}, width: {width}, height: {height}}}
noise: 0.02
"""
PROBLEM = """
problem: {problem}
image: {{file: input.exr}}
geometry: {{sphere: {{}}}}
reflectance: {reflectance}
illumination: {illumination}
solver: {{seconds: 100000, max_iterations: {rounds}}}
truth: {{brdf: brdf.binary, illumination: map.exr}}
"""
PARTS = {
    "reflectance": ("{model: default, lobes: 2}", "{width: %d, height: %d, known: map.exr}"),
    "illumination": ("{known: brdf.binary}", "{width: %d, height: %d}"),
    "joint": ("{model: default, lobes: 2}", "{width: %d, height: %d}"),
}
# All that a solve writes but for report.html and PNG files with times in them.
FILES = ("brdf.binary", "brdf.json", "illumination.exr", "illumination_log_std.exr", "render.exr", "residual.exr")
COLUMNS = ("problem", "level", "threads", "seconds", "start", "rounds", "cost", "misfit", "same_bits_as_fewest_threads",
           "brdf_below80", "brdf", "map", "cost_relative", "misfit_relative", "brdf_below80_truth", "brdf_truth",
           "map_truth")


def timeless(value):
    """Of result.json, without what a clock says."""
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in ("seconds", "seconds_predicted")}
    if isinstance(value, list):
        return [timeless(v) for v in value]
    return value


class Study:
    def __init__(self, args, folder):
        self.args = args
        self.folder = pathlib.Path(folder)
        self.failures = []
        self.rows = []
        self.size, self.width, self.height = args.size, 2 * args.size, args.size

    def fail(self, what):
        self.failures.append(what)
        print("FAILED:", what, flush=True)

    def program(self, name, *arguments, level=None):
        environment = dict(os.environ)
        environment.pop("IBRDF_SIMD", None)
        if level is not None:
            environment["IBRDF_SIMD"] = level
        done = subprocess.run([str(self.args.bin / name), *map(str, arguments)], capture_output=True, text=True,
                              env=environment)
        # 3: not better than its initial guess; a result all the same.
        if done.returncode not in (0, 3):
            sys.exit(f"{name}: exit {done.returncode}: {done.stderr}")
        return done.stdout

    def prepare(self):
        scene = SCENE.format(size=self.size, width=self.width, height=self.height)
        (self.folder / "scene.yaml").write_text(scene)
        self.program("ibrdf_render", "--scene", self.folder / "scene.yaml", "--out", self.folder / "input.exr",
                     "--illumination-out", self.folder / "map.exr", "--brdf-out", self.folder / "brdf.binary",
                     "--quiet")
        for problem, (reflectance, illumination) in PARTS.items():
            (self.folder / f"{problem}.yaml").write_text(PROBLEM.format(
                problem=problem, reflectance=reflectance, illumination=illumination % (self.width, self.height),
                rounds=ROUNDS))

    def out(self, problem, level, threads):
        return self.folder / f"{problem}-{level}-{threads}"

    def solve(self, problem, level, threads):
        out = self.out(problem, level, threads)
        start = time.monotonic()
        self.program("ibrdf_solve", "--problem", self.folder / f"{problem}.yaml", "--out", out, "--threads", threads,
                     "--quiet", level=level)
        seconds = time.monotonic() - start
        result = json.loads((out / "result.json").read_text())
        metrics = result["metrics"]
        return {"problem": problem, "level": level, "threads": threads, "seconds": f"{seconds:.1f}",
                "start": result["start"], "rounds": len(result["trace"]), "cost": result["cost"]["end"],
                "misfit": metrics["misfit"],
                "brdf_below80_truth": metrics.get("brdf_log_rmse_below80"), "brdf_truth": metrics.get("brdf_log_rmse"),
                "map_truth": metrics.get("illumination_relative_log_rmse")}

    def different_files(self, problem, level, threads, other):
        a, b = self.out(problem, level, threads), self.out(problem, level, other)
        different = [name for name in FILES if (a / name).exists() != (b / name).exists() or
                     (a / name).exists() and (a / name).read_bytes() != (b / name).read_bytes()]
        results = [timeless(json.loads((out / "result.json").read_text())) for out in (a, b)]
        if results[0] != results[1]:
            different.append("result.json")
        return different

    def compare(self, row, reference):
        """Adds the distances of a row's results from those of another level."""
        problem = row["problem"]
        a = self.out(problem, row["level"], row["threads"])
        b = self.out(problem, reference["level"], reference["threads"])
        if "brdf" in BOUNDS[problem]:
            metrics = json.loads(self.program("ibrdf_eval", "brdf", a / "brdf.binary", b / "brdf.binary"))
            row["brdf"], row["brdf_below80"] = metrics["brdf_log_rmse"], metrics["brdf_log_rmse_below80"]
        if "map" in BOUNDS[problem]:
            metrics = json.loads(self.program("ibrdf_eval", "illumination", a / "illumination.exr",
                                              b / "illumination.exr"))
            row["map"] = metrics["illumination_relative_log_rmse"]
        for name in ("cost", "misfit"):
            row[name + "_relative"] = abs(row[name] - reference[name]) / abs(reference[name])

    def threads_of(self, problem, level):
        """Joint solves in double precision are slow: not with one thread."""
        if self.args.quick and level != self.args.levels[-1]:
            return self.args.threads[:1]
        return self.args.threads[1:] if (problem, level) == ("joint", "double") else self.args.threads

    def study(self, problem):
        first = {}
        for level in self.args.levels:
            for threads in self.threads_of(problem, level):
                row = self.solve(problem, level, threads)
                first.setdefault(level, row)
                fewest = first[level]["threads"]
                different = self.different_files(problem, level, threads, fewest)
                row["same_bits_as_fewest_threads"] = "no" if different else "yes"
                if different:
                    self.fail(f"{problem}, {level}: {threads} threads differ from {fewest}: {different}")
                self.compare(row, first[self.args.levels[0]])
                self.rows.append(row)
                print({k: v for k, v in row.items() if v is not None}, flush=True)
        # Every pair, not only those with the first level.
        for a in self.args.levels:
            for b in self.args.levels:
                if a < b:
                    pair = dict(first[a])
                    self.compare(pair, first[b])
                    for name, bound in BOUNDS[problem].items():
                        found = pair[name + "_relative" if name in ("cost", "misfit") else name]
                        if not found <= bound:
                            self.fail(f"{problem}: {name} of {a} and {b} differs by {found:.2g}, bound {bound:.2g}")


def available(args):
    """The levels asked for that this machine has: the others fall back to portable, silently."""
    flags = set()
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("flags"):
            flags = set(line.split(":")[1].split())
            break
    needs = {"double": set(), "portable": set(), "avx2": {"avx2", "fma"},
             "avx512": {"avx512f", "avx512dq", "avx512bw", "avx512vl", "fma"}}
    levels = []
    for level in args.levels.split(","):
        if needs[level] <= flags:
            levels.append(level)
        else:
            print(f"SKIPPED: this machine lacks {level}")
    return levels


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--results", type=pathlib.Path, help="table to write (CSV)")
    parser.add_argument("--quick", action="store_true", help="two problems, several threads at the last level alone")
    parser.add_argument("--size", type=int, default=16, help="of the image, pixels; the map is twice as wide")
    parser.add_argument("--levels", help=f"the others are compared with the first; default: {','.join(LEVELS)}; quick: "
                        "without double")
    parser.add_argument("--threads", help="numbers of threads; default: 1,2,8, quick: 1,2")
    parser.add_argument("--problems", help=f"default: {','.join(PARTS)}; quick: without joint")
    args = parser.parse_args()
    args.levels = args.levels or ",".join(LEVELS[1:] if args.quick else LEVELS)
    args.problems = args.problems or ",".join(list(PARTS)[:2] if args.quick else PARTS)
    args.levels = available(args)
    args.threads = [int(n) for n in (args.threads or ("1,2" if args.quick else "1,2,8")).split(",")]
    if len(args.levels) < 2:
        print("SKIPPED: nothing to compare")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="ibrdf-precision-") as folder:
        study = Study(args, folder)
        study.prepare()
        for problem in args.problems.split(","):
            study.study(problem)
    if args.results is not None:
        with open(args.results, "w", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            for row in study.rows:
                writer.writerow({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()})
    sys.exit(1 if study.failures else 0)


if __name__ == "__main__":
    main()
