#!/usr/bin/env python3
"""Light maps of too much and too little contrast, 512x256: no photographs, and none that a test has.

usage: softboxes.py OUT_DIR [--square-roots MAP.hdr ...]

softa.hdr and softb.hdr: lamps with edges in dim rooms. Walls have smooth and blocky variations of log radiance and a
floor; lamps are rectangles of 12 to 60 degrees, 100 to 1000 times brighter. evena.hdr and evenb.hdr: the same with
windows and lamps a few times brighter than the walls. --square-roots: OUT_DIR/MAP05.hdr, with the root of each texel's
mean of the channels, and its hue. needs numpy
"""
import argparse
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "light_statistics"))
from light_statistics import read_rgbe

HEIGHT, WIDTH = 256, 512


def directions():
    theta = np.pi * (np.arange(HEIGHT) + 0.5) / HEIGHT
    phi = 2 * np.pi * (np.arange(WIDTH) + 0.5) / WIDTH
    t, p = np.meshgrid(theta, phi, indexing="ij")
    return np.stack([np.sin(t) * np.sin(p), np.cos(t), np.sin(t) * np.cos(p)], -1)


def waves(rng, d, frequency, amplitude):
    field = np.zeros((HEIGHT, WIDTH))
    for _ in range(60):
        k = rng.normal(size=3) * frequency
        field += np.cos(d @ k + rng.uniform(0, 6.28))
    return amplitude * field / np.sqrt(30)


def room(rng, d, ambient, floor):
    wall = np.exp(sum(waves(rng, d, f, a) for f, a in ((3, 0.35), (9, 0.25), (30, 0.15))))
    for _ in range(25):  # blocks: furniture, pictures
        c = rng.normal(size=3)
        c /= np.linalg.norm(c)
        c[1] *= 0.5
        a = rng.normal(size=3)
        a -= a @ c * c
        a /= np.linalg.norm(a)
        b = np.cross(c, a)
        inside = (d @ c > 0) & (np.abs(d @ a) < rng.uniform(0.05, 0.3)) & (np.abs(d @ b) < rng.uniform(0.05, 0.3))
        wall[inside] *= np.exp(rng.normal() * 0.6)
    radiance = ambient * wall[..., None] * np.array([1, 0.95, 0.85])
    radiance[d[..., 1] < -0.45] *= floor
    return radiance


def add_lamp(radiance, d, azimuth, elevation, width, height, brightness, colour):
    """Angles in degrees."""
    az, el = np.radians(azimuth), np.radians(elevation)
    c = np.array([np.cos(el) * np.sin(az), np.sin(el), np.cos(el) * np.cos(az)])
    a = np.cross([0, 1, 0], c)
    a /= np.linalg.norm(a)
    b = np.cross(c, a)
    z = d @ c
    u, v = np.degrees(np.arctan2(d @ a, z)), np.degrees(np.arctan2(d @ b, z))

    def edge(x):
        return 1 / (1 + np.exp(-np.clip(x / 0.6, -50, 50)))

    share = edge(width / 2 - np.abs(u)) * edge(height / 2 - np.abs(v)) * (z > 0)
    radiance += share[..., None] * brightness * np.array(colour)


def write_hdr(path, radiance):
    """Radiance RGBE, new run-length encoding without runs."""
    largest = radiance.max(-1)
    exponent = np.ceil(np.log2(np.maximum(largest, 1e-30)))
    mantissa = np.floor(radiance / np.exp2(exponent)[..., None] * 255.999).clip(0, 255).astype(np.uint8)
    biased = (exponent + 128).clip(0, 255).astype(np.uint8)
    out = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH)
    for y in range(HEIGHT):
        out += bytes([2, 2, WIDTH >> 8, WIDTH & 255])
        for channel in (*mantissa[y].T, biased[y]):
            for x in range(0, WIDTH, 128):
                out += bytes([128]) + channel[x:x + 128].tobytes()
    path.write_bytes(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--square-roots", nargs="+", type=pathlib.Path, default=[])
    args = parser.parse_args()
    out = args.out
    out.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(5)
    d = directions()
    radiance = room(rng, d, 0.03, 0.6)
    add_lamp(radiance, d, 50, 35, 35, 50, 20, [1, 1, 1])
    add_lamp(radiance, d, -70, 20, 25, 40, 8, [1, 0.95, 0.9])
    write_hdr(out / "softa.hdr", radiance)
    radiance = room(rng, d, 0.05, 1.2)
    add_lamp(radiance, d, -30, 55, 22, 22, 60, [1, 0.9, 0.75])
    add_lamp(radiance, d, 100, 40, 12, 60, 25, [0.8, 0.9, 1])
    add_lamp(radiance, d, 200, 15, 30, 40, 5, [1, 1, 1])
    write_hdr(out / "softb.hdr", radiance)
    rng = np.random.default_rng(11)
    radiance = room(rng, d, 0.3, 0.7)
    add_lamp(radiance, d, 20, 15, 50, 40, 0.9, [1, 1, 1.05])
    add_lamp(radiance, d, 110, 10, 40, 50, 0.6, [1, 0.95, 0.9])
    add_lamp(radiance, d, -90, 20, 60, 30, 0.8, [1, 1, 1])
    add_lamp(radiance, d, 180, 70, 50, 50, 0.5, [1, 0.9, 0.8])
    write_hdr(out / "evena.hdr", radiance)
    radiance = room(rng, d, 0.4, 0.5) * np.array([1, 0.85, 0.7])
    add_lamp(radiance, d, -40, 25, 30, 60, 1.5, [1, 1, 1.1])
    add_lamp(radiance, d, 60, 60, 14, 14, 2.5, [1, 0.9, 0.7])
    add_lamp(radiance, d, -120, 60, 14, 14, 2.5, [1, 0.9, 0.7])
    add_lamp(radiance, d, 150, 20, 60, 40, 0.7, [0.9, 1, 1])
    write_hdr(out / "evenb.hdr", radiance)
    for path in args.square_roots:
        radiance = read_rgbe(path)
        mean = np.maximum(radiance.mean(-1, keepdims=True), 1e-6)
        write_hdr(out / f"{path.stem}05.hdr", radiance / mean * np.sqrt(mean))


if __name__ == "__main__":
    main()
