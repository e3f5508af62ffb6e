#!/usr/bin/env python3
"""What a step at the horizon is worth to the illumination's prior.

usage: horizon.py MAPS_DIR [--leave-out A,B,...]
For every Radiance .hdr map, averaged to 32x16: by how many nats the log radiance is more probable under LightProcess
(solvers/priors/light_process.h) with a horizon_share than without one, at the most probable scales (amplitude and
roughness) of each; in brackets where the step is scaled by the amplitude as the rest is. needs numpy
"""
import argparse

import numpy as np

from light_statistics import add_arguments, averaged_log_radiance, environment_maps

HEIGHT, WIDTH = 16, 32
SHARES = [0.15, 0.3, 0.6, 1.2, 2.4]
# LightProcess and LightScales.
LUMINANCE, CHROMA, LEVEL, LEVEL_CHROMA = 1.6, 0.12, 4.0, 0.12
ZENITH = [40, 75, 103, 140]
AMPLITUDE_STD = 0.7
ROUGHNESS_MEAN = np.array([-1.2, 0.0, -0.2, -0.8])
ROUGHNESS_STD = np.array([1.2, 0.5, 0.5, 0.6])


class Process:
    def __init__(self):
        zenith = np.repeat(180 * (np.arange(HEIGHT) + 0.5) / HEIGHT, WIDTH)
        azimuth = np.tile(2 * np.pi * (np.arange(WIDTH) + 0.5) / WIDTH, HEIGHT)
        sine = np.sin(np.radians(zenith))
        d = np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(np.radians(zenith))], -1)
        cosine = np.clip(d @ d.T, -1, 1)
        np.fill_diagonal(cosine, 1)
        x = np.sqrt(2 - 2 * cosine) / np.radians(40)
        self.smooth = 0.75 * (1 + x) * np.exp(-x)
        self.rough = 0.375 * np.exp(-np.degrees(np.arccos(cosine)) / 20)
        self.bands = np.stack([np.interp(zenith, ZENITH, e) for e in np.eye(4)])
        step = np.where(zenith < 90, 0.5, -0.5)
        self.step = np.outer(step, step)

    def cost(self, axes, y, share, scaled):
        """-log p of the map's colour axes [texels, 3] and of the whitened scales, nats up to a constant."""
        amplitude = np.exp(AMPLITUDE_STD * y[0])
        s = np.exp((ROUGHNESS_MEAN + ROUGHNESS_STD * y[1:]) @ self.bands)
        c = amplitude * (self.smooth + s[:, None] * s * self.rough) + share * (amplitude if scaled else 1) * self.step
        total = y @ y / 2
        # Along grey, a sum of channels over sqrt(3), luminance counts three times.
        for k, (local, level) in enumerate(((3 * LUMINANCE, 3 * LEVEL), (CHROMA, LEVEL_CHROMA))):
            factor = np.linalg.cholesky(local * c + level + 1e-6 * np.eye(len(c)))
            values = axes[:, :1] if k == 0 else axes[:, 1:]
            white = np.linalg.solve(factor, values)
            total += (white**2).sum() / 2 + values.shape[1] * np.log(np.diag(factor)).sum()
        return total

    def lowest_cost(self, axes, share, scaled=False):
        """By Newton steps with a diagonal Hessian, from differences."""
        y, h = np.zeros(5), 0.05
        best = self.cost(axes, y, share, scaled)
        for _ in range(25):
            sides = [[self.cost(axes, y + h * s * e, share, scaled) for s in (1, -1)] for e in np.eye(5)]
            gradient = np.array([(a - b) / (2 * h) for a, b in sides])
            curvature = np.array([max((a + b - 2 * best) / h**2, 0.3) for a, b in sides])
            for halvings in range(10):
                at = y - gradient / curvature / 2**halvings
                cost = self.cost(axes, at, share, scaled)
                if cost < best:
                    break
            else:
                return best
            gain, best, y = best - cost, cost, at
            if gain < 0.01:
                break
        return best


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(ap)
    args = ap.parse_args()
    process = Process()
    axes = np.array([[1, 1, 1], [1, -1, 0], [1, 1, -2]]) / np.sqrt([[3], [2], [6]])
    total = 0
    print(f"{'horizon_share':24s}" + "".join(f"{s:15.2f}" for s in SHARES))
    for name, radiance in environment_maps(args):
        log = averaged_log_radiance(radiance, WIDTH).reshape(-1, 3) @ axes.T
        without = process.lowest_cost(log, 0)
        gains = without - np.array([[process.lowest_cost(log, s, scaled) for s in SHARES] for scaled in (False, True)])
        total = total + gains
        print(f"{name:24s}" + "".join(f"{a:7.1f} ({b:5.1f})" for a, b in gains.T), flush=True)
    print(f"{'all':24s}" + "".join(f"{a:7.1f} ({b:5.1f})" for a, b in total.T))


if __name__ == "__main__":
    main()
