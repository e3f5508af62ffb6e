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


def _paeth(left, up, corner):
    """The PNG standard's predictor, section 9.4."""
    estimate = left + up - corner
    return min((abs(estimate - value), order, value) for order, value in enumerate((left, up, corner)))[2]


def _unfilter(kind, line, above, step):
    """A row of a PNG file, bytes, from what is stored of it."""
    if kind == 0:
        return line
    if kind == 2:
        return [(x + up) & 255 for x, up in zip(line, above)]
    row = [0] * step
    for i, x in enumerate(line):
        left, up, corner = row[i], above[i], above[i - step] if i >= step else 0
        row.append((x + (left if kind == 1 else (left + up) // 2 if kind == 3 else _paeth(left, up, corner))) & 255)
    return row[step:]


def read_png(path):
    """[H, W, channels] in [0, 1] of a PNG file of 8 or 16 bits, not interlaced and without a palette."""
    data = path.read_bytes()
    at, packed = 8, b""
    while at < len(data):
        size, name = struct.unpack(">I", data[at:at + 4])[0], data[at + 4:at + 8]
        if name == b"IHDR":
            width, height, bits, kind, _, _, interlaced = struct.unpack(">IIBBBBB", data[at + 8:at + 21])
        elif name == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[kind]
    if bits not in (8, 16) or interlaced:
        raise ValueError(f"{path}: PNG of {bits} bits, interlaced {interlaced}, is not read")
    raw, step = zlib.decompress(packed), channels * bits // 8
    rows, above = [], [0] * (width * step)
    for y in range(height):
        begin = y * (width * step + 1)
        above = _unfilter(raw[begin], list(raw[begin + 1:begin + 1 + width * step]), above, step)
        rows.append(bytes(above))
    values = np.frombuffer(b"".join(rows), ">u2" if bits == 16 else "u1")
    return values.reshape(height, width, channels) / float(2**bits - 1)


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
