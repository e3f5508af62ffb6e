"""Images of a sphere of two materials, from images of each alone, and their problem files.

    compose.py CASES MODELS DATA MAPS OUT

CASES: the folder `cases` of `ibrdf_bench render-inputs`. Writes OUT/NAME with both.exr, labels.png and both.yaml. Labels
100 and 200 are the first and the second material. Needs Python's OpenCV with OpenEXR.
"""
import os
import pathlib
import shutil
import sys

os.environ["OPENCV_IO_ENABLE_OPENEXR"] = "1"
import cv2  # noqa: E402
import numpy as np  # noqa: E402

# Name: fold of the model that saw neither material, map, materials, where the second one is.
CASES = {
    "a": (0, "city", "specular-green-phenolic", "pink-jasper", "right half"),
    "b": (0, "studio", "nickel", "white-marble", "patches"),
    "c": (0, "night", "green-plastic", "red-plastic", "patches"),
    "d": (1, "city", "tungsten-carbide", "dark-blue-paint", "patches"),
}
PATCH = 24  # pixels a side

PROBLEM = """problem: joint
image: {{file: both.exr, mask: mask.png}}
geometry: {{sphere: {{}}}}
reflectance: {{model: {model}, labels: labels.png}}
solver: {{seconds: 6000}}
truth: {{brdf: {brdf}, illumination: {map}, frame: ibrdf_0_1}}
"""


def is_second(where, height, width):
    y, x = np.mgrid[0:height, 0:width]
    return x >= width // 2 if where == "right half" else (x // PATCH + y // PATCH) % 2 == 1


def main():
    cases, models, data, maps, out = (pathlib.Path(p).resolve() for p in sys.argv[1:])
    for name, (fold, light, first, second, where) in CASES.items():
        folder = out / name
        folder.mkdir(parents=True, exist_ok=True)
        images = [cv2.imread(str(cases / f"{m}_{light}" / "input.exr"), cv2.IMREAD_UNCHANGED) for m in (first, second)]
        second_here = is_second(where, *images[0].shape[:2])
        cv2.imwrite(str(folder / "both.exr"), np.where(second_here[..., None], images[1], images[0]))
        cv2.imwrite(str(folder / "labels.png"), np.where(second_here, 200, 100).astype(np.uint8))
        shutil.copy(cases / f"{first}_{light}" / "mask.png", folder)
        (folder / "both.yaml").write_text(PROBLEM.format(
            model=models / f"fold{fold}.ibrdf", brdf=data / f"{first}.binary", map=maps / f"{light}.hdr"))


if __name__ == "__main__":
    main()
