#!/usr/bin/env python3
"""Are materials told from one picture of a sphere alone, before its light is known? A trial outside the program.

    experiments/labels/segment.py LABELS [CASES]

LABELS: OUT of labels.py. CASES: the folder `cases` of `ibrdf_bench render-inputs`, spheres of one material. Prints a row
for each picture: the number of materials, the number found, and the share of the pixels that are labelled right when the
number is given, by regions alone and at the end. Needs Debian's python3-opencv.

Each material's log radiance is a polynomial of the normal with noise of its own (a mixture of regressions). Regions
without sharp edges are merged while that makes the picture more probable, polynomial and noise integrated out. Then
pixels are labelled by expectation and maximisation, with neighbours of like colour drawn to one label.
"""
import argparse
import itertools
import math
import os
import pathlib

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402
import numpy as np  # noqa: E402

LEAST_COSINE = 0.2  # to the camera, of pixels that take part
# Settings of the merges whose outcomes are compared: step that parts regions, degree of polynomials, share of the
# pixels that counts as independent.
SETTINGS = list(itertools.product((0.08, 0.12, 0.2), ((1, 0.15), (2, 0.05), (2, 0.5), (3, 0.15))))
COUNTING = (0.12, (2, 0.003))  # where the number of materials is found
LEAST_REGION = 25  # pixels
# Of coefficients over the noise, by degree: the inverse of their prior variances.
PRECISIONS = [0.0025] + 3 * [0.01] + 5 * [0.04] + 7 * [0.08]
# Luminance and two of chroma.
COLOUR_AXES = np.array([[1, 1, 1], [1, -1, 0], [1, 1, -2]]) / np.sqrt([[3], [2], [6]])
PRIOR_NOISE, PRIOR_COUNT = 0.05, 5.0
STUDENT_DEGREES = 4.0
LEAST_NOISE = 0.03
UNARY = 0.15  # weight of a pixel beside its neighbours
NEIGHBOUR, EDGE = 3.0, 0.25


def polynomials(n, degree):
    x, y, z = n.T
    terms = [np.ones_like(x), x, y, z]
    if degree >= 2:
        terms += [x * y, y * z, x * z, x * x - y * y, 3 * z * z - 1]
    if degree >= 3:
        terms += [x**3, y**3, x * x * y, x * y * y, x * x * z, y * y * z, x * y * z]
    return np.stack(terms, 1)


class Pixels:
    """Those of a sphere that take part: log colours, normals, neighbours."""

    def __init__(self, image, mask):
        height, width = mask.shape
        y, x = np.mgrid[0:height, 0:width]
        n = np.stack([2 * (x + 0.5) / width - 1, 1 - 2 * (y + 0.5) / height], -1)
        z = np.sqrt(np.maximum(0, 1 - (n**2).sum(-1)))
        self.use = mask & (z > LEAST_COSINE) & (image.min(-1) > 0)
        self.index = np.full(mask.shape, -1)
        self.index[self.use] = np.arange(self.use.sum())
        self.normals = np.concatenate([n, z[..., None]], -1)[self.use]
        log = np.log(np.maximum(image, 1e-9)).astype(np.float32)
        self.smooth = cv2.bilateralFilter(log, 5, 0.15, 2)
        self.log = log[self.use].astype(float)
        self.colours = self.log @ COLOUR_AXES.T
        self.pairs = np.concatenate([self.pairs_at(dy, dx) for dy, dx in ((0, 1), (1, 0), (1, 1), (1, -1))])
        step = np.abs(self.log[self.pairs[:, 0]] - self.log[self.pairs[:, 1]]).max(1)
        self.alike = NEIGHBOUR * np.exp(-(step / EDGE)**2)

    def pairs_at(self, dy, dx):
        rows, columns = self.index.shape
        first = self.index[:rows - dy, max(0, -dx):columns - max(0, dx)]
        second = self.index[dy:, max(0, dx):columns - max(0, -dx)]
        both = (first >= 0) & (second >= 0)
        return np.stack([first[both], second[both]], 1)

    def regions(self, step):
        """A number for each pixel: of the region whose neighbours differ by less than the step."""
        parent = np.arange(len(self.log))

        def find(i):
            while parent[i] != i:
                parent[i] = parent[parent[i]]
                i = parent[i]
            return i

        smooth = self.smooth[self.use]
        for dy, dx in ((0, 1), (1, 0)):
            pairs = self.pairs_at(dy, dx)
            for i, j in pairs[np.abs(smooth[pairs[:, 0]] - smooth[pairs[:, 1]]).max(1) < step]:
                parent[find(i)] = find(j)
        return np.array([find(i) for i in range(len(parent))])


def log_gamma_3(a):
    return 1.5 * math.log(math.pi) + sum(math.lgamma(a - j / 2) for j in range(3))


def log_evidence(sums):
    """Of colours that are one polynomial with noise: normal inverse Wishart."""
    xx, xy, yy, count = sums
    prior = np.diag(PRECISIONS[:len(xx)])
    noise = np.eye(3) * PRIOR_NOISE**2 * PRIOR_COUNT
    posterior = prior + xx
    mean = np.linalg.solve(posterior, xy)
    left = noise + yy - mean.T @ posterior @ mean
    known = PRIOR_COUNT + count
    return (-1.5 * count * math.log(math.pi) + 1.5 * (np.linalg.slogdet(prior)[1] - np.linalg.slogdet(posterior)[1]) +
            PRIOR_COUNT / 2 * np.linalg.slogdet(noise)[1] - known / 2 * np.linalg.slogdet(left)[1] +
            log_gamma_3(known / 2) - log_gamma_3(PRIOR_COUNT / 2))


def sums_of(x, y, share):
    return [share * x.T @ x, share * x.T @ y, share * y.T @ y, share * len(x)]


def merge(pixels, setting, count=None):
    """Labels of the pixels, -1 in small regions; until `count` are left, or as long as merges gain."""
    step, (degree, share) = setting
    region = pixels.regions(step)
    x, y = polynomials(pixels.normals, degree), pixels.colours - pixels.colours.mean(0)
    members = [[r] for r, n in zip(*np.unique(region, return_counts=True)) if n >= LEAST_REGION]
    sums = [sums_of(x[region == m[0]], y[region == m[0]], share) for m in members]
    evidence = [log_evidence(s) for s in sums]
    gains = np.full((len(sums), len(sums)), -np.inf)

    def gain(i, j):
        gains[min(i, j), max(i, j)] = log_evidence([a + b for a, b in zip(sums[i], sums[j])]) - evidence[i] - evidence[j]

    for i, j in itertools.combinations(range(len(sums)), 2):
        gain(i, j)
    alive = list(range(len(sums)))
    while len(alive) > (count or 1):
        i, j = np.unravel_index(gains.argmax(), gains.shape)
        if count is None and gains[i, j] < 0:
            break
        sums[i] = [a + b for a, b in zip(sums[i], sums[j])]
        evidence[i] = log_evidence(sums[i])
        members[i] += members[j]
        alive.remove(j)
        gains[j, :] = gains[:, j] = -np.inf
        for other in alive:
            if other != i:
                gain(i, other)
    labels = np.full(len(region), -1)
    for label, i in enumerate(alive):
        labels[np.isin(region, members[i])] = label
    return labels, len(alive)


def costs(pixels, shares, degree=2):
    """-log probability of each pixel's colour by each material [pixels, materials], of a Student's t."""
    x, out = polynomials(pixels.normals, degree), np.zeros_like(shares)
    for m in range(shares.shape[1]):
        weights = shares[:, m] + 1e-9
        for _ in range(4):
            xw = x * weights[:, None]
            left = pixels.colours - x @ np.linalg.solve(xw.T @ x + 0.01 * np.eye(x.shape[1]), xw.T @ pixels.colours)
            noise = (left * weights[:, None]).T @ left / weights.sum() + LEAST_NOISE**2 * np.eye(3)
            d = np.einsum("ij,jk,ik->i", left, np.linalg.inv(noise), left)
            weights = (shares[:, m] + 1e-9) * (STUDENT_DEGREES + 3) / (STUDENT_DEGREES + d)
        out[:, m] = 0.5 * ((STUDENT_DEGREES + 3) * np.log1p(d / STUDENT_DEGREES) + np.linalg.slogdet(noise)[1])
    return out


def refine(pixels, labels, count, rounds):
    """Each pixel's label by expectation and maximisation, and the energy that it lessens."""
    shares = np.full((len(labels), count), 0.1 / count)
    shares[labels < 0] = 1.0 / count
    shares[np.flatnonzero(labels >= 0), labels[labels >= 0]] += 0.9
    first, second = pixels.pairs.T
    for _ in range(rounds):
        cost = UNARY * costs(pixels, shares)
        for _ in range(8):
            drawn = np.stack([np.bincount(first, pixels.alike * s[second], len(s)) +
                              np.bincount(second, pixels.alike * s[first], len(s)) for s in shares.T], 1)
            drawn -= cost
            new = np.exp(drawn - drawn.max(1, keepdims=True))
            shares = 0.5 * shares + 0.5 * new / new.sum(1, keepdims=True)
    found = shares.argmax(1)
    return found, (shares * cost).sum() + pixels.alike[found[first] != found[second]].sum()


def share_right(found, truth):
    """Of the pixels, by the best naming of the labels."""
    table = np.array([[((found == f) & (truth == t)).sum() for t in np.unique(truth)] for f in range(found.max() + 1)])
    size = max(table.shape)
    table = np.pad(table, ((0, size - table.shape[0]), (0, size - table.shape[1])))
    return max(table[list(order), range(size)].sum() for order in itertools.permutations(range(size))) / len(found)


def segment(pixels, count):
    """The outcome of least energy, of all settings: its merged labels, and its labels."""
    best = None
    for setting in SETTINGS:
        merged, left = merge(pixels, setting, count)
        if left != count:
            continue
        found, energy = refine(pixels, merged, count, rounds=6)
        if best is None or energy < best[2]:
            best = merged, found, energy
    return best[0], refine(pixels, best[1], count, rounds=15)[0]


def read_pixels(folder):
    image = cv2.imread(str(folder / "input.exr"), cv2.IMREAD_UNCHANGED)[..., ::-1]
    return Pixels(image.astype(float), cv2.imread(str(folder / "mask.png"), 0) > 127)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("labels", type=pathlib.Path)
    parser.add_argument("cases", type=pathlib.Path, nargs="?")
    arguments = parser.parse_args()
    print("case,materials,found,merged_right,right")
    for folder in sorted(path.parent for path in arguments.labels.glob("*/labels.png")):
        pixels = read_pixels(folder)
        truth = cv2.imread(str(folder / "labels.png"), 0)[pixels.use]
        count = len(np.unique(truth))
        merged, found = segment(pixels, count)
        seen = merged >= 0
        print(f"{folder.name},{count},{merge(pixels, COUNTING)[1]},{share_right(merged[seen], truth[seen]):.3f},"
              f"{share_right(found, truth):.3f}", flush=True)
    for folder in sorted(arguments.cases.iterdir()) if arguments.cases else []:
        print(f"{folder.name},1,{merge(read_pixels(folder), COUNTING)[1]},,", flush=True)


if __name__ == "__main__":
    main()
