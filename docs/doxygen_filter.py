#!/usr/bin/env python3
"""Doxygen's view of a header: `doxygen_filter.py FILE` prints it with the comments that Doxygen shows marked.

The comment at the top describes the file, one above a declaration the declaration, one behind it too, and all of a
comment that goes on in the lines below it.
"""
import re
import sys

ABOVE = re.compile(r"^(\s*)// ?(.*)$")
BEHIND = re.compile(r"^(.*\S\s+)// (.*)$")
# Doxygen takes these for markup; in comments of the code they are themselves.
MARKUP = re.compile(r"[\\@<>]")


def marked(lines):
    """The lines, each comment as one that Doxygen reads."""
    column = None  # of a comment behind a declaration, which may go on
    for number, line in enumerate(lines):
        above, behind = ABOVE.match(line), BEHIND.match(line)
        if above:
            indent, text = above.group(1), MARKUP.sub(r"\\\g<0>", above.group(2))
            if number == 0:
                yield "/// \\file"
            yield f"{indent}///{'<' if len(indent) == column else ''} {text}"
        elif behind:
            column = len(behind.group(1))
            yield f"{behind.group(1)}///< " + MARKUP.sub(r"\\\g<0>", behind.group(2))
        else:
            column = None
            yield line


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        print("\n".join(marked(file.read().splitlines())))
