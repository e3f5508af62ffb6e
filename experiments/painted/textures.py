"""Paint as solid textures: albedo in [0.03, 0.85] as a function of position, so that it wraps around an object.

Each texture takes points [n, 3] of the unit ball and a generator, and returns albedo [n, 3]. Needs Debian's
python3-numpy.
"""
import numpy as np

LEAST, MOST = 0.03, 0.85


def colours(count, rng):
    """Paint colours [count, 3]: lightness spread evenly in the logarithm, some of them nearly grey."""
    lightness = np.exp(np.linspace(np.log(0.08), np.log(0.7), count)) * np.exp(0.15 * rng.standard_normal(count))
    hue = rng.uniform(0, 2 * np.pi, count)
    strength = rng.choice([0.1, 0.5, 0.9], count)
    chroma = np.stack([np.cos(hue), np.cos(hue - 2 * np.pi / 3), np.cos(hue + 2 * np.pi / 3)], -1)
    return rng.permutation(np.clip(lightness[:, None] * np.exp(strength[:, None] * chroma), LEAST, MOST))


def noise(points, rng):
    """Smooth noise in [-1, 1], one feature a unit: random values at whole numbers, blended between."""
    values = rng.uniform(-1, 1, (64, 64, 64))
    cell = np.floor(points).astype(int)
    t = points - cell
    t = t * t * (3 - 2 * t)
    total = np.zeros(len(points))
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(np.array(corner) == 1, t, 1 - t), -1)
        at = (cell + corner) % 64
        total += weight * values[at[:, 0], at[:, 1], at[:, 2]]
    return total


def patches(points, rng):
    """Fields of a few colours with sharp borders: cells of random centres, bent by noise."""
    palette = colours(5, rng)
    centres = rng.uniform(-1, 1, (40, 3))
    bent = points + 0.12 * np.stack([noise(4 * points + 9 * k, rng) for k in range(3)], -1)
    nearest = np.argmin(((bent[:, None] - centres[None])**2).sum(-1), 1)
    return palette[rng.integers(0, len(palette), len(centres))[nearest]]


def gradient(points, rng):
    """Colours that run into each other over the whole object."""
    first, second, third = np.log(colours(3, rng))
    axes = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    u, v = (0.5 + 0.5 * np.sin(1.6 * points @ axes[k] + rng.uniform(-1, 1)) for k in range(2))
    return np.exp(first + u[:, None] * (second - first) + (v * (1 - u))[:, None] * (third - first))


def print_(points, rng):
    """Small sharp shapes on a plain ground: dots, rings and a band."""
    ground, dots, rings, band = colours(4, rng)[np.array([3, 0, 1, 2])]
    albedo = np.tile(ground, (len(points), 1))
    spacing = 0.42
    cell = np.floor(points / spacing)
    at = points / spacing - cell - 0.5
    kind = (cell @ np.array([1, 2, 3])).astype(int) % 3
    radius = np.linalg.norm(at, axis=1)
    albedo[(kind == 0) & (radius < 0.38)] = dots
    albedo[(kind == 1) & (radius < 0.44) & (radius > 0.28)] = rings
    axis = rng.standard_normal(3)
    albedo[np.abs(points @ (axis / np.linalg.norm(axis)) - 0.1) < 0.07] = band
    return albedo


def wood(points, rng):
    """Year rings around an axis, bent by noise, with grain along it."""
    turned = points @ np.linalg.qr(rng.standard_normal((3, 3)))[0] + [0.5, 0.2, 0.0]
    ring = 6 * np.hypot(turned[:, 0], turned[:, 1]) + 0.6 * noise(2.5 * turned, rng)
    late = (ring - np.floor(ring))**2
    grain = noise(turned * [40, 40, 5], rng)
    light = np.array([0.55, 0.36, 0.2]) * np.exp(0.2 * rng.standard_normal(3))
    dark = light * np.array([0.35, 0.27, 0.2])
    return np.clip(light * (dark / light)**late[:, None] * np.exp(0.12 * grain)[:, None], LEAST, MOST)


TEXTURES = {"patches": patches, "gradient": gradient, "print": print_, "wood": wood}
