# SPDX-License-Identifier: BSD-3-Clause
"""examples/estimator, started as its README says: the team's target follows the plume.

estimator_test.py FOLDER: that of the example. The mission lasts until the test ends it."""

import importlib.util
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np

import ergocast

import own_host

COMMAND = Path(os.environ["ERGOCAST_BIN_DIR"]) / "ergocast"
# The plume lies still by then, far from where it began.
LATE_S = 220


def peak_m(mission, target):
    """Where the modes of a target have their maximum."""
    domain, basis = mission.domain, mission.basis
    axes = [np.linspace(0, side, 81) for side in domain.size_m[:2]]
    places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    # A cosine along an axis has half the mean square of a constant.
    waves = np.minimum(1, np.arange(basis.modes_x))[:, None] + np.minimum(1, np.arange(basis.modes_y))
    density = basis.values(places, domain).reshape(len(places), -1) @ (target * 2.0**waves).ravel()
    return places[np.argmax(density)]


class Estimator(unittest.TestCase):
    def test_the_target_follows_the_plume(self):
        folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        with (folder / "mission").open("w") as log, (folder / "estimator").open("w+") as printed:
            mission = subprocess.Popen(
                [COMMAND, "run", EXAMPLE / "plume.textproto", "--out", folder / "run", "--duration", "1000000",
                 "--event-log-limit", "128"], stdout=log, stderr=subprocess.STDOUT)
            while not list((folder / "run").glob("trajectory*.csv")) and mission.poll() is None:
                time.sleep(0.1)
            estimator = subprocess.Popen(
                [sys.executable, EXAMPLE / "estimator.py"], stdout=printed, stderr=subprocess.STDOUT)
            said = (folder / "estimator").read_text

            def followed():
                times = re.findall(r"holds since t = ([\d.]+) s", said())
                return times and float(times[-1]) > LATE_S

            while not followed() and estimator.poll() is None and mission.poll() is None:
                time.sleep(0.1)
            self.assertIsNone(estimator.poll(), said())
            self.assertIsNone(mission.poll(), (folder / "mission").read_text())
            subprocess.run([COMMAND, "stop"], capture_output=True)
            self.assertEqual(mission.wait(), 0)
            self.assertEqual(estimator.wait(), 0, said())
            self.assertTrue(said().endswith("the mission has ended\n"), said())
        self.check(ergocast.load(folder / "run"), json.loads((folder / "run/amendments.json").read_text()))

    def check(self, run, amendments):
        spec = importlib.util.spec_from_file_location("estimator", EXAMPLE / "estimator.py")
        estimator = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(estimator)
        last = [one for one in amendments["amendments"] if one["t_s"] > LATE_S][0]
        plume_m = estimator.plume_m(last["t_s"])
        planned_m = peak_m(run.mission, run.mu)
        followed_m = peak_m(run.mission, np.array(last["target"]).reshape(run.mu.shape))
        off = lambda at_m: np.linalg.norm(at_m - plume_m)
        print(f"the plume is at {plume_m} m, the plan's peak at {planned_m}, the last one at {followed_m}")
        self.assertLess(off(followed_m), 0.5 * off(planned_m))


if __name__ == "__main__":
    own_host.enter()
    EXAMPLE = Path(sys.argv.pop())
    unittest.main()
