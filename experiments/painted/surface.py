"""Where the pixels of a picture meet an object: the unit sphere or a mesh, before the orthographic camera.

The camera looks along -z at [-1, 1]^2 with y up, and a mesh is placed as `geometry.fit: unit_sphere` places it. Every
pixel has SIDE x SIDE samples. Needs Debian's python3-numpy.
"""
import numpy as np

SIDE = 2


def sphere(size):
    """[n, n, 3] with n = SIDE * size, NaN beside the sphere."""
    x = (2 * np.arange(SIDE * size) + 1) / (SIDE * size) - 1
    u, v = np.meshgrid(x, -x)
    z = 1 - u**2 - v**2
    z = np.sqrt(np.where(z > 0, z, np.nan))
    return np.where(np.isnan(z)[..., None], np.nan, np.stack([u, v, z], -1))


def read_obj(path):
    """Vertices [v, 3] in the unit sphere, triangles [t, 3]."""
    vertices, triangles = [], []
    for line in path.open():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(w.split("/")[0]) - 1 for w in words[1:]]
            triangles += [[corners[0], *corners[k:k + 2]] for k in range(1, len(corners) - 1)]
    vertices = np.array(vertices)
    vertices -= (vertices.min(0) + vertices.max(0)) / 2
    return vertices / np.linalg.norm(vertices, axis=1).max(), np.array(triangles)


def write_turned(path, degrees, out):
    """A mesh turned about y, its faces flat."""
    cosine, sine = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    lines = []
    for line in path.open():
        words = line.split()
        if words[:1] == ["v"]:
            x, y, z = map(float, words[1:4])
            lines.append(f"v {cosine * x + sine * z:.7f} {y:.7f} {cosine * z - sine * x:.7f}")
        elif words[:1] == ["f"]:
            lines.append("f " + " ".join(word.split("/")[0] for word in words[1:]))
    out.write_text("\n".join(lines) + "\n")


def mesh(path, size):
    """As sphere: the nearest point of the mesh at every sample."""
    vertices, triangles = read_obj(path)
    n = SIDE * size
    hits = np.full((n, n, 3), np.nan)
    depth = np.full((n, n), -np.inf)
    # In samples: column, row; the height over the picture stays.
    screen = np.stack([(vertices[:, 0] + 1) * n / 2 - 0.5, (1 - vertices[:, 1]) * n / 2 - 0.5, vertices[:, 2]], -1)
    for triangle in triangles:
        a, b, c = screen[triangle]
        low = np.maximum(np.ceil(np.minimum(np.minimum(a, b), c)[:2]).astype(int), 0)
        high = np.minimum(np.floor(np.maximum(np.maximum(a, b), c)[:2]).astype(int), n - 1)
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if (low > high).any() or area == 0:
            continue
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        of_b = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        of_c = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        of_a = 1 - of_b - of_c
        z = of_a * a[2] + of_b * b[2] + of_c * c[2]
        rows, columns = slice(low[1], high[1] + 1), slice(low[0], high[0] + 1)
        nearer = (of_a >= 0) & (of_b >= 0) & (of_c >= 0) & (z > depth[rows, columns])
        points = np.stack([2 * (x + 0.5) / n - 1, 1 - 2 * (y + 0.5) / n, z], -1)
        depth[rows, columns][nearer] = z[nearer]
        hits[rows, columns][nearer] = points[nearer]
    return hits


def pixel_means(values):
    """[size, size, 3]: the mean over the samples of a pixel that are not NaN, 0 without any."""
    n = values.shape[0] // SIDE
    samples = values.reshape(n, SIDE, n, SIDE, 3).swapaxes(1, 2).reshape(n, n, SIDE**2, 3)
    there = np.isfinite(samples)
    return np.where(there, samples, 0).sum(2) / np.maximum(there.sum(2), 1)
