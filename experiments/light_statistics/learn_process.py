#!/usr/bin/env python3
"""How probable the light process makes maps that it has not seen, with its constants and with learned ones.

usage: learn_process.py MAPS_DIR
MAPS_DIR holds .hdr maps and index.csv (columns name, class, group). Each map is averaged to 32x16. Texels more than 2
above the median around them, in grey log radiance, are lowered to it: the solver has directional lights for those. What
differs from map to map (LightHyperparameters) is integrated out by Laplace's method. Constants are learned on half of
the places by expectation maximisation, and the other half is scored; then the other way round. A score is -log
probability density, nats per texel: less is better. Four minutes of one core. needs numpy
"""
import argparse
import csv
import pathlib

import numpy as np

from light_statistics import averaged_log_radiance, read_rgbe

HEIGHT, WIDTH = 16, 32
ZENITH = [40, 75, 103, 140]
# As light_process.h.
CONSTANTS = {"smooth_share": 0.75, "smooth_degrees": 40.0, "rough_share": 0.375, "rough_degrees": 20.0,
             "horizon_share": 0.6, "luminance_variance": 1.6, "chroma_variance": 0.12, "level_variance": 4.0,
             "level_chroma_variance": 0.12}
# Log amplitude, then log roughness by elevation; perhaps a log amplitude of chroma.
MEAN = np.array([0.0, -1.2, 0.0, -0.2, -0.8])
STD = np.array([0.7, 1.2, 0.5, 0.5, 0.6])
CHROMA = 5  # the index of the last
LEARNED = [name for name in CONSTANTS if name != "level_variance"]  # no map tells the variance of levels
NUGGET = {"grey": 1e-3, "chroma": 5e-5}


class Geometry:
    """What is the same for all maps. Covariances are stationary along a row: orders of its Fourier transform part."""

    def __init__(self):
        theta = np.pi * (np.arange(HEIGHT) + 0.5) / HEIGHT
        turn = 2 * np.pi * np.arange(WIDTH) / WIDTH
        cosine, sine = np.cos(theta), np.sin(theta)
        dot = cosine[:, None, None] * cosine[:, None] + (sine[:, None, None] * sine[:, None]) * np.cos(turn)
        dot = np.clip(dot, -1, 1)
        self.angle = np.degrees(np.arccos(dot))
        self.angle[np.arange(HEIGHT), np.arange(HEIGHT), 0] = 0
        self.chord = np.degrees(np.sqrt(np.maximum(2 - 2 * dot, 0)))
        self.step = np.where(np.arange(HEIGHT) < HEIGHT // 2, 0.5, -0.5)
        at = np.clip(np.degrees(theta), ZENITH[0], ZENITH[-1])
        self.roughness_weights = np.array([np.interp(at, ZENITH, band) for band in np.eye(4)])
        self.times = np.array([1] + [2] * (WIDTH // 2 - 1) + [1])  # an order counts

    def kernels(self, constants):
        """The smooth and the rough kernel by order [orders, rows, rows]."""
        x = self.chord / constants["smooth_degrees"]
        both = (1 + x) * np.exp(-x), np.exp(-self.angle / constants["rough_degrees"])
        return [np.fft.rfft(k, axis=2).real.transpose(2, 0, 1) for k in both]


GEOMETRY = Geometry()
COLOUR_AXES = np.array([[1, 1, 1], [1, -1, 0], [1, 1, -2]]) / np.sqrt([[3], [2], [6]])


def without_directional_lights(log):
    grey = log.mean(2)
    padded = np.pad(np.pad(grey, ((1, 1), (0, 0)), mode="edge"), ((0, 0), (1, 1)), mode="wrap")
    shifts = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    around = np.median([padded[i:i + HEIGHT, j:j + WIDTH] for i, j in shifts], 0)
    return log - np.where(grey - around > 2.0, grey - around, 0.0)[..., None]


def load(folder):
    maps = []
    for row in csv.DictReader(open(folder / "index.csv")):
        log = without_directional_lights(averaged_log_radiance(read_rgbe(folder / f"{row['name']}.hdr"), WIDTH))
        waves = np.fft.rfft(log @ COLOUR_AXES.T, axis=1) / np.sqrt(WIDTH)
        maps.append({"kind": row["class"], "place": row["group"] or row["name"], "waves": waves.transpose(1, 0, 2)})
    return maps


def cost(waves, constants, kernels, hyper):
    """-log likelihood of a map, nats."""
    s = np.exp(hyper[1:5] @ GEOMETRY.roughness_weights)
    correlation = constants["smooth_share"] * kernels[0] + constants["rough_share"] * kernels[1] * np.outer(s, s)
    horizon, level = np.zeros_like(correlation), np.zeros_like(correlation)
    horizon[0] = WIDTH * constants["horizon_share"] * np.outer(GEOMETRY.step, GEOMETRY.step)
    level[0] = WIDTH
    amplitude = np.exp(hyper[0])
    grey = 3 * constants["luminance_variance"] * (amplitude * correlation + horizon)
    grey += 3 * constants["level_variance"] * level + NUGGET["grey"] * np.eye(HEIGHT)
    if len(hyper) > CHROMA:
        chroma = np.exp(hyper[CHROMA]) * (correlation + horizon)
    else:
        chroma = amplitude * correlation + horizon
    chroma = constants["chroma_variance"] * chroma + constants["level_chroma_variance"] * level
    chroma += NUGGET["chroma"] * np.eye(HEIGHT)
    total = 0.0
    for covariance, axes in ((grey, [0]), (chroma, [1, 2])):
        factor = np.linalg.cholesky(covariance)
        white = np.linalg.solve(factor, waves[:, :, axes])
        log_det = 2 * np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(1) + HEIGHT * np.log(2 * np.pi)
        total += 0.5 * GEOMETRY.times @ ((np.abs(white) ** 2).sum((1, 2)) + len(axes) * log_det)
    return total


def derivatives(function, y, step=0.05):
    """Value, gradient and Hessian by central differences."""
    n, value = len(y), function(y)
    moves = step * np.eye(n)
    up, down = [np.array([function(y + sign * move) for move in moves]) for sign in (1, -1)]
    hessian = np.diag((up + down - 2 * value) / step ** 2)
    for i in range(n):
        for j in range(i):
            both = function(y + moves[i] + moves[j])
            hessian[i, j] = hessian[j, i] = (both - up[i] - up[j] + value) / step ** 2
    return value, (up - down) / (2 * step), hessian


def fit(waves, constants, kernels, mean, std, y):
    """(mode of the whitened hyperparameters, their covariance, -log evidence)."""
    def whitened_cost(y):
        return cost(waves, constants, kernels, mean + std * y) + 0.5 * y @ y
    for _ in range(8):
        value, gradient, hessian = derivatives(whitened_cost, y)
        values, vectors = np.linalg.eigh(hessian)
        hessian = vectors @ np.diag(np.maximum(np.abs(values), 0.3)) @ vectors.T
        move = -np.linalg.solve(hessian, gradient)
        move *= min(1.0, 2.0 / np.abs(move).max())
        length = 1.0
        while length > 0.05 and not whitened_cost(y + length * move) < value:
            length /= 2
        if length <= 0.05:
            break
        y = y + length * move
        if -(gradient @ move) < 0.02:
            break
    evidence = whitened_cost(y) + 0.5 * np.linalg.slogdet(hessian)[1]
    return y, np.linalg.inv(hessian), evidence


def fit_all(maps, constants, mean, std, starts=None):
    kernels = GEOMETRY.kernels(constants)
    starts = np.zeros((len(maps), len(mean))) if starts is None else starts
    return [fit(m["waves"], constants, kernels, mean, std, y) for m, y in zip(maps, starts)]


def descend(maps, constants, hyper, names):
    """A step of the constants, in their logarithms, at these hyperparameters."""
    def total(c):
        kernels = GEOMETRY.kernels(c)
        return sum(cost(m["waves"], c, kernels, h) for m, h in zip(maps, hyper))
    def moved(by):
        return constants | {name: constants[name] * np.exp(b) for name, b in zip(names, by)}
    base, moves = total(constants), 0.05 * np.eye(len(names))
    up, down = [np.array([total(moved(sign * move)) for move in moves]) for sign in (1, -1)]
    slope = (up - down) / 0.1
    curvature = np.maximum((up + down - 2 * base) / 0.0025, np.abs(slope) / 0.5)
    length = 1.0
    while length > 0.05:
        trial = moved(-length * slope / curvature)
        if total(trial) < base:
            return trial
        length /= 2
    return constants


def learn(maps, names, hyperprior, own_chroma, turns=4):
    """(constants, mean, std) of these maps. hyperprior: whether mean and std are learned too."""
    constants, mean, std = dict(CONSTANTS), MEAN, STD
    if own_chroma:
        mean, std = np.append(mean, 0.0), np.append(std, 1.0)
    amplitudes = [0, CHROMA] if own_chroma else [0]
    # Roughness below exp(-3) is none: there its logarithm is not told.
    least_told = np.full(len(mean), -9.0)
    least_told[1:5] = -3.0
    starts = None
    for _ in range(turns):
        fits = fit_all(maps, constants, mean, std, starts)
        hyper = np.array([mean + std * y for y, _, _ in fits])
        if hyperprior:
            told = np.maximum(hyper, least_told)
            variance = np.array([np.minimum(np.diag(c) * std ** 2, 0.5) for _, c, _ in fits])
            mean = told.mean(0)
            std = np.sqrt(((told - mean) ** 2 + variance).mean(0))
        for _ in range(2):
            constants = descend(maps, constants, hyper, names)
        # Amplitudes are 1 in the mean; the variances have the rest.
        shift = np.zeros_like(mean)
        shift[amplitudes] = mean[amplitudes]
        constants["luminance_variance"] *= np.exp(shift[0])
        constants["horizon_share"] /= np.exp(shift[0])
        constants["chroma_variance"] *= np.exp(shift[amplitudes[-1]])
        mean = mean - shift
        starts = (hyper - shift - mean) / std
    return constants, mean, std


VARIANTS = {
    "variances of chroma": {"names": ["chroma_variance", "level_chroma_variance"], "hyperprior": False, "own_chroma": False},
    "constants": {"names": LEARNED, "hyperprior": False, "own_chroma": False},
    "constants and hyperprior": {"names": LEARNED, "hyperprior": True, "own_chroma": False},
    "an amplitude of chroma, and constants": {"names": LEARNED, "hyperprior": False, "own_chroma": True},
    "the same and hyperprior": {"names": LEARNED, "hyperprior": True, "own_chroma": True},
}


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("maps", type=pathlib.Path)
    maps = load(ap.parse_args().maps)
    texels = HEIGHT * WIDTH
    today = np.array([f[2] for f in fit_all(maps, CONSTANTS, MEAN, STD)]) / texels
    print(f"{len(maps)} maps; as light_process.h: {today.mean():.4f} nats per texel")
    places = sorted({m["place"] for m in maps})
    half = np.array([places.index(m["place"]) % 2 for m in maps])
    kinds = np.array([m["kind"] for m in maps])
    for name, variant in VARIANTS.items():
        held_out = np.zeros(len(maps))
        for k in range(2):
            constants, mean, std = learn([m for m, h in zip(maps, half) if h != k], **variant)
            fits = fit_all([m for m, h in zip(maps, half) if h == k], constants, mean, std)
            held_out[half == k] = np.array([f[2] for f in fits]) / texels
            print(" ", {n: round(float(constants[n]), 3) for n in variant["names"]}, mean.round(2), std.round(2))
        gain = held_out - today
        print(f"{name}: {held_out.mean():.4f}, better in {(gain < 0).sum()} of {len(maps)};",
              ", ".join(f"{kind} {gain[kinds == kind].mean():.3f}" for kind in sorted(set(kinds))), flush=True)


if __name__ == "__main__":
    main()
