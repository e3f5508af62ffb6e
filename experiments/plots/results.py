"""Tables of results.csv for the plots: rows, numbers, fronts, labels."""
import argparse
import csv
import math
from pathlib import Path

# What the sweeps write where the solver left an estimate.
SOLVED = ("ok", "no_improvement")
# Of labels, over lines.
BACKGROUND = dict(boxstyle="square,pad=0.1", fc="white", ec="none", alpha=0.7)


def read_rows(path, columns):
    """The rows whose solver left an estimate, as dicts.

    Raises ValueError, naming the file, where a column is missing or no row is
    left.
    """
    with open(path, newline="") as file:
        reader = csv.DictReader(file)
        missing = [c for c in columns if c not in (reader.fieldnames or [])]
        if missing:
            raise ValueError(f"{path}: expected the column {missing[0]}")
        rows = [row for row in reader if row.get("status") in SOLVED]
    if not rows:
        raise ValueError(f"{path}: holds no case that was solved")
    return rows


def numbers(rows, column):
    """The column's numbers, in order, without empty cells."""
    return [float(row[column]) for row in rows if row[column]]


def percentile(values, share):
    """Linear between the order statistics; share in [0, 1]."""
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    low = math.floor(at)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (at - low) * (ordered[high] - ordered[low])


def median(values):
    return percentile(values, 0.5)


def front(points):
    """Indices of the (cost, error) that no other point beats, by cost.

    A point is beaten by one that is no worse in both and better in one.
    """
    order = sorted(range(len(points)), key=lambda i: points[i])
    kept = []
    for i in order:
        if not kept or points[i][1] < points[kept[-1]][1]:
            kept.append(i)
    return kept


def place_labels(axes, points, texts, avoid=(), size=7):
    """Writes the texts near their points (data coordinates) where there is
    room: off each other, off the points and off the boxes of `avoid`
    (artists). Call last, with limits and layout set."""
    from matplotlib.text import Text
    figure = axes.figure
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    taken = [artist.get_window_extent(renderer) for artist in avoid]
    places = [axes.transData.transform(p) for p in points]
    frame = axes.get_window_extent(renderer)
    for text, point in zip(texts, points):
        best = None
        for reach in (6, 14, 24, 36, 50, 66, 85, 105):
            for angle in (0, 180, 30, 330, 150, 210, 60, 300, 90, 270):
                dx = reach * math.cos(math.radians(angle))
                dy = reach * math.sin(math.radians(angle))
                label = axes.annotate(
                    text, point, (dx, dy), textcoords="offset points",
                    fontsize=size, bbox=BACKGROUND,
                    ha="left" if dx > 1 else "right" if dx < -1 else "center",
                    va="bottom" if dy > 1 else "top" if dy < -1 else "center",
                    arrowprops=None if reach < 10 else dict(
                        arrowstyle="-", lw=0.4, color="0.5", shrinkB=3))
                # Of the text alone: with its line it would hit its own point.
                label.update_positions(renderer)
                box = Text.get_window_extent(label, renderer)
                clear = (frame.x0 <= box.x0 and box.x1 <= frame.x1 and
                         frame.y0 <= box.y0 and box.y1 <= frame.y1 and
                         not any(box.overlaps(other) for other in taken) and
                         not any(box.x0 - 3 < x < box.x1 + 3 and
                                 box.y0 - 3 < y < box.y1 + 3
                                 for x, y in places))
                if clear:
                    best = box
                    break
                label.remove()
            if best is not None:
                break
        if best is not None:
            taken.append(best)
        else:  # no room: on the point's right, over what is there
            axes.annotate(text, point, (6, 0), textcoords="offset points",
                          fontsize=size, va="center", bbox=BACKGROUND)


def table_and_picture(doc, sweep, columns, table, draw):
    """A program of RESULTS.csv of a sweep: --table FILE.md receives
    table(rows); --out FILE.png, or without both SWEEP.png, draw(rows, file).
    """
    parser = argparse.ArgumentParser(description=doc.split("\n")[0])
    parser.add_argument("results", help=f"results.csv of {sweep}")
    parser.add_argument("--out", help="the picture")
    parser.add_argument("--table", help="Markdown, by map")
    options = parser.parse_args()
    try:
        rows = read_rows(options.results, columns)
        if options.table:
            Path(options.table).write_text(table(rows))
        if options.out or not options.table:
            draw(rows, options.out or f"{sweep.replace('-', '_')}.png")
    except (OSError, ValueError) as error:
        parser.exit(2, f"error: {error}\n")


def open_pyplot():
    """matplotlib.pyplot without a display, in the plots' common style."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    pyplot.rcParams.update({
        "font.size": 8, "axes.spines.top": False, "axes.spines.right": False,
        "axes.grid": True, "grid.color": "0.9", "grid.linewidth": 0.6,
        "legend.frameon": False, "savefig.dpi": 150})
    return pyplot
