#!/usr/bin/env python3
"""Writes vase.obj: a profile turned about the y axis, 2 units high."""
import math

ROWS, COLUMNS = 80, 120


def radius(y):
    """Radius at height y in [-1, 1]."""
    return 0.47 + 0.21 * math.cos(3.3 * (y + 0.4))


with open("vase.obj", "w", encoding="ascii") as file:
    for r in range(ROWS + 1):
        y = 2 * r / ROWS - 1
        for c in range(COLUMNS):
            phi = 2 * math.pi * c / COLUMNS
            file.write(f"v {radius(y) * math.sin(phi):.6f} {y:.6f} {radius(y) * math.cos(phi):.6f}\n")
    for r in range(ROWS):
        for c in range(COLUMNS):
            a, b = r * COLUMNS + c + 1, r * COLUMNS + (c + 1) % COLUMNS + 1
            file.write(f"f {a} {b} {b + COLUMNS} {a + COLUMNS}\n")
