"""Normals of a mesh as an orthographic camera sees them, by points scattered over its triangles. Needs numpy."""
import math

import numpy as np


def read_obj(path):
    """Vertices [n, 3] and triangles [m, 3]."""
    vertices, triangles = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                vertices.append([float(w) for w in words[1:4]])
            elif words[:1] == ["f"]:
                corners = [int(w.split("/")[0]) - 1 for w in words[1:]]
                triangles += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
    return np.array(vertices), np.array(triangles)


def rotation(yaw_degrees, pitch_degrees):
    y, p = math.radians(yaw_degrees), math.radians(pitch_degrees)
    about_y = np.array([[math.cos(y), 0, math.sin(y)], [0, 1, 0], [-math.sin(y), 0, math.cos(y)]])
    about_x = np.array([[1, 0, 0], [0, math.cos(p), -math.sin(p)], [0, math.sin(p), math.cos(p)]])
    return about_x @ about_y


def trace(vertices, triangles, turn, size, fill=0.9):
    """Unit normals [size, size, 3], x right, y up, z to the camera; zero outside the object."""
    v = (vertices - (vertices.min(0) + vertices.max(0)) / 2) @ turn.T
    v = v / np.abs(v[:, :2]).max() * fill
    corners = v[triangles]
    face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    smooth = np.zeros_like(v)
    for k in range(3):
        np.add.at(smooth, triangles[:, k], face)
    smooth /= np.maximum(np.linalg.norm(smooth, axis=1, keepdims=True), 1e-12)
    facing = face[:, 2] > 0
    corners, normals = corners[facing], smooth[triangles[facing]]
    edges = np.linalg.norm(np.roll(corners, 1, axis=1) - corners, axis=2).max(1) * size / 2
    depth = np.full(size * size, -np.inf)
    out = np.zeros((size * size, 3))
    steps = np.ceil(1.6 * edges).astype(int) + 1
    for n in np.unique(steps):
        a, b = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
        keep = a + b <= n
        weights = np.stack([a[keep], b[keep], n - a[keep] - b[keep]], 1) / n
        for chunk in np.array_split(np.flatnonzero(steps == n), max(1, (steps == n).sum() * len(weights) // 2000000)):
            points = np.einsum("wc,tcx->twx", weights, corners[chunk]).reshape(-1, 3)
            directions = np.einsum("wc,tcx->twx", weights, normals[chunk]).reshape(-1, 3)
            column = ((points[:, 0] + 1) * size / 2).astype(int)
            row = ((1 - points[:, 1]) * size / 2).astype(int)
            pixel = row * size + column
            order = np.lexsort((points[:, 2], pixel))
            pixel, order = pixel[order], order
            last = np.r_[pixel[1:] != pixel[:-1], True]
            pixel, order = pixel[last], order[last]
            nearer = points[order, 2] > depth[pixel]
            depth[pixel[nearer]] = points[order[nearer], 2]
            out[pixel[nearer]] = directions[order[nearer]]
    length = np.linalg.norm(out, axis=1, keepdims=True)
    out = np.where(length > 1e-6, out / np.maximum(length, 1e-12), 0)
    # Interpolated normals of a visible point may look away a little.
    set_ = np.abs(out).max(1) > 0
    out[set_, 2] = np.maximum(out[set_, 2], 1e-3)
    out[set_] /= np.linalg.norm(out[set_], axis=1, keepdims=True)
    return out.reshape(size, size, 3)
