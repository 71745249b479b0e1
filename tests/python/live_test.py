# SPDX-License-Identifier: BSD-3-Clause
"""A real team that is watched, and gets new targets from Python. It has a network of its own."""

import json
import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import ergocast

import own_host

SCENARIOS = Path(os.environ["ERGOCAST_SCENARIO_DIR"])
COMMAND = Path(os.environ["ERGOCAST_BIN_DIR"]) / "ergocast"
ENDLESS = "10000000"
EAST = {"gaussians": [{"mean_x_m": 1600, "mean_y_m": 400, "sigma_m": 150}], "uniform_weight": 0.1}


def wait_until(condition):
    """A condition that must come true; it has no time limit but the test's."""
    while not condition():
        time.sleep(0.05)


class Team:
    """A mission in lockstep that ends when the test ends it."""

    def __init__(self, folder, *options, duration=ENDLESS):
        self.run_dir = folder / "run"
        self.log = (folder / "printed").open("w")
        self.process = subprocess.Popen(
            [COMMAND, "run", SCENARIOS / "quadrimodal_corners.textproto", "--duration", duration,
             "--out", self.run_dir, "--event-log-limit", "128", *options],
            stdout=self.log, stderr=subprocess.STDOUT,
        )
        wait_until(lambda: self.ended() or any(self.run_dir.glob("trajectory*.csv")))

    def ended(self):
        return self.process.poll() is not None

    def stop(self):
        """In order, also beside a team that another test has left."""
        if not self.ended():
            self.process.send_signal(signal.SIGTERM)
        self.process.wait()
        self.log.close()

    def target(self, number):
        """μ of an amendment; the logger writes it when it has received it."""
        file, found = self.run_dir / "amendments.json", []

        def written():
            if file.exists():
                found[:] = [one["target"] for one in json.loads(file.read_text())["amendments"]
                            if one["number"] == number]
            return found or self.ended()

        wait_until(written)
        return np.array(found[0])


class ARunningTeam(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.team = Team(cls.folder)
        cls.addClassCleanup(cls.team.stop)
        cls.run_ = ergocast.connect()

    def numbered(self):
        """The number that the next amendment will have."""
        return self.run_.amend(EAST, dry_run=True).number

    def test_its_status_has_places(self):
        status = self.run_.status()
        self.assertEqual(status["scenario"], "quadrimodal_corners")
        places = np.array([agent["position_m"] for agent in status["agents"]])
        self.assertEqual(places.shape, (4, 2))
        self.assertTrue(((places >= 0) & (places <= 2000)).all(), places)

    def test_is_watched_as_long_as_the_caller_wants(self):
        ticks = []
        for state in self.run_.watch():
            ticks.append(state["tick"])
            if len(ticks) == 3:
                break
        self.assertLess(ticks[0], ticks[2])

    def test_a_dry_run_changes_nothing(self):
        planned = self.run_.amend(EAST, dry_run=True)
        self.assertGreater(planned.moved_share, 0.5)
        self.assertEqual(self.numbered(), planned.number)

    def test_a_grid_is_the_target_that_its_cells_show(self):
        # Each cell has the mean of a Gaussian that is not symmetric in the domain.
        x, y = (np.arange(100) + 0.5) * 20, (np.arange(80) + 0.5) * 25
        gaussian = lambda at, mean: np.exp(-((at - mean) ** 2) / (2 * 150**2))
        grid = np.outer(gaussian(x, 1600), gaussian(y, 400))
        next_number = self.numbered()
        from_grid = self.run_.amend(grid)
        self.assertEqual(from_grid.number, next_number)
        self.assertAlmostEqual(from_grid.t_s, from_grid.tick * 0.1)
        self.assertIsNone(from_grid.moved_share)
        from_text = self.run_.amend("target { gaussians { mean_x_m: 1600 mean_y_m: 400 sigma_m: 150 } }")
        self.assertEqual(from_text.number, next_number + 1)
        self.assertGreater(from_text.tick, from_grid.tick)
        difference = self.team.target(from_text.number) - self.team.target(from_grid.number)
        self.assertLess(np.abs(difference).max(), 0.01)

    def test_an_amendment_is_cancelled(self):
        last = self.run_.amend(EAST)
        self.run_.cancel(last.number)
        self.assertEqual(self.numbered(), last.number + 2)
        with self.assertRaisesRegex(ergocast.TeamError, "later amendment has replaced"):
            self.run_.cancel(last.number)

    def test_a_zone_is_cancelled(self):
        corner = self.folder / "corner.textproto"
        corner.write_text("vertices { x_m: 0 y_m: 0 } vertices { x_m: 200 y_m: 0 } vertices { x_m: 0 y_m: 200 }")
        number = self.numbered()
        subprocess.run([COMMAND, "amend", "--zone", corner, "--for", "1000000s"], check=True, capture_output=True)
        self.run_.cancel(number)
        # Its status may still come from a process that does not know of it.
        wait_until(lambda: all(zone["amendment"] != number for zone in self.run_.status()["zones"]))
        with self.assertRaisesRegex(ergocast.TeamError, "zone that has ended"):
            self.run_.cancel(number)

    def test_a_dict_a_text_and_a_file_are_the_same_target(self):
        text = ("target { gaussians { mean_x_m: 1600 mean_y_m: 400 sigma_m: 150 } "
                "uniform_weight: 0.1 }")
        file = self.folder / "east.textproto"
        file.write_text(text)
        hashes = {self.run_.amend(target, dry_run=True).target for target in (EAST, text, file, str(file))}
        self.assertEqual(len(hashes), 1)
        # Fields change the target of the scenario in the run's directory, or that one.
        plain = self.run_.amend("quadrimodal_corners", dry_run=True)
        self.assertNotIn(plain.target, hashes)
        recorded = self.run_.amend(set={"target.gaussians[0].mean_x_m": 500}, dry_run=True)
        self.assertEqual(recorded.target, plain.target)
        changed = self.run_.amend(file, set={"target.uniform_weight": 0.2}, dry_run=True)
        self.assertNotIn(changed.target, hashes)

    def test_a_dict_may_name_files_and_words(self):
        map_csv = self.folder / "map.csv"
        map_csv.write_text("0,1\n0,0\n")
        fields = {"file": map_csv, "weight": 1, "origin_x_m": 0, "origin_y_m": 0, "size_x_m": 2000,
                  "size_y_m": 2000}
        north = self.run_.amend({"maps": [{**fields, "first_row": "NORTH"}]}, dry_run=True)
        south = self.run_.amend({"maps": [{**fields, "first_row": "SOUTH"}]}, dry_run=True)
        self.assertNotEqual(north.target, south.target)
        grid = self.run_.amend(np.array([[0, 0], [0, 1]]), dry_run=True)
        self.assertEqual(grid.target, north.target)

    def test_a_later_time_is_kept(self):
        soon, late = (self.run_.amend(EAST, at=at, dry_run=True) for at in (0, 500))
        self.assertGreaterEqual(late.tick - soon.tick, 5000)

    def test_errors_have_the_words_of_the_command(self):
        for target, words in (
            ({"gaussian": [{}]}, "did you mean"),
            ({"gaussians": [{"mean_x_m": 90000, "mean_y_m": 0, "sigma_m": 1}]}, "target: "),
            (np.zeros((2, 2)), "target.csv"),
            (np.array([[1, -1]]), "target.csv"),
            (np.array([[1, np.nan]]), "target.csv"),
            (np.zeros(3), "is no grid over a plane"),
            ("none.csv", "there is no such file"),
        ):
            with self.subTest(words=words), self.assertRaises(ergocast.ScenarioError) as raised:
                self.run_.amend(target, dry_run=True)
            self.assertIn(words, str(raised.exception))
        with self.assertRaisesRegex(ergocast.ScenarioError, "only the target of a running mission"):
            self.run_.amend(set={"law.u_max_mps": 3}, dry_run=True)
        with self.assertRaisesRegex(ergocast.ScenarioError, "--target, --set, --zone"):
            self.run_.amend()
        with self.assertRaisesRegex(ergocast.TeamError, "the mission ends before that"):
            self.run_.amend(EAST, at=1e7)



class AMissionThatEnds(unittest.TestCase):
    def test_ends_the_watching(self):
        with tempfile.TemporaryDirectory() as folder:
            team = Team(Path(folder))
            self.addCleanup(team.stop)
            states = ergocast.connect().watch()
            # A busy team may not have reported its state yet.
            next(state for state in states if state["state"] == "running")
            team.stop()
            *_, last = states
            self.assertEqual(last["state"], "ended")

    def test_without_a_team_the_command_s_words_are_raised(self):
        with self.assertRaisesRegex(ergocast.TeamError, "no message of any run"):
            ergocast.connect().amend(EAST)
        with self.assertRaisesRegex(ergocast.TeamError, "no message of any run"):
            ergocast.connect(lcm_url="udpm://239.255.76.67:24800?ttl=0").status()

    def test_what_the_command_warns_of_is_a_warning(self):
        printed = subprocess.CompletedProcess(
            [], 0, "amendment 3, target 5f0c, holds since tick 517, t = 51.7 s\n", "warning: narrow\n")
        with mock.patch.object(ergocast.LiveRun, "_run", return_value=printed), \
                self.assertWarnsRegex(UserWarning, "^narrow$"):
            amendment = ergocast.connect().amend(EAST)
        self.assertEqual(amendment, ergocast.Amendment(3, 517, 51.7, "5f0c"))

    def test_a_law_is_asked_for_by_its_fields(self):
        printed = subprocess.CompletedProcess(
            [], 0, "amendment 4, law 5f0c (u_max_mps 8), holds since tick 517, t = 51.7 s, by anna@base\n", "")
        with mock.patch.object(ergocast.LiveRun, "_run", return_value=printed) as run:
            amendment = ergocast.connect().amend_law(u_max_mps=8, noise_intensity=0.5, kind="scout", at=60)
        self.assertEqual(amendment, ergocast.Amendment(4, 517, 51.7, "5f0c"))
        self.assertEqual(run.call_args.args, (
            "amend", "--law", "scout.u_max_mps=8.0", "--law", "scout.noise_intensity=0.5", "--at", "+60.0s"))
        planned = subprocess.CompletedProcess(
            [], 0, "no problems: law 5f0c, u_max_mps 8\nnow the law is as planned\n"
            "it would be amendment 4, at the earliest from tick 9, t = 0.9 s on\nnothing was sent\n", "")
        with mock.patch.object(ergocast.LiveRun, "_run", return_value=planned):
            self.assertEqual(ergocast.connect().amend_law(u_max_mps=8, dry_run=True),
                             ergocast.Amendment(4, 9, 0.9, "5f0c"))
        with self.assertRaisesRegex(ergocast.ScenarioError, "name u_max_mps"):
            ergocast.connect().amend_law()


if __name__ == "__main__":
    own_host.enter()
    unittest.main()
