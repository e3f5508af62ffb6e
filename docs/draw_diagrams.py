#!/usr/bin/env python3
"""Draws the developer guide's diagrams as SVG, with the standard library alone.

    docs/draw_diagrams.py            writes docs/tree.svg and docs/data_flow.svg
    docs/draw_diagrams.py --check    status 1 where a file is not what would be drawn

tree.svg shows the folders and which of them link which others, as tests/tree/check_tree.py reads it from the
CMakeLists.txt. An arrow that others imply is left out. data_flow.svg shows the types of a solve from file to file.
"""
import html
import importlib.util
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
FONT = "font-family='DejaVu Sans, Verdana, Helvetica, sans-serif'"
GROUPS = {"src/ibrdf": ("#dbe9f6", "#2b6ca3"), "io": ("#ddf0dd", "#3a8a3a"), "solvers": ("#fdebd3", "#c27a1a")}


# ---------------------------------------------------------------- folders


def folder_graph():
    """Folder -> folders that it links, and folder -> group."""
    spec = importlib.util.spec_from_file_location("check_tree", ROOT / "tests/tree/check_tree.py")
    check_tree = importlib.util.module_from_spec(spec)
    sys.dont_write_bytecode = True
    spec.loader.exec_module(check_tree)
    graph = {name: set(others) for name, others in check_tree.check()[0].items()}
    group = {name: "io" if name == "io" else path.parent.relative_to(ROOT).as_posix()
             for name, path in check_tree.folders().items()}
    # Mains link umbrellas, which stand for many folders.
    umbrella = {}
    for file in (ROOT / "src/CMakeLists.txt", ROOT / "solvers/CMakeLists.txt"):
        for name, parts in re.findall(r"ibrdf_add_umbrella\((\w+)\s+([^)]*)\)", file.read_text()):
            umbrella[name] = parts.split()
    mains = (ROOT / "solvers/programs/CMakeLists.txt").read_text()
    for name in re.findall(r"ibrdf_add_program\(\w+ ibrdf::(\w+)\)", mains):
        graph["programs"] |= set(umbrella.get(name, [name])) - {"programs"}
    return graph, group


def reduced(graph):
    """The graph without arrows that longer paths imply."""
    reach = {}

    def below(name):
        if name not in reach:
            reach[name] = set().union(*({other} | below(other) for other in graph[name])) if graph[name] else set()
        return reach[name]

    return {name: {other for other in others if not any(other in below(via) for via in others if via != other)}
            for name, others in graph.items()}


def layers_of(arrows):
    """Rows of nodes, the lowest first, with a dummy (a, b, row) where an arrow passes a row; and its segments."""
    rank = {}

    def of(name):
        if name not in rank:
            rank[name] = 1 + max((of(other) for other in arrows[name]), default=-1)
        return rank[name]

    rows = [[] for _ in range(1 + max(map(of, sorted(arrows))))]
    for name in sorted(arrows):
        rows[rank[name]].append(name)
    paths = []
    for name in sorted(arrows):
        for other in sorted(arrows[name]):
            dummies = [(name, other, row) for row in range(rank[name] - 1, rank[other], -1)]
            for dummy in dummies:
                rows[dummy[2]].append(dummy)
            paths.append([name, *dummies, other])
    return rows, paths


def crossings(rows, paths):
    at = {node: i for row in rows for i, node in enumerate(row)}
    level = {node: k for k, row in enumerate(rows) for node in row}
    by_row = {}
    for path in paths:
        for a, b in zip(path, path[1:]):
            by_row.setdefault(level[a], []).append((at[a], at[b]))
    return sum((a[0] - b[0]) * (a[1] - b[1]) < 0 for ends in by_row.values() for i, a in enumerate(ends)
               for b in ends[:i])


def ordered(rows, paths):
    """Rows in an order with few crossings: by the means of neighbours, then by swaps."""
    near = {}
    for path in paths:
        for a, b in zip(path, path[1:]):
            near.setdefault(a, []).append(b)
            near.setdefault(b, []).append(a)
    level = {node: k for k, row in enumerate(rows) for node in row}
    best, least = rows, crossings(rows, paths)
    for sweep in range(24):
        rows = [list(row) for row in rows]
        up = sweep % 2 == 0
        order = range(1, len(rows)) if up else range(len(rows) - 2, -1, -1)
        for k in order:
            place = {node: i / max(len(row) - 1, 1) for row in rows for i, node in enumerate(row)}

            def mean(node):
                ends = [place[n] for n in near.get(node, []) if (level[n] < k) == up]
                return math.fsum(ends) / len(ends) if ends else place[node]

            rows[k].sort(key=mean)
        count = crossings(rows, paths)
        if count < least:
            best, least = rows, count
    rows, moved = [list(row) for row in best], True
    while moved:
        moved = False
        for row in rows:
            for i in range(len(row) - 1):
                row[i], row[i + 1] = row[i + 1], row[i]
                count = crossings(rows, paths)
                if count < least:
                    least, moved = count, True
                else:
                    row[i], row[i + 1] = row[i + 1], row[i]
    return rows


def placed(rows, paths, width_of, gap):
    """x of every node: near the means of its neighbours, in order, apart."""
    near = {}
    for path in paths:
        for a, b in zip(path, path[1:]):
            # Arrows that pass rows stay straight.
            weight = 4.0 if isinstance(a, tuple) and isinstance(b, tuple) else 1.0
            near.setdefault(a, []).append((b, weight))
            near.setdefault(b, []).append((a, weight))
    x = {}
    for row in rows:
        at = 0.0
        for node in row:
            x[node] = at + width_of(node) / 2
            at += width_of(node) + gap
    middle = max(x.values()) / 2
    for row in rows:
        shift = middle - (x[row[0]] + x[row[-1]]) / 2
        for node in row:
            x[node] += shift
    for sweep in range(200):
        for row in rows if sweep % 2 else reversed(rows):
            wish = [math.fsum(x[n] * w for n, w in near.get(node, [(node, 1.0)])) /
                    math.fsum(w for _, w in near.get(node, [(node, 1.0)])) for node in row]
            # The order from the left and from the right; their mean keeps apart.
            left, right = list(wish), list(wish)
            for i in range(1, len(row)):
                apart = (width_of(row[i - 1]) + width_of(row[i])) / 2 + gap
                left[i] = max(left[i], left[i - 1] + apart)
            for i in range(len(row) - 2, -1, -1):
                apart = (width_of(row[i + 1]) + width_of(row[i])) / 2 + gap
                right[i] = min(right[i], right[i + 1] - apart)
            for i, node in enumerate(row):
                x[node] = (left[i] + right[i]) / 2
    least = min(x[node] - width_of(node) / 2 for node in x)
    return {node: value - least for node, value in x.items()}


def draw_tree():
    graph, group = folder_graph()
    arrows = reduced(graph)
    rows, paths = layers_of(arrows)
    rows = ordered(rows, paths)
    width_of = lambda node: 6 if isinstance(node, tuple) else 16 + 8.2 * len(node)
    x = placed(rows, paths, width_of, 18)
    step, box, margin = 62, 26, 24
    y = {node: margin + 40 + step * (len(rows) - 1 - k) + box / 2 for k, row in enumerate(rows) for node in row}
    width = max(x[node] + width_of(node) / 2 for node in x) + 2 * margin
    height = margin + 40 + step * (len(rows) - 1) + box + margin
    svg = Svg(width, height)
    at = margin
    for name, (fill, line) in GROUPS.items():
        svg.box(at, 12, 14, 14, fill, line)
        svg.text(at + 20, 24, name + "/", "start", 13)
        at += 50 + 8.5 * len(name)
    for path in paths:
        points = []
        for i, node in enumerate(path):
            if i == 0:
                points.append((margin + x[node], y[node] + box / 2))
            elif i == len(path) - 1:
                points.append((margin + x[node], y[node] - box / 2 - 2))
            else:
                points += [(margin + x[node], y[node] - box / 2), (margin + x[node], y[node] + box / 2)]
        svg.curve(points, GROUPS[group[path[0]]][1])
    for node in x:
        if isinstance(node, tuple):
            continue
        fill, line = GROUPS[group[node]]
        w = width_of(node)
        svg.box(margin + x[node] - w / 2, y[node] - box / 2, w, box, fill, line)
        svg.text(margin + x[node], y[node] + 4.5, node, "middle", 13)
    return svg.document("Folders of the code, and which of them link which others")


# ---------------------------------------------------------------- a solve

TYPE, STAGE, FILE = ("#dbe9f6", "#2b6ca3"), ("#fdebd3", "#c27a1a"), ("#eeeeee", "#777777")


def draw_data_flow():
    svg = Svg(960, 0)
    centre = svg.width / 2

    def box(x, y, w, lines, colours, size=13):
        h = 14 + 17 * len(lines)
        svg.box(x - w / 2, y, w, h, *colours)
        for i, line in enumerate(lines):
            svg.text(x, y + 20 + 17 * i, line, "middle", size, bold=i == 0 and colours is not FILE)
        return y + h

    def arrow(*points):
        svg.curve([*points[:-1], (points[-1][0], points[-1][1] - 2)], "#444444")

    def beside(y, name, where, what):
        svg.text(centre + 14, y + 19, name, "start", 13, bold=True)
        svg.text(centre + 14, y + 35, where, "start", 11.5, colour="#666666")
        svg.text(centre - 14, y + 27, what, "end", 12.5)

    def step(y, name, where, what):
        """An arrow down with its function beside it."""
        arrow((centre, y), (centre, y + 46))
        beside(y, name, where, what)
        return y + 46

    y = box(centre, 16, 400, ["joint.yaml; image, mask, shape, maps, tables"], FILE)
    y = step(y, "ReadProblem", "io/problem_file", "checks keys, types and ranges")
    y = box(centre, y, 320, ["Problem", "what the file says"], TYPE)
    y = step(y, "LoadInverseProblem", "solvers/problem/load_problem", "reads the files, finds pixels, plans effects")
    y = box(centre, y, 320, ["InverseProblem", "image, points, model, knowns, transport"], TYPE)
    y = step(y, "InUnitsOf, SetUp", "solvers/solve/exposure, solvers/estimation",
             "brings radiance near 1, bins pixels, makes priors")
    y = box(centre, y, 320, ["SolveSetup", "what all stages share"], TYPE)
    svg.line(centre, y, y + 46, "#444444")
    beside(y, "EstimateUnknowns", "solvers/solve/solve.cc", "which are unknown?")
    top = y + 46
    # Unknowns; the first stage and, where there is one, its result and the second.
    columns = [(125, "both unknown", "EstimateReflectances", "ReflectanceEstimate", "EstimateLight"),
               (362, "light known", "EstimateReflectanceGivenLight", "", ""),
               (598, "reflectance known", "EstimateLightPosterior", "LightPosterior", "EstimateLight"),
               (835, "both, estimator: maximum", "EstimateJointMaximum", "", "")]
    ends = []
    for x, when, first, between, second in columns:
        arrow((centre, top), (x, top + 44))
        svg.text(x, top + 60, when, "middle", 12, colour="#666666")
        at = box(x, top + 68, 226, [first], STAGE, 12)
        if second:
            arrow((x, at), (x, at + 40))
            svg.text(x + 10, at + 24, between, "start", 11.5, colour="#2b6ca3")
            at = box(x, at + 40, 226, [second], STAGE, 12)
        ends.append((x, at))
    lowest = max(at for _, at in ends)
    for x, at in ends:
        arrow((x, at), *([(x, lowest)] if at < lowest else []), (centre + (x - centre) * 0.2, lowest + 46))
    y = box(centre, lowest + 46, 320, ["Estimate", "iterate, reference, posterior"], TYPE)
    y = step(y, "Summarise", "solvers/solve/summary", "renders every pixel, compares with the reference")
    y = box(centre, y, 320, ["Solution", "BRDF, map, render, trace, status"], TYPE)
    y = step(y, "WriteResults", "solvers/report/write_results", "metrics, pictures, the page")
    y = box(centre, y, 440, ["result.json, brdf.binary, illumination.exr, report.html, ..."], FILE)
    svg.height = y + 18
    return svg.document("From files to files: the types and stages of a solve")


# ---------------------------------------------------------------- SVG


class Svg:
    def __init__(self, width, height):
        self.width, self.height, self.parts = width, height, []

    def box(self, x, y, w, h, fill, line):
        self.parts.append(f"<rect x='{x:.1f}' y='{y:.1f}' width='{w:.1f}' height='{h:.1f}' rx='5' fill='{fill}' "
                          f"stroke='{line}' stroke-width='1.2'/>")

    def text(self, x, y, text, anchor, size, bold=False, colour="#111111"):
        weight = " font-weight='bold'" if bold else ""
        self.parts.append(f"<text x='{x:.1f}' y='{y:.1f}' text-anchor='{anchor}' font-size='{size}' fill='{colour}' "
                          f"{FONT}{weight}>{html.escape(text)}</text>")

    def line(self, x, y0, y1, colour):
        self.parts.append(f"<path d='M {x:.1f} {y0:.1f} V {y1:.1f}' stroke='{colour}' stroke-width='1.3' "
                          f"stroke-opacity='0.75'/>")

    def curve(self, points, colour):
        """A smooth line through points that runs vertically at them, with an arrow head."""
        path = f"M {points[0][0]:.1f} {points[0][1]:.1f}"
        for (x0, y0), (x1, y1) in zip(points, points[1:]):
            middle = (y0 + y1) / 2
            path += f" C {x0:.1f} {middle:.1f} {x1:.1f} {middle:.1f} {x1:.1f} {y1:.1f}"
        self.parts.append(f"<path d='{path}' fill='none' stroke='{colour}' stroke-width='1.3' stroke-opacity='0.75' "
                          f"marker-end='url(#head)'/>")

    def document(self, title):
        return (f"<svg xmlns='http://www.w3.org/2000/svg' width='{self.width:.0f}' height='{self.height:.0f}' "
                f"viewBox='0 0 {self.width:.0f} {self.height:.0f}' role='img'>\n<title>{html.escape(title)}</title>\n"
                "<defs><marker id='head' viewBox='0 0 8 8' refX='7' refY='4' markerWidth='7' markerHeight='7' "
                "orient='auto'><path d='M 0 0.5 L 8 4 L 0 7.5 z' fill='#555555'/></marker></defs>\n"
                f"<rect width='100%' height='100%' fill='white'/>\n" + "\n".join(self.parts) + "\n</svg>\n")


def main():
    stale = False
    for name, draw in (("tree.svg", draw_tree), ("data_flow.svg", draw_data_flow)):
        path, text = ROOT / "docs" / name, draw()
        if "--check" in sys.argv[1:]:
            if not path.exists() or path.read_text() != text:
                print(f"docs/{name} is not what docs/draw_diagrams.py draws")
                stale = True
        else:
            path.write_text(text)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
