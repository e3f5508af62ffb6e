#!/usr/bin/env python3
"""Forty pictures of painted objects whose paint, material and light are known.

    experiments/painted/make_scenes.py TABLES MAPS MESHES OUT [--only 1/5] [--bin DIR]

TABLES: MERL tables; MAPS: city.hdr and so on; MESHES: bunny.obj and spot_low_resolution.obj. A folder of OUT for each
case gets albedo.pfm, the paint; painted.exr and unpainted.exr, 128x128 pictures with 2 % noise, the second with the
paint's mean all over; and mask.png, the pixels that the object fills. What is there is kept. Needs Debian's
python3-numpy.
"""
import argparse
import pathlib
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "common"))
from files import write_pfm, write_png  # noqa: E402
from surface import SIDE, mesh, pixel_means, sphere, write_turned  # noqa: E402
from textures import TEXTURES  # noqa: E402

SIZE = 128
CASES = 40
# Files, and by how many degrees they are turned about the vertical: spot would look into the camera.
MESHES = {"bunny": ("bunny.obj", 0), "spot": ("spot_low_resolution.obj", 50)}
SHAPES = ["sphere", "bunny", "spot"]
MAPS = ["city", "studio", "forest", "night", "lobby"]
# Of each coat, materials that a model of the ten folds has not seen (experiments/reflectance_model), with that fold, and
# two that no model has: f_matte of a table is scaled to the paint, so that its own colour does not matter.
COATS = {
    "matte": [("green-latex", 0), ("pure-rubber", 1), ("pink-fabric2", 1)],
    "plastic": [("green-plastic", 0), ("polyethylene", 1), ("red-plastic", 0)],
    "coated": [("lacquer", 0), ("white-marble", 0), ("satin", 1)],
}
ANALYTIC = {
    "lacquer": "{diffuse: 0.5, specular: 1, roughness: 0.1, f0: 0.04}",
    "satin": "{diffuse: 0.5, specular: 1, roughness: 0.25, f0: 0.05}",
}
SCENE = """image: {{width: {size}, height: {size}}}
geometry: {geometry}
reflectance:
  known:
    {material}
    albedo: {albedo}
    unpainted_albedo: auto
illumination: {{known: {map}}}
quality: {quality}
noise: 0.02
solver: {{seed: {seed}}}
"""


class Case:
    """The case of a number in [0, CASES). Every fifth from any on has all textures, coats, shapes and maps."""

    def __init__(self, number):
        self.number = number
        self.texture = list(TEXTURES)[number % 4]
        self.shape = SHAPES[number % 3]
        self.map = MAPS[(number // 5 + number) % 5]
        self.coat = list(COATS)[number // 3 % 3]
        self.material, self.fold = COATS[self.coat][number // 9 % 3]
        self.name = f"{number:02d}_{self.texture}_{self.material}_{self.shape}_{self.map}"

    def geometry(self, out):
        if self.shape == "sphere":
            return "{sphere: {}}"
        return f"{{mesh: {(out / self.shape).resolve()}.obj}}"

    def material_line(self, tables):
        if self.material in ANALYTIC:
            return f"cook_torrance: {ANALYTIC[self.material]}"
        return f"brdf: {(tables / self.material).resolve()}.binary"

    def scene(self, arguments, albedo):
        """A problem file for ibrdf_render."""
        # A mesh takes minutes at reference quality. The tolerances of a preview sum to 1.1 %, half the noise.
        quality = "reference" if self.shape == "sphere" else "preview"
        return SCENE.format(size=SIZE, quality=quality, geometry=self.geometry(arguments.out), albedo=albedo,
                            material=self.material_line(arguments.tables), seed=self.number + 1,
                            map=(arguments.maps / f"{self.map}.hdr").resolve())


def cases(only):
    """Those of "1/5": the first, the sixth, ...; then the second and so on with "1/1"."""
    first, step = (int(word) for word in only.split("/"))
    return [Case(number) for number in range(first - 1, CASES, step)]


def add_arguments(parser):
    for name in ("tables", "maps", "meshes", "out"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--only", default="1/1", help="i/n: every n-th case from the i-th")
    parser.add_argument("--bin", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parents[2] / "build/release/bin")


def paint(case, out):
    """Albedo [SIZE, SIZE, 3], 0 beside the object, and the pixels whose samples all see it."""
    hits = sphere(SIZE) if case.shape == "sphere" else mesh(out / f"{case.shape}.obj", SIZE)
    there = np.isfinite(hits[..., 0])
    albedo = np.full(hits.shape, np.nan)
    albedo[there] = TEXTURES[case.texture](hits[there], np.random.default_rng(case.number))
    inside = there.reshape(SIZE, SIDE, SIZE, SIDE).all((1, 3))
    return pixel_means(albedo), inside


def write_meshes(arguments):
    arguments.out.mkdir(parents=True, exist_ok=True)
    for shape, (file, degrees) in MESHES.items():
        write_turned(arguments.meshes / file, degrees, arguments.out / f"{shape}.obj")


def make(case, arguments):
    folder = arguments.out / case.name
    folder.mkdir(parents=True, exist_ok=True)
    if (folder / "mask.png").exists():
        return
    albedo, inside = paint(case, arguments.out)
    write_pfm(folder / "albedo.pfm", albedo)
    # The outline's pixels too, as rays may meet what the samples here miss.
    write_pfm(folder / "even.pfm", np.broadcast_to(albedo[inside].mean(0), albedo.shape))
    for picture, of in (("painted", "albedo"), ("unpainted", "even")):
        scene = folder / f"{picture}.yaml"
        scene.write_text(case.scene(arguments, f"{of}.pfm"))
        subprocess.run([arguments.bin / "ibrdf_render", "--scene", scene, "--out", folder / f"{picture}.exr", "--threads", "1"],
                       check=True)
    write_png(folder / "mask.png", 255 * np.repeat(inside[..., None], 3, -1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_arguments(parser)
    arguments = parser.parse_args()
    write_meshes(arguments)
    for case in cases(arguments.only):
        make(case, arguments)
        print(case.name, flush=True)


if __name__ == "__main__":
    main()
