#!/usr/bin/env python3
"""Tests of the plots: fronts, percentiles, tables, and pictures of made-up
tables. Exits with 77 without matplotlib, after the rest passed."""
import array
import csv
import importlib.util
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import results


def load(name, script="plot.py"):
    """experiments/NAME/SCRIPT as a module."""
    spec = importlib.util.spec_from_file_location(
        name, HERE.parent / name / script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


pareto, joint_grid = load("pareto"), load("joint_grid")
known_light, known_brdf = load("known_light"), load("known_brdf")
budget = load("pareto", "budget.py")
HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None
PNG = b"\x89PNG\r\n\x1a\n"


def write(path, rows):
    columns = list(dict.fromkeys(c for row in rows for c in row))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="")
        writer.writeheader()
        writer.writerows(rows)


def pareto_row(material, setting, seconds, error, **cells):
    row = dict(material=material, map="m", geometry="sphere", setting=setting,
               estimator="marginal", method="auto", budget_seconds="60",
               size="128", map_width="128", lobes="2", prior="unet",
               unet_channels="32", quadrature="standard",
               seconds=seconds, misfit=error, status="ok",
               brdf_log_rmse_aligned=error,
               illumination_relative_log_rmse_aligned=error)
    row.update(cells)
    return {name: str(value) for name, value in row.items()}


def joint_row(material, error, **cells):
    row = dict(material=material, map="m", geometry="sphere", lobes=2,
               method="auto", model="fold0/m.ibrdf", prior="unet", misfit=0.02, status="ok",
               brdf_log_rmse_aligned=error,
               illumination_relative_log_rmse_aligned=error / 10,
               cook_torrance_brdf_log_rmse_aligned=0.5,
               constant_map_relative_log_rmse_aligned=0.1)
    row.update(cells)
    return {name: str(value) for name, value in row.items()}


def light_row(material, name, error):
    row = {column: error for column, _ in known_light.METRICS}
    row.update(material=material, map=name, status="ok")
    return {key: str(value) for key, value in row.items()}


def brdf_row(material, name, prior, error):
    row = {column: error for column, _ in known_brdf.METRICS}
    row.update(material=material, map=name, prior=prior, status="ok",
               geometry="sphere", **{known_brdf.CONSTANT: 0.2})
    return {key: str(value) for key, value in row.items()}


class Results(unittest.TestCase):
    def test_no_table_exits_with_2(self):
        for name in ("known_light", "known_brdf", "joint_grid", "pareto"):
            program = HERE.parent / name / "plot.py"
            done = subprocess.run([sys.executable, program, "no/such.csv"],
                                  capture_output=True, text=True)
            self.assertEqual(2, done.returncode, name)
            self.assertIn("no/such.csv", done.stderr)

    def test_front(self):
        points = [(3, 1), (1, 5), (2, 6), (2, 3), (4, 1), (5, 0.5)]
        # (2, 6) and (4, 1) are beaten; by cost.
        self.assertEqual([1, 3, 0, 5], results.front(points))
        self.assertEqual([1], results.front([(1, 2), (1, 1)]))
        self.assertEqual([0], results.front([(1, 1), (1, 1)]))

    def test_front_is_what_no_point_beats(self):
        points = [((i * 37) % 23, (i * 53) % 19) for i in range(40)]
        kept = {points[i] for i in results.front(points)}
        slow = {p for p in points
                if not any(q != p and q[0] <= p[0] and q[1] <= p[1]
                           for q in points)}
        self.assertEqual(slow, kept)

    def test_percentile(self):
        self.assertEqual(2.5, results.median([4, 1, 3, 2]))
        self.assertEqual(7, results.percentile([7], 0.9))
        self.assertAlmostEqual(9.1, results.percentile(range(1, 11), 0.9))
        self.assertEqual(10, results.percentile(range(1, 11), 1.0))

    def test_tables(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "results.csv"
            write(path, [{"a": "1", "status": "ok"},
                         {"a": "", "status": "no_improvement"},
                         {"a": "3", "status": "signal_9"}])
            rows = results.read_rows(path, ["a"])
            self.assertEqual([1.0], results.numbers(rows, "a"))
            self.assertEqual(2, len(rows))
            with self.assertRaisesRegex(ValueError, "results.csv.*column b"):
                results.read_rows(path, ["a", "b"])
            write(path, [{"a": "1", "status": "signal_9"}])
            with self.assertRaisesRegex(ValueError, "no case"):
                results.read_rows(path, ["a"])


class Pareto(unittest.TestCase):
    def test_medians_are_over_shared_cases(self):
        rows = [pareto_row("x", "default", 10, 1.0),
                pareto_row("y", "default", 20, 3.0),
                pareto_row("z", "default", 90, 99.0),
                pareto_row("x", "lobes-1", 4, 2.0, lobes=1),
                pareto_row("y", "lobes-1", 6, 4.0, lobes=1)]
        points, cases = pareto.settings(rows)
        self.assertEqual(2, cases)
        self.assertEqual(["default", "lobes-1"], [name for name, _ in points])
        self.assertEqual(15.0, points[0][1]["seconds"])
        self.assertEqual(2.0, points[0][1]["misfit"])
        self.assertEqual(3.0, points[1][1]["misfit"])
        rows[3]["misfit"] = ""
        self.assertIsNone(pareto.settings(rows)[0][1][1]["misfit"])

    def test_refusals(self):
        with self.assertRaisesRegex(ValueError, "every setting"):
            pareto.settings([pareto_row("x", "default", 1, 1),
                             pareto_row("y", "lobes-1", 1, 1, lobes=1)])
        with self.assertRaisesRegex(ValueError, "default has rows"):
            pareto.settings([pareto_row("x", "default", 1, 1),
                             pareto_row("x", "default", 1, 1, lobes=3)])

    def test_list_of_points(self):
        points, _ = pareto.settings(
            [pareto_row("x", "default", 10, 1.0),
             pareto_row("x", "lobes-1", 4, 2.0, lobes=1),
             pareto_row("x", "adam", 100, 1.5, method="adam")])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "front.csv"
            pareto.write_front(points, path)
            with open(path, newline="") as file:
                rows = list(csv.DictReader(file))
        self.assertEqual(["lobes-1", "default", "adam"],
                         [row["setting"] for row in rows])
        self.assertEqual(["1", "1", "0"],
                         [row["front_misfit"] for row in rows])

    @unittest.skipUnless(HAS_MATPLOTLIB, "no matplotlib")
    def test_picture(self):
        points, cases = pareto.settings(
            [pareto_row("x", "default", 10, 1.0),
             pareto_row("x", "seconds-5", 5, 1.5, budget_seconds=5),
             pareto_row("x", "adam", 100, 0.9, method="adam", misfit="")])
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "p.png"
            pareto.draw(points, cases, path)
            self.assertTrue(path.read_bytes().startswith(PNG))


def write_table(path, peak, at_40):
    """A MERL table of which the rows that tell its kind are set."""
    with open(path, "wb") as file:
        file.truncate(12 + 3 * 90 * 90 * 180 * 8)
        for channel in range(3):
            for theta_h, value in ((0, peak), (1, peak), (2, peak), (60, at_40)):
                file.seek(12 + 8 * 180 * ((channel * 90 + theta_h) * 90 + 2))
                file.write(array.array("d", [value] * 180).tobytes())


class Budget(unittest.TestCase):
    ROWS = [pareto_row("a", "default", 26, 0.4, budget_seconds=120),
            pareto_row("a", "seconds-5", 5, 0.8, budget_seconds=5),
            pareto_row("b", "default", 28, 0.6, budget_seconds=120),
            pareto_row("b", "turns-0", 20, 0.9, budget_seconds=120)]

    def test_kinds_are_told_by_the_highlight(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "a.binary"
            for peak, kind in ((9.0, "matte"), (11.0, "glossy"),
                               (3900.0, "glossy"), (4100.0, "mirror-like")):
                write_table(path, peak, 1.0)
                self.assertEqual(kind, budget.kind(path))

    def test_rows_by_kind_and_budget(self):
        with tempfile.TemporaryDirectory() as folder:
            write_table(Path(folder) / "a.binary", 2.0, 1.0)
            write_table(Path(folder) / "b.binary", 9000.0, 1.0)
            groups = budget.by_kind(self.ROWS, folder)
        self.assertEqual(["matte", "mirror-like"], list(groups))
        self.assertEqual([5.0, 120.0], sorted(groups["matte"]))
        # Other settings are no budgets.
        self.assertEqual(1, len(groups["mirror-like"][120.0]))

    @unittest.skipUnless(HAS_MATPLOTLIB, "no matplotlib")
    def test_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "b.png"
            budget.draw({"matte": {5.0: self.ROWS[1:2], 120.0: self.ROWS[:1]}},
                        path)
            self.assertTrue(path.read_bytes().startswith(PNG))


class JointGrid(unittest.TestCase):
    def test_worst_and_wins(self):
        rows = [joint_row("a", 0.4), joint_row("b", 0.9), joint_row("c", 0.6),
                joint_row("d", 0.1, brdf_log_rmse_aligned="")]
        self.assertEqual(["b", "c"],
                         [r["material"] for r in joint_grid.worst(rows, 2)])
        self.assertEqual((1, 3), joint_grid.better(
            rows, joint_grid.BRDF, "cook_torrance_brdf_log_rmse_aligned"))

    def test_folders_are_those_of_the_sweep(self):
        self.assertEqual(
            Path("c/a_m/estimate_unet_2_auto_fold0-m.ibrdf/overview.png"),
            joint_grid.overview(joint_row("a", 1), "c"))
        self.assertEqual(
            Path("c/a_m_bunny/estimate_unet_2_auto/overview.png"),
            joint_grid.overview(
                joint_row("a", 1, geometry="bunny", model="default"), "c"))

    @unittest.skipUnless(HAS_MATPLOTLIB, "no matplotlib")
    def test_pictures(self):
        rows = [joint_row(f"m{i}", 0.1 * i) for i in range(1, 8)]
        with tempfile.TemporaryDirectory() as folder:
            import numpy
            from matplotlib import image
            overview = joint_grid.overview(rows[6], folder)
            overview.parent.mkdir(parents=True)
            image.imsave(overview, numpy.zeros((9, 7, 3)))
            for draw, name in (
                    (lambda out: joint_grid.draw_errors(rows, out), "e.png"),
                    (lambda out: joint_grid.draw_worst(rows, folder, out),
                     "w.png")):
                path = Path(folder) / name
                draw(path)
                self.assertTrue(path.read_bytes().startswith(PNG))
            halves = joint_grid.halved(numpy.arange(90.0).reshape(6, 5, 3))
            self.assertEqual((3, 2, 3), halves.shape)
            self.assertEqual((0 + 3 + 15 + 18) / 4, halves[0, 0, 0])


class KnownLight(unittest.TestCase):
    ROWS = [light_row("a", "m", 0.4), light_row("b", "m", 0.1),
            light_row("a", "n", 0.2), light_row("b", "n", 0.3),
            light_row("c", "n", "")]

    def test_order_and_table(self):
        # Medians 0.3 and 0.2; c was solved without a truth to compare with.
        self.assertEqual(["b", "a"], known_light.materials_by_error(self.ROWS))
        lines = known_light.table(self.ROWS).splitlines()
        self.assertEqual(["m", "n", "all"],
                         [line.split()[1] for line in lines[2:]])
        self.assertIn("| m | 2 | 0.25; 0.37 |", lines[2])
        self.assertIn("| all | 5 | 0.25; 0.37 |", lines[4])
        self.assertEqual(3, len(known_light.table(self.ROWS[:2]).splitlines()))

    @unittest.skipUnless(HAS_MATPLOTLIB, "no matplotlib")
    def test_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "p.png"
            known_light.draw(self.ROWS, path)
            self.assertTrue(path.read_bytes().startswith(PNG))


class KnownBrdf(unittest.TestCase):
    ROWS = [brdf_row("a", "m", "unet", 0.1), brdf_row("a", "m", "none", 0.3),
            brdf_row("b", "m", "unet", 0.3), brdf_row("b", "m", "none", 0.2),
            brdf_row("a", "n", "unet", 0.5), brdf_row("a", "n", "none", 0.4),
            brdf_row("b", "n", "unet", 9.0)]

    def test_means_are_over_shared_cases(self):
        groups = known_brdf.shared(self.ROWS)
        self.assertEqual(["m", "n"], list(groups))
        self.assertEqual(1, len(groups["n"]["unet"]))  # b lacks the other
        self.assertAlmostEqual(
            0.2, known_brdf.mean(groups["m"]["unet"], known_brdf.ERROR))
        self.assertEqual(
            1, known_brdf.wins(groups, "unet", "none", known_brdf.ERROR))
        text = known_brdf.table(self.ROWS)
        self.assertIn("| m | none | 2 | 0.25 | 0.25 |", text)
        self.assertIn("aligned, is below that with `none` on 1 of 2", text)
        with self.assertRaisesRegex(ValueError, "every prior"):
            known_brdf.shared(self.ROWS[:1] + self.ROWS[3:4])

    @unittest.skipUnless(HAS_MATPLOTLIB, "no matplotlib")
    def test_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "p.png"
            known_brdf.draw(self.ROWS, path)
            self.assertTrue(path.read_bytes().startswith(PNG))


if __name__ == "__main__":
    program = unittest.main(exit=False)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(0 if HAS_MATPLOTLIB else 77)
