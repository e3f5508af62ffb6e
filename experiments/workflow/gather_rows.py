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
KEY_COLUMNS = ("material", "map", "setting", "prior", "geometry", "lobes",
               "method")


def gather_rows(row_files, results):
    """Writes the rows of `row_files` (one or more each) to table `results`.

    Columns are joined by name, absent cells are empty, rows are sorted by the
    columns that name a case. The table is whole or absent. Raises ValueError,
    naming the file, unless each holds whole rows and no case comes twice.
    """
    rows = {}
    columns = []
    for path in row_files:
        with open(path, newline="") as file:
            reader = csv.DictReader(file, strict=True)
            found = list(reader)
        if not found or any(None in row or None in row.values()
                            for row in found):
            raise ValueError(f"{path}: expected a header and whole rows")
        columns += [name for name in reader.fieldnames if name not in columns]
        for row in found:
            key = tuple(row.get(name, "") for name in KEY_COLUMNS)
            if key in rows:
                raise ValueError(f"{path}: a second row of {'_'.join(key)}")
            rows[key] = row
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
