#!/usr/bin/env python3
"""Does the program find materials that nobody labelled, and leave one material one?

    experiments/labels/auto.py LABELS CASES TABLES MODELS OUT [--bin DIR] [--only I/N] [--labels-only]

LABELS: OUT of labels.py, spheres of several materials, solved with their labels given. CASES: the folder `cases` of
`ibrdf_bench render-inputs`, spheres of one. The others as in labels.py. Both are solved with `labels: auto`; a row of
OUT/auto_I.csv for each, as it finishes; the same command goes on where it was stopped. --only: each N-th, from the I-th
(0 of 1). --labels-only: every solve ends once its labels are found. Needs Debian's python3-opencv.

right: the share of the sphere's pixels that have their label, by the best naming. gain: nats by which the image is more
probable than of one material fewer. gain_of_more: of one more. auto, given: aligned log-RMSE of the BRDFs, in the mean
over the materials, with labels that were found and with true ones. Of one material the solve ends once its labels are
found.
"""
import itertools
import json
import signal
import subprocess

import cv2
import numpy as np

from labels import NO_IMPROVEMENT, OBJECTS, SPHERES, Labels, Table, copy_image, parser_of

INTERRUPTED = 130  # exit status
COLUMNS = ["case", "materials", "found", "right", "gain", "gain_of_more", "auto", "given", "seconds"]
# Of the images of one material: those that the model of fold 0 has not seen; that of fold 1 has not seen the others.
FIRST_FOLD = {"pink-jasper", "green-plastic", "aluminium", "white-marble", "black-oxidized-steel", "red-plastic",
              "blue-metallic-paint2", "nickel", "specular-green-phenolic", "green-latex"}


def overlap(found, truth):
    """Pixels by their labels, the found ones in rows; -1: no label."""
    seen = found >= 0
    return np.array([[((found == f) & (truth == t) & seen).sum() for t in np.unique(truth[seen])]
                     for f in np.unique(found[seen])])


def share_right(table):
    size = max(table.shape)
    padded = np.zeros((size, size), int)
    padded[:table.shape[0], :table.shape[1]] = table
    return max(padded[range(size), order].sum() for order in itertools.permutations(range(size))) / table.sum()


class Auto(Labels):
    def find(self, source, folder, fold, whole):
        """The result of an image with `labels: auto`; not whole: the solve ends once its labels are found."""
        copy_image(source, folder)
        program = subprocess.Popen(self.command(folder, fold, "labels: auto"), stdout=subprocess.PIPE,
                                   stderr=subprocess.DEVNULL, text=True)
        for line in program.stdout:
            # A stage after those that look for labels.
            if " % " in line and "misfit" in line and "labels:" not in line and not whole:
                program.send_signal(signal.SIGINT)
                whole = True
        if program.wait() not in (0, NO_IMPROVEMENT, INTERRUPTED):
            raise RuntimeError(f"{folder}: exit status {program.returncode}")
        return json.loads((folder / "out" / "result.json").read_text())

    @staticmethod
    def row(case, materials, result, right="", errors=("", "")):
        found = result["labels_found"]
        gains = ["" if found[name] is None else f"{found[name]:.0f}" for name in ("gain_nats", "gain_of_more_nats")]
        return [case, materials, len(result["materials"]), right, *gains, *errors, f"{result['metrics']['seconds']:.0f}"]

    def several(self, case, fold, materials):
        given, folder = self.arguments.labels / case, self.arguments.out / case
        whole = not self.arguments.labels_only
        result = self.find(given, folder, fold, whole)
        truth = cv2.imread(str(given / "labels.png"), cv2.IMREAD_GRAYSCALE)
        picture = cv2.imread(str(folder / "out" / "labels.png"))[..., ::-1]
        found = np.full(truth.shape, -1)
        for k, material in enumerate(result["materials"]):
            found[(picture == material["srgb_in_labels_png"]).all(-1)] = k
        table = overlap(found, truth)
        right = f"{share_right(table):.3f}"
        if not whole:
            return self.row(case, len(materials), result, right)
        errors = []
        for k, material in enumerate(materials):
            # Of the label that has most of the material's pixels.
            label = result["materials"][table[:, k].argmax()]["label"]
            errors.append([self.brdf_error(folder / "out" / f"brdf_{label}.binary", material),
                           self.brdf_error(given / "out" / f"brdf_{40 * (k + 1)}.binary", material)])
        return self.row(case, len(materials), result, right, [f"{e:.3f}" for e in np.mean(errors, 0)])

    def one(self, case):
        fold = 0 if case.rsplit("_", 1)[0] in FIRST_FOLD else 1
        return self.row(case, 1, self.find(self.arguments.cases / case, self.arguments.out / "one" / case, fold, whole=False))


def main():
    parser = parser_of(__doc__, ("labels", "cases", "tables", "models", "out"))
    parser.add_argument("--only", default="0/1")
    parser.add_argument("--labels-only", action="store_true")
    arguments = parser.parse_args()
    index, count = map(int, arguments.only.split("/"))
    auto = Auto(arguments)
    jobs = [(f"{light}_{number}", lambda case, fold=fold, four=four, members=members:
             auto.several(case, fold, [four[m] for m in members]))
            for number, (members, _) in enumerate(SPHERES) for light, (fold, four) in OBJECTS.items()]
    jobs += [(folder.name, auto.one) for folder in sorted(arguments.cases.iterdir())]
    table = Table(arguments.out / f"auto_{index}.csv", COLUMNS)
    for case, job in jobs[index::count]:
        if table.has(case):
            continue
        row = job(case)
        table.add([row])
        print(",".join(map(str, row)), flush=True)


if __name__ == "__main__":
    main()
