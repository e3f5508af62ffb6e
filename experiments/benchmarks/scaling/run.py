#!/usr/bin/env python3
"""Seconds and memory of ibrdf_solve against the pixels of the image and the texels of the map.

    experiments/benchmarks/scaling/run.py [--bin build/release/bin] [--results FILE.csv] [--plot FILE.png] [--repeats 2]
                               [--sizes 32,64,128,256,512] [--widths 32,64,128,256]
                               [--problems joint,reflectance,illumination]

Renders a glossy sphere under the artificial sky at every size and solves it with the same number of rounds, which the
clock does not end. Prints, by least squares, the power of the pixels or texels that each quantity grows with.
--draw-only reads the table in place of that; --plot needs Debian's python3-matplotlib (scripts/install_plots.sh).
"""
import argparse
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "plots"))
from results import open_pyplot

SIZE, WIDTH = 128, 128  # of the image while the map varies, and the other way round; pixels, texels
ROUNDS = 4
COLUMNS = ("problem", "varied", "pixels", "texels", "repeat", "seconds", "megabytes", "misfit")
SCENE = """
image: {{width: {size}, height: {size}}}
geometry: {{sphere: {{}}}}
reflectance: {{known: {{cook_torrance: {{diffuse: [0.3, 0.2, 0.1], specular: 0.5, roughness: 0.2, f0: 0.1}}}}}}
illumination: {{known: {{sky: {{}}}}, width: 256, height: 128}}
noise: 0.02
"""
PROBLEM = """
problem: {problem}
image: {{file: input_{size}.exr}}
geometry: {{sphere: {{}}}}
reflectance: {reflectance}
illumination: {illumination}
solver: {{seconds: 100000, tolerance: 1e-12, max_iterations: {rounds}}}
"""
PARTS = {
    "joint": ("{model: default, lobes: 2}", "{width: %d, height: %d}"),
    "reflectance": ("{model: default, lobes: 2}", "{width: %d, height: %d, known: map.exr}"),
    "illumination": ("{known: brdf.binary}", "{width: %d, height: %d}"),
}


def program(command):
    """Runs it; its seconds of wall clock and peak memory in MB."""
    start = time.monotonic()
    child = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    # 3: not better than its initial guess; a result all the same.
    if code not in (0, 3):
        sys.exit(f"{command[0]}: exit {code}")
    return time.monotonic() - start, usage.ru_maxrss / 1024


def render(args, folder, size):
    (folder / "scene.yaml").write_text(SCENE.format(size=size))
    program([args.bin / "ibrdf_render", "--scene", folder / "scene.yaml", "--out", folder / f"input_{size}.exr",
             "--illumination-out", folder / "map.exr", "--brdf-out", folder / "brdf.binary", "--quiet"])


def solve(args, folder, problem, size, width):
    reflectance, illumination = PARTS[problem]
    path = folder / "problem.yaml"
    path.write_text(PROBLEM.format(problem=problem, size=size, rounds=ROUNDS, reflectance=reflectance,
                                   illumination=illumination % (width, width // 2)))
    seconds, megabytes = program([args.bin / "ibrdf_solve", "--problem", path, "--out", folder / "out", "--quiet"])
    result = json.loads((folder / "out" / "result.json").read_text())
    pixels = round(math.pi / 4 * size**2)  # of the sphere's disc
    return {"problem": problem, "pixels": pixels, "texels": width * width // 2, "seconds": f"{seconds:.2f}",
            "megabytes": f"{megabytes:.0f}", "misfit": f"{result['metrics']['misfit']:.4g}"}


def measure(args):
    rows = []
    with tempfile.TemporaryDirectory(prefix="ibrdf-scaling-") as name:
        folder = pathlib.Path(name)
        for size in sorted({*args.sizes, SIZE}):
            render(args, folder, size)
        # Repeats outermost: what slows the machine for a while slows one of each.
        for repeat in range(args.repeats):
            for problem in args.problems:
                for varied, size, width in ([("pixels", size, WIDTH) for size in args.sizes] +
                                            [("texels", SIZE, width) for width in args.widths]):
                    row = solve(args, folder, problem, size, width) | {"varied": varied, "repeat": repeat + 1}
                    rows.append(row)
                    print(*(row[c] for c in COLUMNS), flush=True)
    return rows


def curve(rows, problem, varied, quantity):
    """[(pixels or texels, least of the repeats)], ascending."""
    least = {}
    for row in rows:
        if (row["problem"], row["varied"]) == (problem, varied):
            at, value = int(row[varied]), float(row[quantity])
            least[at] = min(value, least.get(at, math.inf))
    return sorted(least.items())


def power(points):
    """The exponent of y = a x^b, by least squares of the logarithms."""
    xs = [math.log(x) for x, _ in points]
    ys = [math.log(y) for _, y in points]
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx)**2 for x in xs)


def report(rows):
    for problem in dict.fromkeys(row["problem"] for row in rows):
        for varied in ("pixels", "texels"):
            for quantity in ("seconds", "megabytes"):
                points = curve(rows, problem, varied, quantity)
                if len(points) > 2:
                    print(f"{problem}: {quantity} by {varied}: power {power(points):.2f} of all, "
                          f"{power(points[-2:]):.2f} of the last two")


def draw(rows, path):
    pyplot = open_pyplot()
    figure, panels = pyplot.subplots(2, 2, figsize=(9, 6.5), sharex="col")
    for across, varied in enumerate(("pixels", "texels")):
        for down, quantity in enumerate(("seconds", "megabytes")):
            axes = panels[down][across]
            for problem in dict.fromkeys(row["problem"] for row in rows):
                points = curve(rows, problem, varied, quantity)
                if not points:
                    continue
                line, = axes.plot(*zip(*points), "o-", ms=4, label=problem)
                # What linear growth up to the last point would have been.
                (least, lowest), (most, value) = points[0], points[-1]
                least = max(least, most * lowest / value / 3)
                axes.plot([least, most], [value * least / most, value], ":", color=line.get_color(), lw=1)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_ylabel("seconds, wall clock" if quantity == "seconds" else "peak memory, MB")
            if down:
                fixed = f"map {WIDTH}x{WIDTH // 2}" if varied == "pixels" else f"image {SIZE}x{SIZE}"
                axes.set_xlabel(f"{varied} ({fixed})")
    panels[0][0].plot([], [], ":", color="0.4", lw=1, label="linear growth")
    panels[0][0].legend()
    figure.tight_layout()
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--results", type=pathlib.Path, help="table to write (CSV), or with --draw-only to read")
    parser.add_argument("--plot", type=pathlib.Path, help="picture of the table")
    parser.add_argument("--draw-only", action="store_true", help="of the table that is there")
    parser.add_argument("--repeats", type=int, default=2, help="the least of them counts")
    parser.add_argument("--sizes", default="32,64,128,256,512", help="of the image, pixels across")
    parser.add_argument("--widths", default="32,64,128,256", help="of the map, texels")
    parser.add_argument("--problems", default=",".join(PARTS))
    args = parser.parse_args()
    args.sizes = [int(v) for v in args.sizes.split(",")]
    args.widths = [int(v) for v in args.widths.split(",")]
    args.problems = args.problems.split(",")
    if args.draw_only:
        with open(args.results, newline="") as file:
            rows = list(csv.DictReader(file))
    else:
        rows = measure(args)
        if args.results is not None:
            with open(args.results, "w", newline="") as file:
                writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(rows)
    report(rows)
    if args.plot is not None:
        draw(rows, args.plot)


if __name__ == "__main__":
    main()
