#!/usr/bin/env python3
"""Draws the pictures of docs/frames.md: one room in every frame of environment maps.

    docs/draw_frames.py [--bin build/release/bin]

The room is a cube seen from its middle: a blue wall ahead with a yellow lamp on the ceiling before it, a red door on the
left, a white window on the right, a violet wall behind. The script writes it as a map in the frame camera; ibrdf_render writes that map in
the other frames, and ibrdf_eval draws each.
"""
import argparse
import math
import pathlib
import struct
import subprocess
import tempfile
import zlib

DOCS = pathlib.Path(__file__).resolve().parent
FRAMES = ("camera", "openexr", "mitsuba", "blender", "polyhaven_y_up", "debevec_probe", "cube_cross", "ibrdf_0_1")
HEIGHT = 160
WALLS = {  # axis, sign: sRGB bytes
    ("x", 1): (184, 168, 144), ("x", -1): (168, 184, 144), ("y", 1): (216, 216, 212), ("y", -1): (136, 112, 88),
    ("z", 1): (176, 136, 176), ("z", -1): (120, 152, 200)}
WINDOW, DOOR, LAMP = (255, 255, 255), (208, 80, 68), (255, 240, 144)
SCENE = """image: {width: 8, height: 8}
geometry: {sphere: {}}
reflectance: {known: {lambertian: 0.5}}
illumination: {known: room.pfm, frame: camera}
quality: preview
"""


def colour(x, y, z):
    """Of a direction in the room; the walls are at a distance of 1."""
    axis, value = max((("x", x), ("y", y), ("z", z)), key=lambda a: abs(a[1]))
    x, y, z = x / abs(value), y / abs(value), z / abs(value)
    sign = 1 if value > 0 else -1
    if (axis, sign) == ("x", 1) and abs(z) < 0.4 and -0.2 < y < 0.6:
        return WINDOW
    if (axis, sign) == ("x", -1) and abs(z) < 0.3 and y < 0.6:
        return DOOR
    if (axis, sign) == ("y", 1) and abs(x) < 0.25 and -0.8 < z < -0.3:
        return LAMP
    return WALLS[axis, sign]


def radiance(*direction):
    """Linear, white is 1."""
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4
            for v in (c / 255 for c in colour(*direction))]


def write_room(path):
    """As a PFM, whose first row is the lowest."""
    width, rows = 2 * HEIGHT, []
    for r in reversed(range(HEIGHT)):
        theta = math.pi * (r + 0.5) / HEIGHT
        for c in range(width):
            phi = 2 * math.pi * (c + 0.5) / width - math.pi
            s = math.sin(theta)
            rows.append(struct.pack("<3f", *radiance(s * math.sin(phi), math.cos(theta), -s * math.cos(phi))))
    path.write_bytes(f"PF\n{width} {HEIGHT}\n-1.0\n".encode() + b"".join(rows))


def read_png(path):
    """Width and rows of an 8-bit RGB file, as bytearrays."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", chunk[:8])
        elif kind == b"IDAT":
            packed += chunk
        at += 12 + length
    raw, stride, rows = zlib.decompress(packed), 3 * width + 1, []
    above = bytearray(stride - 1)
    for y in range(height):
        row = bytearray(raw[y * stride + 1:(y + 1) * stride])
        for x in range(len(row)):
            a, b, c = (row[x - 3], above[x], above[x - 3]) if x >= 3 else (0, above[x], 0)
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[x] = row[x] + (0, a, b, (a + b) // 2, paeth)[raw[y * stride]] & 255
        rows.append(row)
        above = row
    return width, rows


def shrink(path):
    """Rounds colours to multiples of 8 and leaves out the filters, which do not pay for flat colours and text."""
    width, rows = read_png(path)
    raw = b"".join(b"\0" + bytes(min(255, (v + 4) // 8 * 8) for v in row) for row in rows)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)) +
                     chunk(b"sRGB", b"\0") + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=DOCS.parent / "build/release/bin",
                        help="folder of the programs; default: build/release/bin")
    args = parser.parse_args()
    (DOCS / "frames").mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_room(folder / "room.pfm")
        (folder / "room.yaml").write_text(SCENE)
        for frame in FRAMES:
            subprocess.run([args.bin / "ibrdf_render", "--scene", folder / "room.yaml", "--out", folder / "ball.exr",
                            "--illumination-out", folder / "map.exr", "--quiet", "--set",
                            f"illumination.output_frame={frame}"], check=True)
            subprocess.run([args.bin / "ibrdf_eval", "frame", folder / "map.exr", DOCS / "frames" / f"{frame}.png"],
                           check=True)
            shrink(DOCS / "frames" / f"{frame}.png")


if __name__ == "__main__":
    main()
