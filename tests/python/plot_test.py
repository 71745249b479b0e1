# SPDX-License-Identifier: BSD-3-Clause
"""Figures: the files of `ergocast report --figures`, and what the functions of ergocast.plot draw."""

import os
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from types import SimpleNamespace

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np

import ergocast
from ergocast import plot

SCENARIOS = Path(os.environ["ERGOCAST_SCENARIO_DIR"])
COMMAND = Path(os.environ["ERGOCAST_BIN_DIR"]) / "ergocast"
SVG = "{http://www.w3.org/2000/svg}"


def command(*arguments):
    return subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)


def texts_of(svg):
    return {"".join(element.itertext()).strip() for element in ElementTree.parse(svg).iter(f"{SVG}text")}


def groups_of(svg):
    return [element.get("id") for element in ElementTree.parse(svg).iter(f"{SVG}g")]


class WithFolder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))

    def simulated(self, scenario):
        run_dir = self.folder / scenario
        flown = command("simulate", SCENARIOS / f"{scenario}.textproto", "--duration", 20, "--out", run_dir)
        self.assertEqual(flown.returncode, 0, flown.stderr)
        return run_dir


class ReportWithFigures(WithFolder):
    def test_writes_figures_with_a_line_for_each_agent_and_units(self):
        run_dir = self.simulated("quadrimodal_corners")
        self.assertFalse((run_dir / "figures").exists())
        drawn = command("report", run_dir, "--figures")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        names = [f"figures/{name}.{suffix}" for name in ("map", "metric", "coverage") for suffix in ("svg", "pdf")]
        self.assertEqual(drawn.stdout.split(), [str(run_dir / name) for name in ["report.html", *names]])
        for name in names:
            self.assertGreater((run_dir / name).stat().st_size, 5000, name)
        tracks = [group for group in groups_of(run_dir / "figures/map.svg") if str(group).startswith("agent-")]
        self.assertEqual(tracks, ["agent-0", "agent-1", "agent-2", "agent-3"])
        self.assertLessEqual({"x [m]", "y [m]", "density (uniform = 1)"}, texts_of(run_dir / "figures/map.svg"))
        self.assertLessEqual({"time t [s]", "ergodic metric φ²"}, texts_of(run_dir / "figures/metric.svg"))
        self.assertEqual((run_dir / "figures/map.pdf").read_bytes()[:5], b"%PDF-")
        once = {name: (run_dir / name).read_bytes() for name in names}
        self.assertEqual(command("report", run_dir, "--figures").returncode, 0)
        for name in names:
            self.assertEqual((run_dir / name).read_bytes(), once[name], name)
        self.assertEqual(command("verify", run_dir).returncode, 0)

    def test_draws_a_box_from_three_sides(self):
        run_dir = self.simulated("cube_corners")
        drawn = command("report", run_dir, "--figures")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertLessEqual({"x [m]", "z [m]"}, texts_of(run_dir / "figures/map_xz.svg"))
        self.assertLessEqual({"y [m]", "z [m]"}, texts_of(run_dir / "figures/map_yz.svg"))

    def test_says_what_is_missing_and_keeps_the_page(self):
        run_dir = self.simulated("uniform_square")
        for module in ("matplotlib", "ergocast"):
            planted = self.folder / module
            planted.mkdir()
            (planted / f"{module}.py").write_text(f"raise ModuleNotFoundError(name='{module}')\n")
            # Apart from its build, the command finds what is installed or named.
            program = shutil.copy(COMMAND, planted)
            (run_dir / "report.html").unlink()
            drawn = subprocess.run([program, "report", run_dir, "--figures"], capture_output=True, text=True,
                                   env={**os.environ, "PYTHONPATH": f"{planted}:{os.environ['PYTHONPATH']}"})
            self.assertEqual(drawn.returncode, 3, drawn.stderr)
            self.assertEqual(drawn.stderr, f"no figures: they need python3-{module}; as root: "
                                           f"apt-get install python3-{module}\n")
            self.assertTrue((run_dir / "report.html").exists())
            self.assertFalse((run_dir / "figures").exists())

    def test_names_a_folder_that_cannot_be_written(self):
        run_dir = self.simulated("paper_fig1a")
        (run_dir / "figures").write_text("a file where the folder belongs")
        drawn = command("report", run_dir, "--figures")
        self.assertEqual(drawn.returncode, 2)
        self.assertIn("figures", drawn.stderr)
        self.assertNotIn("Traceback", drawn.stderr)


class Maps(unittest.TestCase):
    def test_have_equal_scales_tracks_and_the_target(self):
        run = ergocast.simulate("harbour_patrol", set={"time.duration_s": 10})
        ax = plot.map(run)
        self.assertEqual(ax.get_aspect(), 1)
        for agent in run.agents:
            line = next(line for line in ax.lines if line.get_gid() == f"agent-{agent}")
            rows = run.trajectory[run.trajectory["agent"] == agent]
            np.testing.assert_array_equal(line.get_xydata(), rows[["x_m", "y_m"]])
        np.testing.assert_array_equal(ax.images[0].get_array(), run.target_density.T)
        self.assertIn("kept out", [text.get_text() for text in ax.get_legend().get_texts()])

    def test_draw_walls_solid_and_rooms_open(self):
        square = np.array([[-1.0, -1], [1, -1], [1, 1], [-1, 1]])
        for turned in ((), (0,), (1,), (2,), (0, 1), (0, 2), (1, 2)):
            rings = [size * (square[::-1] if i in turned else square) for i, size in enumerate((3, 2, 1))]
            figure, ax = plt.subplots()
            plot._draw_walls(ax, SimpleNamespace(walls_m=rings))
            ax.set(xlim=(-4, 4), ylim=(-4, 4))
            figure.canvas.draw()
            pixels = np.asarray(figure.canvas.buffer_rgba())
            # On the way out: solid, a room, solid, free.
            for x, solid in ((0.5, True), (1.5, False), (2.5, True), (3.5, False)):
                column, row = ax.transData.transform((x, 0.1)).round().astype(int)
                self.assertEqual(pixels[-row, column, 0] < 128, solid, f"x = {x}, turned {turned}")
            plt.close(figure)
        run = ergocast.simulate("two_rooms", set={"time.duration_s": 5})
        self.assertIn("wall", [text.get_text() for text in plot.map(run).get_legend().get_texts()])

    def test_mark_stations(self):
        run = ergocast.simulate("home_by_dusk", set={"time.duration_s": 20})
        self.assertTrue(run.mission.stations_m)
        self.assertIn("station", [text.get_text() for text in plot.map(run).get_legend().get_texts()])

    def test_of_the_modes_average_to_one_and_follow_the_axes(self):
        run = ergocast.simulate("water_column", set={"time.duration_s": 2})
        for view, third in (("xy", 2), ("xz", 1), ("yz", 0)):
            covered, target = plot.coverage(run, view=view)
            for ax in (covered, target):
                self.assertAlmostEqual(float(ax.images[0].get_array().mean()), 1, places=9)
            self.assertEqual(covered.get_xlabel(), f"{view[0]} [m]")
        # Along an axis that two views share, the means over the others are the same.
        xy, xz, yz = (plot.coverage(run, view=view)[1].images[0].get_array() for view in ("xy", "xz", "yz"))
        np.testing.assert_allclose(xy.mean(axis=0), xz.mean(axis=0), atol=1e-9)
        np.testing.assert_allclose(xy.mean(axis=1), yz.mean(axis=0), atol=1e-9)
        np.testing.assert_allclose(xz.mean(axis=1), yz.mean(axis=1), atol=1e-9)
        with self.assertRaisesRegex(ValueError, "view='zz'"):
            plot.map(run, view="zz")

    def test_of_the_modes_are_the_target_where_it_is_smooth(self):
        run = ergocast.simulate("quadrimodal_corners", set={"time.duration_s": 2})
        seen = plot.coverage(run)[1].images[0].get_array().T
        nearest = ((np.arange(len(seen)) + 0.5) / len(seen) * len(run.target_density)).astype(int)
        target = run.target_density[np.ix_(nearest, nearest)]
        self.assertLess(np.abs(seen - target).max(), 0.05 * target.max())


class Metrics(unittest.TestCase):
    def test_of_one_run_and_of_several(self):
        runs = [ergocast.simulate("quadrimodal_corners", seed=seed, set={"time.duration_s": 30}) for seed in (1, 2, 3)]
        ax = plot.metric(runs[0])
        self.assertEqual((ax.get_xscale(), ax.get_yscale()), ("log", "log"))
        np.testing.assert_array_equal(ax.lines[0].get_ydata(), runs[0].metrics["ergodic_metric"][1:])
        slope = ax.lines[1]
        fitted = np.diff(np.log(slope.get_ydata()))[0] / np.diff(np.log(slope.get_xdata()))[0]
        self.assertAlmostEqual(fitted, runs[0].summary["log_log_slope"], places=9)
        self.assertEqual(len(plot.metric(runs).lines), 3)
        ax = plot.metric({"three seeds": runs, "the first": runs[0]})
        every = np.array([run.metrics["ergodic_metric"][1:] for run in runs])
        np.testing.assert_array_equal(ax.lines[0].get_ydata(), np.median(every, axis=0))
        band = ax.collections[0].get_paths()[0].vertices
        self.assertEqual(band[:, 1].max(), every.max())


class Studies(WithFolder):
    def test_draw_medians_and_intervals_of_the_study(self):
        out = self.folder / "study"
        study = command("study", SCENARIOS / "quadrimodal_corners.textproto", "--vary", "law.noise_ceiling=1,5,20",
                        "--vary", "law.anticipation=0,2", "--seeds", "1:7", "--duration", 5, "--out", out)
        self.assertEqual(study.returncode, 0, study.stderr)
        ax = plot.study(out)
        self.assertEqual(ax.get_xlabel(), "law.noise_ceiling")
        self.assertEqual(ax.get_ylabel(), "median φ² at the end")
        self.assertEqual([text.get_text() for text in ax.get_legend().get_texts()], ["anticipation 0", "anticipation 2"])
        rows = plot.pd.read_csv(out / "study.csv")
        first = np.sort(rows[(rows["law.noise_ceiling"] == 1) & (rows["law.anticipation"] == 0)]["ergodic_metric"])
        line, _, (bars,) = ax.containers[0].lines
        self.assertEqual(line.get_ydata()[0], first[3])
        # The interval of 95 % of seven values reaches from the first to the last.
        np.testing.assert_allclose(bars.get_segments()[0][:, 1], first[[0, 6]], rtol=1e-12)
        other = plot.study(out / "study.csv", x="law.anticipation", y="speed_mean_mps")
        self.assertEqual(other.get_ylabel(), "median speed_mean [m/s]")
        with self.assertRaisesRegex(ergocast.ErgocastError, "has no column law.epsilon"):
            plot.study(out, x="law.epsilon")

    def test_intervals_are_those_of_the_binomial_distribution(self):
        for count, rank in ((1, 1), (5, 1), (6, 1), (8, 1), (9, 2), (20, 6), (100, 40), (3000, 1446)):
            low, middle, high = plot.interval(np.arange(1.0, count + 1))
            self.assertEqual((low, high), (rank, count + 1 - rank), count)
            self.assertEqual(middle, (count + 1) / 2)


if __name__ == "__main__":
    unittest.main()
