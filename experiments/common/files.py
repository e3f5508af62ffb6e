"""The image files and MERL tables that experiments read and write. Needs Debian's python3-numpy."""
import struct
import zlib

import numpy as np


def write_pfm(path, image):
    """[H, W, 3], row 0 the top."""
    with path.open("wb") as file:
        file.write(f"PF\n{image.shape[1]} {image.shape[0]}\n-1\n".encode())
        file.write(image[::-1].astype("<f4").tobytes())


def write_png(path, image):
    """[H, W, 3] of whole numbers to 255."""
    rows = b"".join(b"\0" + row.tobytes() for row in image.astype(np.uint8))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def read_exr(path):
    """[H, W, 3] of an OpenEXR file as the programs write them: floats B, G, R in blocks of 16 rows, ZIP."""
    data = path.read_bytes()
    at = 8
    window = None
    while data[at] != 0:
        name, kind = (data[at:].split(b"\0", 2)[:2])
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        if name == b"dataWindow":
            window = struct.unpack_from("<4i", data, at + 4)
        at += 4 + size
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    blocks = -(-height // 16)
    image = np.zeros((height, width, 3), np.float32)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at + 1):
        row, size = struct.unpack_from("<2i", data, offset)
        rows = min(16, height - row + window[1])
        raw, packed = rows * width * 12, data[offset + 8:offset + 8 + size]
        if size < raw:
            # Differences of bytes, whose even ones precede the odd ones.
            steps = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
            steps[1:] -= 128
            halves = (np.cumsum(steps) % 256).astype(np.uint8)
            unpacked = np.empty(raw, np.uint8)
            unpacked[0::2], unpacked[1::2] = halves[:(raw + 1) // 2], halves[(raw + 1) // 2:]
            packed = unpacked.tobytes()
        block = np.frombuffer(packed, "<f4").reshape(rows, 3, width)
        image[row - window[1]:row - window[1] + rows] = block[:, ::-1].swapaxes(1, 2)
    return image


def read_merl(path):
    """Raw values [3, bins]."""
    with open(path, "rb") as file:
        np.fromfile(file, np.int32, 3)
        return np.fromfile(file, np.float64).reshape(3, -1)
