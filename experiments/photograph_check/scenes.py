#!/usr/bin/env python3
"""Renders objects of one material that shadow and light themselves, for materials.py.

    experiments/photograph_check/scenes.py BIN MESHES MERL MAPS OUT

Four meshes, three materials and three maps each, 128x128 pixels with 2 % noise. BIN: the folder of the programs; MERL:
tables as ../shared/tools/make_merl.py writes them. A folder each, with problem.yaml for the check.
"""
import pathlib
import subprocess
import sys

MESHES = ("spot_low_resolution", "bunny", "torus", "armadillo")
MATERIALS = ("brass", "white-marble", "red-plastic")
MAPS = ("city", "sunset", "forest")
SCENE = """image: {{width: 128, height: 128}}
geometry: {{mesh: "{mesh}"}}
reflectance: {{known: "{table}"}}
illumination: {{known: "{map}", width: 128, height: 64}}
effects: [interreflection]
quality: preview
noise: 0.02
"""
PROBLEM = """image: {{file: image.exr, mask: mask.png}}
geometry: {{mesh: "{mesh}"}}
"""


def main():
    programs, meshes, tables, maps, out = (pathlib.Path(a).absolute() for a in sys.argv[1:6])
    for mesh in MESHES:
        for material in MATERIALS:
            for name in MAPS:
                folder = out / f"{mesh}_{material}_{name}"
                if (folder / "image.exr").exists():
                    continue
                folder.mkdir(parents=True, exist_ok=True)
                files = {"mesh": meshes / f"{mesh}.obj", "table": tables / f"{material}.binary",
                         "map": maps / f"{name}.hdr"}
                (folder / "scene.yaml").write_text(SCENE.format(**files))
                (folder / "problem.yaml").write_text(PROBLEM.format(**files))
                subprocess.run([programs / "ibrdf_render", "--quiet", "--scene", folder / "scene.yaml", "--out",
                                folder / "image.exr", "--mask", folder / "mask.png"], check=True)


if __name__ == "__main__":
    main()
