# SPDX-License-Identifier: BSD-3-Clause
"""Laws of one's own: in simulations, and beside our laws in a study of the command.

law_test.py FOLDER: that of examples/law.
"""

import csv
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import ergocast

COMMAND = Path(os.environ["ERGOCAST_BIN_DIR"]) / "ergocast"
SCENARIO = Path(os.environ["ERGOCAST_SCENARIO_DIR"]) / "quadrimodal_corners.textproto"
SHORT = {"time.duration_s": 20}
SPIRAL = Path(sys.argv.pop()) / "spiral.py"


class Seen(ergocast.Law):
    """Wants the same velocity always, and keeps what it got."""

    def __init__(self, velocity=(1, 2)):
        self.velocity, self.calls = velocity, []

    def wanted_mps(self, now):
        self.calls.append((now.tick, now.t_s, now.agents, now.x_m, now.c, now.mu, now.u_max_mps))
        return np.tile(self.velocity, (len(now.agents), 1))


class Returns(ergocast.Law):
    """Returns what `rows` makes of the velocities that are allowed."""

    def __init__(self, rows):
        self.rows = rows

    def wanted_mps(self, now):
        return self.rows(np.zeros_like(now.x_m), now.tick)


class InSimulations(unittest.TestCase):
    def test_all_agents_of_a_tick_come_in_one_call(self):
        law = Seen()
        run = ergocast.simulate(SCENARIO, set=SHORT, law=law)
        self.assertEqual([call[0] for call in law.calls], list(range(200)))
        for (tick, t_s, agents, x_m, c, mu, u_max_mps), places_m in zip(law.calls, run.positions_m):
            self.assertEqual(agents.tolist(), [0, 1, 2, 3])
            self.assertTrue(np.array_equal(x_m, places_m), tick)
            self.assertTrue(np.array_equal(mu, run.mu))
            self.assertTrue(np.array_equal(u_max_mps, np.full(4, run.mission.law.u_max_mps)))
        self.assertAlmostEqual(law.calls[150][1], 15)
        self.assertTrue(np.array_equal(law.calls[150][4], run.coverage(150)))
        self.assertTrue(np.all(run.velocities_mps[5:100] == (1, 2)))
        self.assertEqual(run.summary["own_law"], "Seen")

    def test_vehicles_keep_their_limits(self):
        run = ergocast.simulate(SCENARIO, set={**SHORT, "world.speed_limit_mps": 1}, law=Seen((6, 8)))
        self.assertTrue(np.allclose(run.velocities_mps[5:50], (0.6, 0.8)))

    def test_a_class_and_a_place_in_a_file_are_the_same_law(self):
        spiral = ergocast.simulate(SCENARIO, set=SHORT, law=f"{SPIRAL}:Spiral")
        sys.path.insert(0, str(SPIRAL.parent))
        import spiral as module

        same = ergocast.simulate(SCENARIO, set=SHORT, law=module.Spiral)
        self.assertTrue(same.trajectory.equals(spiral.trajectory))
        self.assertFalse(same.trajectory.equals(ergocast.simulate(SCENARIO, set=SHORT).trajectory))
        team = ergocast.IdealTeam(same.mission, law=module.Spiral())
        team.step(100)
        self.assertTrue(np.array_equal(team.positions_m, same.positions_m[100]))

    def test_no_other_law_is_verified_in_its_place(self):
        with tempfile.TemporaryDirectory() as folder:
            ergocast.simulate(SCENARIO, set=SHORT, law=Seen, out=f"{folder}/run")
            verified = subprocess.run([COMMAND, "verify", f"{folder}/run"], capture_output=True, text=True)
        self.assertEqual(verified.returncode, 2)
        self.assertIn('its agents followed "Seen"', verified.stderr)

    def refusal(self, law, **more):
        with self.assertRaises(ergocast.LawError) as raised:
            ergocast.simulate(SCENARIO, law=law, set={**SHORT, **more})
        return str(raised.exception)

    def test_velocities_that_no_agent_may_want_are_refused(self):
        def spoilt(number):
            def rows(velocities, tick):
                velocities[2] = number if tick == 7 else 0
                return velocities

            return Returns(rows)

        where = "Returns.wanted_mps() at tick 7: agent 2 wants "
        self.assertEqual(self.refusal(spoilt(np.nan)), where + "a velocity that is not finite")
        self.assertRegex(self.refusal(spoilt(30)), re.escape(where) + r"42\.4\d* m/s, above its u_max_mps of 20\.0")
        shape = "Returns.wanted_mps() at tick 0: "
        self.assertEqual(self.refusal(Returns(lambda v, tick: v[:3])),
                         shape + "the shape of the velocities must be (4, 2), not (3, 2)")
        self.assertEqual(self.refusal(Returns(lambda v, tick: v.T)),
                         shape + "the shape of the velocities must be (4, 2), not (2, 4)")
        self.assertIn("returned None", self.refusal(Returns(lambda v, tick: None)))
        self.assertIn("returned no numbers", self.refusal(Returns(lambda v, tick: "east")))

    def test_the_greatest_speed_is_allowed(self):
        run = ergocast.simulate(SCENARIO, set=SHORT, law=Seen((12, 16)))
        self.assertEqual(run.velocities_mps[0, 0].tolist(), [12, 16])

    def test_what_is_no_law_is_refused(self):
        self.assertIn("is no ergocast.Law", self.refusal(7))
        self.assertIn("there is no Python file missing.py", self.refusal("missing.py:Spiral"))
        self.assertIn("has no class Circle that derives from ergocast.Law (it has Spiral)",
                      self.refusal(f"{SPIRAL}:Circle"))
        self.assertIn("needs the places of all agents",
                      self.refusal(Seen, **{"world.radio_range_m": 500}))

    def test_its_own_errors_stay_what_they_are(self):
        with self.assertRaises(ZeroDivisionError):
            ergocast.simulate(SCENARIO, set=SHORT, law=Returns(lambda v, tick: v + 1 // (tick - 7)))

    def test_after_an_error_the_mission_has_ended(self):
        mission = ergocast.compile_mission(SCENARIO, set=SHORT)

        def interrupted(v, tick):
            raise KeyboardInterrupt

        for bad, kind in ((lambda v, tick: None, ergocast.LawError), (lambda v, tick: v + 30, ergocast.LawError),
                          (lambda v, tick: [][0], IndexError), (interrupted, KeyboardInterrupt)):
            for last in (0, 3):
                law = Returns(lambda v, tick: bad(v, tick) if tick == last else v + 1)
                team = ergocast.IdealTeam(mission, law=law)
                team.step(last)
                before_m = team.positions_m
                with self.assertRaises(kind):
                    team.step()
                for _ in range(2):
                    with self.assertRaisesRegex(ergocast.LawError, f"Returns.* tick {last}.*the mission has ended"):
                        team.step()
                self.assertTrue(np.array_equal(team.positions_m, before_m))
                self.assertEqual(team.tick, last)

    def test_agents_that_rest_by_plan_cover_nothing(self):
        text = (SCENARIO.parent / "home_by_dusk.textproto").read_text()
        text = text.replace("count: 4", "count: 2").replace("duration_s: 120", "duration_s: 40")
        text = text.replace("    station { x_m: 22  y_m: 4 }\n    station { x_m: 30  y_m: 4 }\n  }",
                            '  }\n  kind { name: "others"  count: 2 }')
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "dusk.textproto"
            file.write_text(text)
            law = Seen((0.5, 1))
            run = ergocast.simulate(file, law=law)
        self.assertEqual([call[0] for call in law.calls], list(range(400)))
        for tick in (100, 279, 280, 399):
            self.assertTrue(np.allclose(law.calls[tick][4], run.coverage(tick), rtol=0, atol=1e-12), tick)

    def test_an_ideal_team_takes_what_a_simulation_takes(self):
        mission = ergocast.compile_mission(SCENARIO, set=SHORT)
        for law in (Seen, f"{SPIRAL}:Spiral"):
            ergocast.IdealTeam(mission, law=law).step()
        for law, why in ((7, "is no ergocast.Law"), (dict, "is no ergocast.Law"), ("missing.py:Spiral", "no Python file")):
            with self.assertRaisesRegex(ergocast.LawError, why):
                ergocast.IdealTeam(mission, law=law)
        distant = ergocast.compile_mission(SCENARIO, set={**SHORT, "world.radio_range_m": 500})
        with self.assertRaisesRegex(ergocast.LawError, "needs the places of all agents"):
            ergocast.IdealTeam(distant, law=Seen())

    def test_what_an_array_raises_stays_what_it_is(self):
        class Raises:
            def __init__(self, error):
                self.error = error

            def __array__(self, *arguments, **more):
                raise self.error

        for error in (KeyboardInterrupt(), MemoryError(), ZeroDivisionError()):
            with self.assertRaises(type(error)):
                ergocast.simulate(SCENARIO, set=SHORT, law=Returns(lambda v, tick: Raises(error)))
        self.assertIn("returned no numbers", self.refusal(Returns(lambda v, tick: Raises(TypeError()))))

    def test_a_file_replaces_no_module(self):
        import random

        path = list(sys.path)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "random.py"
            (Path(folder) / "beside_the_law.py").write_text("import ergocast\nclass Base(ergocast.Law):\n    pass\n")
            for body in ("from beside_the_law import Base\nclass Mine(Base):\n    pass\n", "raise OSError\n"):
                file.write_text(body)
                for _ in range(2):
                    with self.assertRaises(NotImplementedError if "Mine" in body else OSError):
                        ergocast.simulate(SCENARIO, set=SHORT, law=f"{file}:Mine")
                    self.assertIs(sys.modules["random"], random)
                    self.assertEqual(sys.path, path)
            self.assertFalse([name for name in sys.modules if getattr(sys.modules[name], "__file__", "") == str(file)])

    def test_the_command_refuses_a_field_without_a_value(self):
        done = subprocess.run([sys.executable, "-m", "ergocast", SCENARIO, "--set", "foo"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--set foo: is not FIELD=VALUE", done.stderr)
        self.assertNotIn("Traceback", done.stderr)


class InStudies(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def study(self, laws, *more, out="study", code=0):
        done = subprocess.run(
            [COMMAND, "study", SCENARIO, "--duration", "20", "--vary", f"law.kind={laws}", "--seeds", "1:6",
             "--out", self.folder / out, *more],
            cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def rows(self, out="study"):
        with open(self.folder / out / "study.csv", newline="") as file:
            return list(csv.DictReader(file))

    def law_file(self, body, name="my_law.py"):
        (self.folder / name).write_text(
            "import ergocast\nclass Mine(ergocast.Law):\n    def wanted_mps(self, now):\n" + body)

    def test_a_law_stands_beside_the_default_with_its_intervals(self):
        printed = self.study(f"COVER,{SPIRAL}:Spiral", "--measure", "detection_probability")
        found = printed.split("detection_probability")[1]
        self.assertRegex(found, re.escape(f"{SPIRAL}:Spiral") + r".* \[[\d.e-]+, [\d.e-]+\]")
        rows = self.rows()
        self.assertEqual({row["law.kind"] for row in rows}, {"COVER", f"{SPIRAL}:Spiral"})
        self.assertEqual(len(rows), 12)
        # Each row is the mission that Python simulates with messages, and the default is untouched.
        for row in (rows[2], rows[8]):
            law = None if row["law.kind"] == "COVER" else row["law.kind"]
            run = ergocast.simulate(SCENARIO, seed=int(row["seed"]), set=SHORT, law=law)
            self.assertEqual(float(row["detection_probability"]), run.metrics["detection_probability"].iloc[-1])
            self.assertEqual(float(row["ergodic_metric"]), run.ergodic_metric())
        self.assertNotEqual(rows[2]["ergodic_metric"], rows[8]["ergodic_metric"])
        self.assertIn(f"{SPIRAL}:Spiral", (self.folder / "study/report.html").read_text())
        # The printed command runs a mission of it.
        command = next(line for line in printed.splitlines() if "-m ergocast" in line)
        alone = subprocess.run(command, shell=True, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertRegex(alone.stdout, r"^phi\^2 [\d.e-]+, found 0\.\d+\n$")

    def test_several_processes_compute_the_same(self):
        self.study(f"COVER,{SPIRAL}:Spiral", "--jobs", "1", out="one")
        self.study(f"COVER,{SPIRAL}:Spiral", "--jobs", "3", out="three")
        self.assertEqual(self.rows("one"), self.rows("three"))

    def test_another_law_in_the_same_file_is_another_study(self):
        self.law_file("        return 0 * now.x_m\n")
        self.study("COVER,my_law.py:Mine")
        self.study("COVER,my_law.py:Mine")
        self.law_file("        return 0 * now.x_m + 1\n")
        self.assertIn("its study differs at point 2", self.study("COVER,my_law.py:Mine", code=2))

    def test_an_error_of_the_law_is_named_with_its_line(self):
        self.law_file("        return now.x_m / 0 if now.tick else now.nothing\n")
        printed = self.study("COVER,my_law.py:Mine", code=4)
        self.assertIn("law.kind = my_law.py:Mine, seed 3: AttributeError: ", printed)
        self.assertIn("'nothing', line 4", printed)
        self.assertEqual(len(self.rows()), 6)
        self.law_file("        return now.x_m + now.u_max_mps[0]\n")
        self.assertIn("agent 0 wants ", self.study("COVER,my_law.py:Mine", out="fast", code=4))

    def test_its_process_has_no_pipe_of_the_study(self):
        self.law_file("        import os\n"
                      "        files = [f'/proc/self/fd/{each}' for each in os.listdir('/proc/self/fd') if int(each) > 2]\n"
                      "        assert not [file for file in files if 'pipe:' in os.path.realpath(file)]\n"
                      "        return 0 * now.x_m\n")
        self.study("COVER,my_law.py:Mine")

    def test_a_law_that_cannot_be_used_is_refused_before_the_first_mission(self):
        self.law_file("        return 0 * now.x_m\n")
        (self.folder / "broken.py").write_text("import ergocast\nclass Mine(ergocast.Law:\n")
        for law, why in (("missing.py:Mine", "missing.py: "),
                         ("my_law.py:Yours", "my_law.py has no class Yours"),
                         ("broken.py:Mine", "broken.py:Mine: SyntaxError")):
            self.assertIn(why, self.study(f"COVER,{law}", code=2))
            self.assertFalse((self.folder / "study").exists())
        printed = self.study("COVER,my_law.py:Mine", "--vary", "law.epsilon=0.1,0.2,0.3",
                             "--set", "world.radio_range_m=300", code=2)
        self.assertEqual(printed.count("needs the places of all agents"), 1)


if __name__ == "__main__":
    unittest.main()
