#!/usr/bin/env python3
"""Breaks the programs from outside: kills, full disks, missing memory and files.

    experiments/validation/faults/run.py [--bin build/release/bin] [--kills 50] [--seed 1] [--table FILE] [--only PART,...]

Full disks are skipped without the right to mount a small tmpfs (root). Prints a table, also into FILE, and exits with 1
where something half-written is found, what was killed does not end the same when it is run again, or a failure is not
said in one line.
"""
import argparse
import pathlib
import sys

from solves import KINDS, Solves
from sweeps import Sweeps
from trainings import Trainings

PARTS = {
    Solves: ("kills", "writing_kills", "interrupts", "full_disk", "unwritable", "vanishing", "memory", "joint_memory"),
    Sweeps: ("sweep", "sweep_files", "sweep_disk"),
    Trainings: ("training", "training_disk"),
}
ALL = [part for parts in PARTS.values() for part in parts]


def words_of(known):
    def parse(text):
        for word in text.split(","):
            if word not in known:
                raise argparse.ArgumentTypeError(f"{word}: expected some of {', '.join(known)}")
        return text.split(",")
    return parse


def table(rows):
    return "| fault | times | end |\n|---|---|---|\n" + "".join(
        "| " + " | ".join(str(c) for c in row) + " |\n" for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    parser.add_argument("--kills", type=int, default=50, help="of the solver at any moment")
    parser.add_argument("--writing-kills", type=int, default=20, help="of the solver while it writes results")
    parser.add_argument("--sweep-kills", type=int, default=8)
    parser.add_argument("--training-kills", type=int, default=20)
    parser.add_argument("--kinds", type=words_of(KINDS), default=list(KINDS),
                        help="of problems, by turns: " + ",".join(KINDS))
    parser.add_argument("--seed", type=int, default=1, help="of the random moments")
    parser.add_argument("--table", type=pathlib.Path, help="file for the table")
    parser.add_argument("--only", type=words_of(ALL), default=ALL, help="parts: " + ",".join(ALL))
    args = parser.parse_args()
    args.bin = args.bin.absolute()
    rows, failed = [], False
    for study, parts in PARTS.items():
        chosen = [part for part in parts if part in args.only]
        if not chosen:
            continue
        faults = study(args, rows)
        try:
            for part in chosen:
                getattr(faults, part)()
                if args.table is not None:
                    args.table.write_text(table(rows))
        finally:
            faults.close()
        failed = failed or bool(faults.failures)
    print(table(rows))
    sys.exit(failed)


if __name__ == "__main__":
    main()
