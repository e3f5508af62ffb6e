#!/usr/bin/env python3
"""Statistics of log radiance of environment maps, from which the illumination prior takes its scales.

usage: light_statistics.py MAPS_DIR [--leave-out A,B,...] [--width 64]
For every Radiance .hdr map (averaged to WIDTH x WIDTH/2): the mean over texels, weighted by solid angle, of
|l_i - l_j| / sqrt(angle) for neighbours along a row; the root mean square of the same; the mean log radiance of
red and blue less that of green; the standard deviation of log radiance. Then the semivariograms of grey log radiance and
of chroma (half the mean square of differences; chroma per dimension of its plane) over angles, at 32x16; and, map by
map, the variance of grey log radiance inside the texels of 32x16: mean, quantiles and medians by elevation. needs numpy
"""
import argparse
import pathlib

import numpy as np


def read_rgbe(path):
    """[H, W, 3] radiance of a new-RLE Radiance file with rows from the top."""
    data = path.read_bytes()
    start = data.index(b"\n\n") + 2
    end = data.index(b"\n", start)
    _, height, _, width = data[start:end].split()
    height, width = int(height), int(width)
    code = np.frombuffer(data, np.uint8, offset=end + 1)
    rgbe = np.zeros((height, width, 4), np.uint8)
    at = 0
    for y in range(height):
        at += 4
        for channel in range(4):
            x = 0
            while x < width:
                count = int(code[at])
                at += 1
                if count > 128:
                    count -= 128
                    rgbe[y, x:x + count, channel] = code[at]
                    at += 1
                else:
                    rgbe[y, x:x + count, channel] = code[at:at + count]
                    at += count
                x += count
    return rgbe[..., :3] * np.exp2(rgbe[..., 3:].astype(float) - 136)


def add_arguments(parser):
    parser.add_argument("maps", type=pathlib.Path)
    parser.add_argument("--leave-out", default="city,studio,forest,night,lobby", help="maps that experiments test on")


def environment_maps(args):
    """(name, radiance [H, W, 3]) of every map that is not left out."""
    left_out = set(args.leave_out.split(","))
    for path in sorted(args.maps.glob("*.hdr")):
        if path.stem not in left_out:
            yield path.stem, read_rgbe(path)


def log_radiance(radiance):
    return np.log(radiance + 1e-6 * radiance.max())


def averaged_log_radiance(radiance, width):
    """Of a map averaged to [width / 2, width, 3]."""
    height, factor = width // 2, radiance.shape[1] // width
    return log_radiance(radiance.reshape(height, factor, width, factor, 3).mean((1, 3)))


def statistics(radiance, width):
    height = width // 2
    log = averaged_log_radiance(radiance, width)
    sine = np.sin(np.pi * (np.arange(height) + 0.5) / height)
    weight = (sine / sine.mean())[:, None, None]
    mean = (log * weight).mean((0, 1))
    return mean[0] - mean[1], mean[2] - mean[1], np.sqrt((((log - mean) ** 2) * weight).mean())


ANGLES = np.array([8, 14, 20, 30, 45, 60, 80, 100, 130, 180.01])


def semivariograms(radiance):
    """Of grey (mean of channels) and of chroma, per bin of ANGLES, degrees."""
    height, width = 16, 32
    log = averaged_log_radiance(radiance, width).reshape(-1, 3)
    theta = np.pi * (np.arange(height) + 0.5) / height
    phi = 2 * np.pi * (np.arange(width) + 0.5) / width
    t, p = np.meshgrid(theta, phi, indexing="ij")
    d = np.stack([np.sin(t) * np.sin(p), np.cos(t), np.sin(t) * np.cos(p)], -1).reshape(-1, 3)
    angle = np.degrees(np.arccos(np.clip(d @ d.T, -1, 1)))
    weight = np.outer(d[:, 0] ** 2 + d[:, 2] ** 2, d[:, 0] ** 2 + d[:, 2] ** 2) ** 0.5
    grey = log.mean(1)
    chroma = log - grey[:, None]
    squares = [(grey[:, None] - grey) ** 2 / 2, sum((chroma[:, None, c] - chroma[None, :, c]) ** 2 for c in range(3)) / 4]
    bins = [(angle >= a) & (angle < b) for a, b in zip(ANGLES, ANGLES[1:])]
    return np.array([[(s * weight)[k].sum() / weight[k].sum() for k in bins] for s in squares])


def variances_inside(radiance):
    """Of grey log radiance inside each texel of 32x16 [16, 32], and the texels' solid angles."""
    height, width = 16, 32
    log = log_radiance(radiance).mean(2)
    factor = radiance.shape[1] // width
    inside = log.reshape(height, factor, width, factor).var((1, 3))
    sine = np.sin(np.pi * (np.arange(height) + 0.5) / height)
    return inside, np.repeat(sine[:, None], width, 1)


def quantile(values, weights, share):
    order = np.argsort(values.ravel())
    cumulative = np.cumsum(weights.ravel()[order])
    return values.ravel()[order][np.searchsorted(cumulative, share * cumulative[-1])]


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(ap)
    ap.add_argument("--width", type=int, default=64)
    args = ap.parse_args()
    maps = dict(environment_maps(args))
    rows = []
    print(f"{'map':28s} {'red-green':>10s} {'blue-green':>11s} {'std':>6s}")
    for name, radiance in maps.items():
        rows.append(statistics(radiance, args.width))
        print(f"{name:28s} {rows[-1][0]:10.2f} {rows[-1][1]:11.2f} {rows[-1][2]:6.2f}")
    r = np.array(rows)
    print(f"{'mean (chroma: rms)':28s} {np.sqrt((r[:, 0] ** 2).mean()):10.2f} "
          f"{np.sqrt((r[:, 1] ** 2).mean()):11.2f} {r[:, 2].mean():6.2f}")
    mean = np.mean([semivariograms(radiance) for radiance in maps.values()], 0)
    middle = (ANGLES[:-1] + ANGLES[1:]) / 2
    print("angle, degrees         " + "".join(f"{a:7.0f}" for a in middle))
    print("grey                   " + "".join(f"{v:7.2f}" for v in mean[0]))
    # LightProcess at roughness 1: its two parts.
    x = 2 * np.sin(np.radians(middle) / 2) / np.radians(40)
    process = 0.75 * (1 - (1 + x) * np.exp(-x)) + 0.375 * (1 - np.exp(-middle / 20))
    print("1.6 LightProcess       " + "".join(f"{1.6 * v:7.2f}" for v in process))
    print("chroma                 " + "".join(f"{v:7.3f}" for v in mean[1]))
    print("0.12 (the same)        " + "".join(f"{0.12 * v:7.3f}" for v in process))
    print(f"{'inside texels of 11 degrees':28s} {'mean':>7s} {'10 %':>7s} {'median':>7s} {'90 %':>7s} "
          f"{'above':>7s} {'horizon':>7s} {'below':>7s}")
    for name, radiance in maps.items():
        v, w = variances_inside(radiance)
        figures = [(v * w).sum() / w.sum()] + [quantile(v, w, share) for share in (0.1, 0.5, 0.9)]
        figures += [quantile(v[band], w[band], 0.5) for band in (slice(0, 5), slice(6, 10), slice(11, 16))]
        print(f"{name:28s} " + " ".join(f"{f:7.3f}" for f in figures))


if __name__ == "__main__":
    main()
