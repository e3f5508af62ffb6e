"""What experiments on rendered objects share: materials, cameras, problem files and running the programs."""
import json
import math
import subprocess

# Materials of MERL by fold: the model fold0 has not seen the first ten, fold1 has not seen the others.
FOLDS = (
    "pink-jasper,green-plastic,aluminium,white-marble,black-oxidized-steel,red-plastic,blue-metallic-paint2,nickel,"
    "specular-green-phenolic,green-latex",
    "pink-fabric2,polyethylene,dark-blue-paint,silicon-nitrade,pure-rubber,dark-specular-fabric,tungsten-carbide,brass,"
    "red-fabric2,specular-orange-phenolic",
)
# Degrees, and from the origin in units of the scene.
FOV, DISTANCE = 32.0, 4.0


def model_without(models, material):
    """The file in the folder `models` that has not seen a material."""
    return models / f"fold{0 if material in FOLDS[0].split(',') else 1}.ibrdf"


def fibonacci_sphere(count):
    """Directions, evenly over the sphere."""
    golden = math.pi * (3.0 - math.sqrt(5.0))
    for i in range(count):
        y = 1.0 - (2.0 * i + 1.0) / count
        r = math.sqrt(1.0 - y * y)
        yield r * math.sin(golden * i), y, r * math.cos(golden * i)


def look_at_origin(back):
    """Rows of the pose of a camera that stands in a direction, y up."""
    up = (0.0, 0.0, 1.0) if abs(back[1]) > 0.99 else (0.0, 1.0, 0.0)
    right = cross(up, back)
    norm = math.sqrt(sum(x * x for x in right))
    right = tuple(x / norm for x in right)
    up = cross(back, right)
    return [[right[i], up[i], back[i], DISTANCE * back[i]] for i in range(3)] + [[0, 0, 0, 1]]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def perspective_view(name, pose, folder=None):
    """A view of a problem or scene; with its photograph and mask where `folder` has them."""
    view = {"name": name, "camera": {"type": "perspective", "fov_degrees": FOV, "world_from_camera": pose}}
    if folder is not None:
        view["file"] = f"{folder}/{name}/render.exr"
        view["mask"] = f"{folder}/{name}/mask.png"
    return view


def geometry_of(mesh):
    """The unit sphere where there is no mesh."""
    return {"sphere": {}} if mesh is None else {"mesh": str(mesh), "fit": "unit_sphere"}


def write_problem(path, document):
    # JSON is YAML.
    path.write_text(json.dumps(document, indent=1) + "\n")


def solve(command, out):
    """Runs ibrdf_solve; its result.json."""
    done = subprocess.run(command, stderr=subprocess.PIPE, text=True)
    # 3: nothing better than the first guess was found; the result says so.
    if done.returncode not in (0, 3):
        raise SystemExit(f"{out}: {done.stderr}")
    return json.loads((out / "result.json").read_text())
