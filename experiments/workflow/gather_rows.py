#!/usr/bin/env python3
"""Joins the tables of single cases into one.

As a program, for a look at a sweep that still runs:
  gather_rows.py FOLDER RESULTS.csv   # every .csv below FOLDER
"""
import csv
import os
import sys
from pathlib import Path

# The columns that name a case, where a sweep has them: they come first and
# give the order of the rows.
KEY_COLUMNS = ("material", "map", "geometry", "lobes", "method")


def gather_rows(row_files, results):
    """Writes the rows of `row_files` (one each) to the table `results`.

    Columns are joined by name, absent cells are empty, rows are sorted by the
    columns that name a case. The table is whole or absent. Raises ValueError,
    naming the file, unless each holds one row and no case comes twice.
    """
    rows = {}
    columns = []
    for path in row_files:
        with open(path, newline="") as file:
            reader = csv.DictReader(file, strict=True)
            found = list(reader)
        if len(found) != 1 or None in found[0] or None in found[0].values():
            raise ValueError(f"{path}: expected a header and one whole row")
        columns += [name for name in reader.fieldnames if name not in columns]
        key = tuple(found[0].get(name, "") for name in KEY_COLUMNS)
        if key in rows:
            raise ValueError(f"{path}: a second row of {'_'.join(key)}")
        rows[key] = found[0]
    first = [name for name in KEY_COLUMNS if name in columns]
    columns = first + [name for name in columns if name not in first]

    partial = f"{results}.part"
    with open(partial, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[key] for key in sorted(rows))
        file.flush()
        os.fsync(file.fileno())
    os.replace(partial, results)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    try:
        gather_rows(sorted(Path(sys.argv[1]).rglob("*.csv")), sys.argv[2])
    except (OSError, ValueError, csv.Error) as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
