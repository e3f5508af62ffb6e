#!/usr/bin/env python3
"""Records what the programs write for a fixed list of problems and compares two such records.

Images, tables and models are compared byte for byte, and so is JSON but for the clock's fields. In pages and on
terminals percentages and numbers in table cells are passed over, as many are times: result.json has the metrics.

    scripts/compare_outputs.py record BIN OUT [--only a,b]  runs the programs of folder BIN, writes outputs below OUT,
                                                            which is new, empty or an earlier record
    scripts/compare_outputs.py compare OUT OTHER            status 1 where a file differs, with the names of those

--only records the named cases alone; files that only one of two records has are then no difference.

No clock decides a case: solves are limited by iterations. Times are stripped from JSON, pages and terminals. Numbers
depend on the processor and its BLAS, so both records must come from one machine.
"""
import argparse
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

CLOCKS = ("seconds", "seconds_predicted", "cpu_seconds", "peak_mb", "ibrdf_version")


def torus(path, around=24, along=12):
    """A closed mesh that shadows and lights itself."""
    vertices, faces = [], []
    for i in range(around):
        for j in range(along):
            u, v = 2 * math.pi * i / around, 2 * math.pi * j / along
            r = 0.65 + 0.3 * math.cos(v)
            x, y, z = r * math.cos(u), 0.3 * math.sin(v), r * math.sin(u)
            # Tilted towards the camera.
            c, s = math.cos(0.9), math.sin(0.9)
            vertices.append((x, c * y - s * z, s * y + c * z))
            a, b = i * along + j, i * along + (j + 1) % along
            d, e = (i + 1) % around * along + j, (i + 1) % around * along + (j + 1) % along
            faces += [(a, b, e), (a, e, d)]
    text = ["v %.6f %.6f %.6f" % v for v in vertices]
    text += ["f %d %d %d" % tuple(k + 1 for k in f) for f in faces]
    path.write_text("\n".join(text) + "\n")


SCENES = {
    "sphere": "image: {width: 16, height: 16}\ngeometry: {sphere: {}}\n"
              "reflectance: {known: {cook_torrance: {diffuse: [0.3, 0.2, 0.1], specular: 0.5, roughness: 0.2,"
              " f0: 0.1}}}\nillumination: {known: {sky: {}}, width: 32, height: 16}\nnoise: 0.02\n",
    "torus": "image: {width: 14, height: 14}\ngeometry: {mesh: torus.obj}\n"
             "camera: {type: perspective, fov_degrees: 30, from: [0, 0, 4]}\n"
             "reflectance: {known: {cook_torrance: {diffuse: [0.5, 0.4, 0.3], specular: 0.3, roughness: 0.3,"
             " f0: 0.04}}}\nillumination: {known: {sky: {}}, width: 32, height: 16}\n",
    "mirror": "image: {width: 16, height: 16}\ngeometry: {sphere: {}}\n"
              "reflectance: {known: {cook_torrance: {diffuse: [0.01, 0.01, 0.01], specular: 1, roughness: 0.02,"
              " f0: 0.9}}}\nillumination: {known: {sky: {}}, width: 64, height: 32}\nnoise: 0.01\n",
}
# Of the scenes above: problem, extra keys.
JOINT = "reflectance: {model: %s, lobes: 2}\n"
DEFAULT_MODEL = ("joint", "reflectance", "maximum")  # the others: a small one of three materials
SOLVES = {
    "joint": ("sphere", "joint", "illumination: {width: 32, height: 16, prior: unet}\n", "max_iterations: 1"),
    "joint_process": ("sphere", "joint", "illumination: {width: 32, height: 16, prior: process}\n",
                      "max_iterations: 1"),
    "joint_grey": ("mirror", "joint", "illumination: {width: 32, height: 16, prior: unet}\n",
                   "max_iterations: 2, gauge: grey_light, quadrature: coarse"),
    "joint_start": ("sphere", "joint", "illumination: {width: 32, height: 16, prior: unet}\n", "max_iterations: 0"),
    "joint_torus": ("torus", "joint", "illumination: {width: 32, height: 16, prior: unet}\neffects: all\n", "max_iterations: 1"),
    "joint_shadows": ("torus", "joint", "illumination: {width: 32, height: 16, prior: process}\n"
                      "effects: [visibility]\n", "max_iterations: 1, gauge: unit_light"),
    "maximum": ("sphere", "joint", "illumination: {width: 16, height: 8}\n", "estimator: maximum, max_iterations: 3"),
    "maximum_gn": ("sphere", "joint", "illumination: {width: 16, height: 8, prior: none}\n",
                   "estimator: maximum, method: gauss_newton, max_iterations: 3"),
    "maximum_lbfgs": ("sphere", "joint", "illumination: {width: 16, height: 8, unet_channels: 8}\n",
                      "estimator: maximum, method: lbfgs, max_iterations: 1"),
    "maximum_adam": ("sphere", "joint", "illumination: {width: 16, height: 8, unet_channels: 8}\n",
                     "estimator: maximum, method: adam, max_iterations: 1"),
    "maximum_tr": ("sphere", "joint", "illumination: {width: 16, height: 8, prior: none}\n",
                   "estimator: maximum, method: trust_region, max_iterations: 2"),
    "light": ("sphere", "illumination", "illumination: {width: 64, height: 32, prior: unet}\n", "max_iterations: 4"),
    "light_mirror": ("mirror", "illumination", "illumination: {width: 64, height: 32, prior: process}\n",
                     "max_iterations: 4"),
    "light_none": ("torus", "illumination", "illumination: {width: 32, height: 16, prior: none}\neffects: all\n",
                   "max_iterations: 3, method: lbfgs"),
    "reflectance": ("sphere", "reflectance", "", "max_iterations: 5"),
    "reflectance_torus": ("torus", "reflectance", "effects: all\n", "max_iterations: 3"),
    "reflectance_scale": ("mirror", "reflectance", "likelihood: {scale: 0.05, epsilon: 0.001}\n",
                          "max_iterations: 2, quadrature: fine"),
}
RENDERS = {
    "preview": ("sphere", ["quality=preview"]),
    "harmonics": ("sphere", ["quality=preview", "effects=[harmonics]"]),
    "gaussians": ("sphere", ["quality=preview", "effects=[gaussians]"]),
    "by_normal": ("mirror", ["quality=preview", "effects=[reflectance_map]", "image.width=64", "image.height=64"]),
    "torus_preview": ("torus", ["quality=preview", "effects=all"]),
    "torus_auto": ("torus", ["quality=preview"]),
    "torus_mirror": ("torus", ["quality=preview", "effects=all",
                               "reflectance={known: {cook_torrance: {diffuse: [0, 0, 0], specular: 1,"
                               " roughness: 0.01, f0: 0.9}}}"]),
    "table": ("sphere", ["reflectance={known: sphere.binary}", "noise=0.1"]),
    "lambertian": ("torus", ["reflectance={known: {lambertian: [0.8, 0.5, 0.2]}}", "effects=none"]),
}


class Recorder:
    def __init__(self, binaries, out):
        self.bin, self.out = binaries.resolve(), out.resolve()
        self.inputs = self.out / "inputs"
        if self.out.exists() and any(self.out.iterdir()) and not (self.inputs / "torus.obj").exists():
            sys.exit(f"error: {out}: expected an empty folder or an earlier record")
        shutil.rmtree(self.out, ignore_errors=True)
        self.out.mkdir(parents=True)
        self.inputs.mkdir()

    def run(self, name, program, *arguments):
        done = subprocess.run([str(self.bin / program), *map(str, arguments)], capture_output=True, text=True,
                              cwd=self.inputs)
        text = f"exit {done.returncode}\n{done.stdout}{done.stderr}"
        (self.out / f"{name}.txt").write_text(text.replace(str(self.out), "OUT").replace(str(self.bin), "BIN"))
        return done.returncode

    def render(self, name, scene, sets):
        (self.out / name).mkdir()
        options = [o for s in sets for o in ("--set", s)]
        self.run(name, "ibrdf_render", "--scene", f"{scene}.yaml", "--out", f"../{name}/image.exr", "--mask",
                 f"../{name}/mask.png", "--threads", 1, *options)

    def solve(self, name, scene, problem, keys, solver):
        lobes = JOINT % ("default" if name in DEFAULT_MODEL else "../small.ibrdf")
        known = {"joint": lobes, "reflectance": f"illumination: {{known: {scene}_map.exr}}\n" + lobes,
                 "illumination": f"reflectance: {{known: {scene}.binary}}\n"}[problem]
        geometry = [line for line in SCENES[scene].splitlines() if line.startswith(("geometry", "camera"))]
        (self.inputs / f"{name}.yaml").write_text(
            f"problem: {problem}\nimage: {{file: {scene}.exr, mask: {scene}.png}}\n" + "\n".join(geometry) + "\n" +
            known + keys + f"solver: {{seconds: 100000, {solver}}}\n"
            f"truth: {{brdf: {scene}.binary, illumination: {scene}_map.exr}}\n")
        self.run(name, "ibrdf_solve", "--problem", f"{name}.yaml", "--out", f"../{name}", "--threads", 1)

    def prepare(self):
        torus(self.inputs / "torus.obj")
        for scene, text in SCENES.items():
            (self.inputs / f"{scene}.yaml").write_text(text)
            if self.run(f"prepare_{scene}", "ibrdf_render", "--scene", f"{scene}.yaml", "--out", f"{scene}.exr",
                        "--mask", f"{scene}.png", "--illumination-out", f"{scene}_map.exr", "--brdf-out",
                        f"{scene}.binary") != 0:
                sys.exit(f"error: the scene {scene} was not rendered; see {self.out}/prepare_{scene}.txt")
        tables, maps = self.inputs / "tables", self.inputs / "maps"
        tables.mkdir()
        maps.mkdir()
        for scene in SCENES:
            shutil.copy(self.inputs / f"{scene}.binary", tables)
        shutil.copy(self.inputs / "mirror_map.exr", maps / "sky.exr")
        self.run("train", "ibrdf_train", "--data", "tables", "--out", "../small.ibrdf", "--steps", 200, "--columns", 64,
                 "--analytic", 4, "--widths", 16, 16, 16, "--bins", 8, 8, 8, "--threads", 1)

    def others(self):
        self.run("train_coupling", "ibrdf_train", "--data", "tables", "--out", "../coupling.ibrdf", "--flow",
                 "coupling", "--steps", 5, "--columns", 64, "--analytic", 0, "--widths", 16, 16, "--bins", 8, 8, 8,
                 "--threads", 1)
        for name, extra in {"merl-fit": ["--materials", "sphere", "--methods", "flow,lambertian,cook_torrance",
                                          "--lobes", 2, "--starts", 1]}.items():
            self.run(f"bench_{name}", "ibrdf_bench", name, "--data", "tables", "--out", f"../bench_{name}",
                     "--threads", 1, *extra)
        for name in ("joint", "known-light", "known-brdf"):
            self.run(f"bench_{name}", "ibrdf_bench", name, "--data", "tables", "--maps", "maps", "--materials",
                     "mirror", "--size", 16, "--out", f"../bench_{name}", "--threads", 1, "--dry-run")
        for kind, a, b in (("brdf", "sphere.binary", "mirror.binary"), ("image", "sphere.exr", "mirror.exr"),
                           ("illumination", "sphere_map.exr", "torus_map.exr")):
            self.run(f"eval_{kind}", "ibrdf_eval", kind, a, b)
        self.run("explain", "ibrdf_solve", "--problem", "joint_torus.yaml", "--explain")
        self.run("wrong_key", "ibrdf_solve", "--problem", "joint.yaml", "--set", "solver.secnds=3")


def timeless(value):
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in CLOCKS}
    if isinstance(value, str):
        return re.sub(r"[\d.]+ s\b", "TIME", value)
    return [timeless(v) for v in value] if isinstance(value, list) else value


def normal(path):
    """What of a file is compared, as bytes."""
    if path.suffix == ".json":
        return json.dumps(timeless(json.loads(path.read_text()))).encode()
    if path.suffix in (".html", ".txt"):
        text = re.sub(r"data:image/png;base64,[A-Za-z0-9+/=]+", "PNG", path.read_text(errors="replace"))
        text = re.sub(r"<svg.*?</svg>", "SVG", text, flags=re.S)
        text = re.sub(r"seconds [\d.]+|ibrdf \d\.\d\.\d|\d+(\.\d+)?( ?s\b|</td>)", "TIME", text)
        text = re.sub(r"\d+ %|\d+(\.\d+)? (seconds|steps/s)|[\d.]+e?-?\d*\s+[\d.]+\s*\d* %", "TIME", text)
        return re.sub(r" +", " ", text).encode()
    if path.suffix == ".csv":
        lines = [line.split(",") for line in path.read_text().splitlines()]
        drop = [i for i, name in enumerate(lines[0]) if any(c in name for c in CLOCKS)]
        return "\n".join(",".join(v for i, v in enumerate(r) if i not in drop) for r in lines).encode()
    return path.read_bytes()


def compare(a, b, partial):
    skip = re.compile(r"overview\.png$|\.checkpoint$")
    names = [{str(p.relative_to(d)) for p in d.rglob("*") if p.is_file() and not skip.search(str(p))} for d in (a, b)]
    failures = [] if partial else [f"only in one: {n}" for n in sorted(names[0] ^ names[1])]
    same = 0
    for name in sorted(names[0] & names[1]):
        if normal(a / name) == normal(b / name):
            same += 1
        else:
            failures.append(f"differs: {name}")
    for line in failures:
        print(line)
    print(f"{same} files are the same, {len(failures)} are not")
    return 1 if failures else 0


def record(binaries, out, only):
    recorder = Recorder(binaries, out)
    recorder.prepare()
    wanted = lambda name: not only or name in only
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(recorder.solve, name, *of) for name, of in SOLVES.items() if wanted(name)]
        jobs += [pool.submit(recorder.render, name, *of) for name, of in RENDERS.items() if wanted(name)]
        for job in jobs:
            job.result()
    if wanted("others"):
        recorder.others()
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("verb", choices=("record", "compare"))
    parser.add_argument("first", type=pathlib.Path)
    parser.add_argument("second", type=pathlib.Path)
    parser.add_argument("--only", type=lambda s: s.split(","), default=[], help="cases, comma-separated")
    args = parser.parse_args()
    if args.verb == "record":
        sys.exit(record(args.first, args.second, args.only))
    sys.exit(compare(args.first, args.second, bool(args.only)))


if __name__ == "__main__":
    main()
