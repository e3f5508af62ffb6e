#!/usr/bin/env python3
"""How grey measured maps are: the hue of their mean radiance and of their mean log radiance. See README.md."""
import pathlib
import sys

import numpy as np


def read_hdr(path):
    """[H, W, 3] of a Radiance RGBE file whose rows are run-length encoded."""
    data = path.read_bytes()
    at = data.index(b"\n\n") + 2
    end = data.index(b"\n", at)
    words = data[at:end].split()
    height, width = int(words[1]), int(words[3])
    at = end + 1
    texels = np.zeros((height, width, 4), np.uint8)
    for row in texels:
        at += 4
        for channel in range(4):
            x = 0
            while x < width:
                count = data[at]
                at += 1
                if count > 128:
                    row[x:x + count - 128, channel] = data[at]
                    at += 1
                    x += count - 128
                else:
                    row[x:x + count, channel] = np.frombuffer(data[at:at + count], np.uint8)
                    at += count
                    x += count
    return texels[..., :3] * np.exp2(texels[..., 3].astype(int) - 136)[..., None]


def hue(log_mean):
    """The standard deviation of a mean's three logarithms."""
    return float(np.std(log_mean))


def main():
    means, log_means = [], []
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.hdr")):
        light = read_hdr(path)
        theta = np.pi * (np.arange(light.shape[0]) + 0.5) / light.shape[0]
        weights = np.repeat(np.sin(theta), light.shape[1])
        texels = light.reshape(-1, 3)
        means.append(hue(np.log(np.average(texels, axis=0, weights=weights))))
        # Black texels count as a millionth of the mean.
        log_means.append(hue(np.average(np.log(np.maximum(texels, 1e-6 * texels.mean())), axis=0, weights=weights)))
    for name, hues in (("mean radiance", means), ("mean log radiance", log_means)):
        print(f"{name:18} hue's deviation: median {np.median(hues):.3f}, 90 % {np.quantile(hues, 0.9):.3f}, {len(hues)} maps")


if __name__ == "__main__":
    main()
