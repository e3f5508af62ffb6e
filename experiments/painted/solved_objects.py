"""A row for each photographed object that photographs.py solved, and its command line."""
import argparse
import pathlib


def print_table(description, columns, pattern, row):
    """Prints `columns` and, for each of the results' folders OUT/OBJECT_LIGHT_VARIATION that match `pattern`, what
    row(photograph, solved, object, light) makes of it: text, or None for none. The arguments are PHOTOGRAPHS and OUT."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("photographs", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    arguments = parser.parse_args()
    print(columns)
    for solved in sorted(arguments.out.glob(pattern)):
        name, light, _ = solved.name.split("_")
        text = row(arguments.photographs / name, solved, name, light)
        if text is not None:
            print(text, flush=True)
