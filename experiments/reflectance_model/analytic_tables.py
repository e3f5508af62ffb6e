#!/usr/bin/env python3
"""Tables of analytic materials at random, to train on: what a renderer's users make, and no database holds.

usage: analytic_tables.py OUT [--count 48] [--seed 7] [--bin build/release/bin]

Half are Cook-Torrance (a Lambertian part and a lobe of Beckmann), half the principled model's base (GGX); four in ten
are metals. Roughness is uniform in logarithm: slopes of 0.03 to 0.5, principled roughness of 0.1 to 0.84. OUT receives
cook-torrance-NN.binary and principled-NN.binary, and what they are, as YAML, in materials.txt.
"""
import argparse
import pathlib
import random
import subprocess
import tempfile

SCENE = """
image: {{width: 8, height: 8}}
geometry: {{sphere: {{}}}}
reflectance: {{known: {{{material}}}}}
illumination: {{known: {{sky: {{}}}}, width: 32, height: 16}}
quality: preview
"""


class Materials:
    def __init__(self, seed):
        self.random = random.Random(seed)

    def uniform(self, low, high):
        return round(low + (high - low) * self.random.random(), 4)

    def log_uniform(self, low, high):
        return round(low * (high / low) ** self.random.random(), 4)

    def next(self):
        """Its model and parameters, as a problem file has them."""
        model = "cook_torrance" if self.random.random() < 0.5 else "principled"
        metal = self.random.random() < 0.4
        if model == "cook_torrance":
            roughness = self.log_uniform(0.03, 0.5)
            if metal:
                f0 = [self.uniform(0.4, 0.95) for _ in range(3)]
                return model, f"diffuse: 0, specular: 1, roughness: {roughness}, f0: {f0}"
            diffuse = [self.log_uniform(0.01, 0.7) for _ in range(3)]
            return model, (f"diffuse: {diffuse}, specular: {self.uniform(0.3, 1)}, roughness: {roughness}, "
                           f"f0: {self.log_uniform(0.02, 0.3)}")
        roughness = self.log_uniform(0.1, 0.84)
        if metal:
            return model, f"base: {[self.uniform(0.4, 0.95) for _ in range(3)]}, roughness: {roughness}, metallic: 1"
        base = [self.log_uniform(0.01, 0.8) for _ in range(3)]
        return model, f"base: {base}, roughness: {roughness}, metallic: 0, specular: {self.uniform(0.2, 1)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=48)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/release/bin"))
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    materials, lines = Materials(args.seed), []
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder, "scene.yaml")
        for k in range(args.count):
            model, parameters = materials.next()
            name = f"{model.replace('_', '-')}-{k:02d}"
            lines.append(f"{name}: {{{model}: {{{parameters}}}}}\n")
            scene.write_text(SCENE.format(material=f"{model}: {{{parameters}}}"))
            subprocess.run([args.bin / "ibrdf_render", "--scene", scene, "--out", scene.with_suffix(".exr"),
                            "--brdf-out", args.out / f"{name}.binary", "--quiet"], check=True,
                           stdout=subprocess.DEVNULL)
    (args.out / "materials.txt").write_text("".join(lines))


if __name__ == "__main__":
    main()
