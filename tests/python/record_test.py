# SPDX-License-Identifier: BSD-3-Clause
"""Records and simulations in Python, against the command and against the files' bytes."""

import csv
import json
import os
import shutil
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import ergocast

SCENARIO = Path(os.environ["ERGOCAST_SCENARIO_DIR"]) / "quadrimodal_corners.textproto"
COMMAND = Path(os.environ["ERGOCAST_BIN_DIR"]) / "ergocast"
SHORT = {"time.duration_s": 20, "law.noise_ceiling": 5}
# The parts of a record that depend on when and where it was made.
NOT_OF_THE_MISSION = {"summary.json", "report.html"}


def files_of(folder):
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file() and file.name not in NOT_OF_THE_MISSION
    }


def command(*arguments):
    return subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)


class WithRecord(unittest.TestCase):
    """A record made by Python, in a folder that is removed with the class."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.run_dir = cls.folder / "python"
        cls.run_ = ergocast.simulate(SCENARIO, seed=7, set=SHORT, out=cls.run_dir)


class SameAsTheCommand(WithRecord):
    def test_writes_the_bytes_that_the_command_writes(self):
        scenario = self.folder / "short.textproto"
        text = SCENARIO.read_text()
        for old, new in (("duration_s: 600", "duration_s: 20"), ("ceiling: 20", "ceiling: 5")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        scenario.write_text(text)
        simulated = command("simulate", scenario, "--seed", 7, "--out", self.folder / "command")
        self.assertEqual(simulated.returncode, 0, simulated.stderr)
        theirs, ours = files_of(self.folder / "command"), files_of(self.run_dir)
        self.assertEqual(list(ours), list(theirs))
        for name, content in theirs.items():
            self.assertEqual(ours[name], content, name)
        self.assertIn("trajectory.csv", ours)

    def test_verify_finds_no_difference(self):
        verified = command("verify", self.run_dir)
        self.assertEqual(verified.returncode, 0, verified.stdout + verified.stderr)

    def test_without_a_folder_it_leaves_nothing_and_is_the_same_run(self):
        with tempfile.TemporaryDirectory() as own, mock.patch("tempfile.tempdir", own):
            run = ergocast.simulate(SCENARIO, seed=7, set=SHORT)
            self.assertEqual(os.listdir(own), [])
        self.assertTrue(run.trajectory.equals(self.run_.trajectory))
        self.assertTrue(run.metrics.equals(self.run_.metrics))

    def test_several_threads_fly_at_once(self):
        runs = {}

        def simulate(seed):
            runs[seed] = ergocast.simulate(SCENARIO, seed=seed, set={"time.duration_s": 5})

        threads = [threading.Thread(target=simulate, args=(seed,)) for seed in (1, 2, 1, 3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        alone = ergocast.simulate(SCENARIO, seed=2, set={"time.duration_s": 5})
        self.assertTrue(runs[2].trajectory.equals(alone.trajectory))
        self.assertFalse(runs[1].trajectory.equals(alone.trajectory))


class Loaded(WithRecord):
    def test_frames_hold_the_doubles_of_the_files(self):
        for name, frame in (("trajectory", self.run_.trajectory), ("metrics", self.run_.metrics)):
            with open(self.run_dir / f"{name}.csv", newline="") as file:
                rows = list(csv.reader(file))
            self.assertEqual(list(frame.columns), rows[0])
            self.assertEqual(frame.values.tolist(), [[float(x) for x in row] for row in rows[1:]])
        self.assertEqual(self.run_.trajectory["tick"].dtype, np.int64)

    def test_coverage_at_each_recorded_tick_has_the_recorded_metric(self):
        mission, metrics = self.run_.mission, self.run_.metrics
        coverage = self.run_.coverage(metrics["tick"])
        self.assertEqual(coverage.shape, (len(metrics), 16, 16))
        for c, metric in zip(coverage, metrics["ergodic_metric"]):
            phi2 = ergocast.ergodic_metric(c, self.run_.mu, mission.basis, mission.domain)
            self.assertEqual(phi2, metric)
        self.assertTrue(np.array_equal(self.run_.coverage(), coverage[-1]))
        self.assertEqual(self.run_.ergodic_metric(), self.run_.summary["ergodic_metric"]["last"])

    def test_positions_by_tick(self):
        self.assertEqual(self.run_.agents, [0, 1, 2, 3])
        self.assertEqual(self.run_.positions_m.shape, (200, 4, 2))
        self.assertTrue(np.array_equal(self.run_.positions_m[0], self.run_.mission.starts_m))
        row = self.run_.trajectory.iloc[4 * 17 + 2]
        self.assertEqual(self.run_.velocities_mps[17, 2].tolist(), [row.vx_mps, row.vy_mps])

    def test_ideal_team_flies_the_same_bits(self):
        self.assertTrue(ergocast.IdealTeam.stands_for(self.run_.mission))
        team = ergocast.IdealTeam(self.run_.mission)
        for tick in range(200):
            self.assertTrue(np.array_equal(team.positions_m, self.run_.positions_m[tick]), tick)
            team.step()
            self.assertTrue(np.array_equal(team.velocities_mps, self.run_.velocities_mps[tick]))
        # The team adds up agent by agent, the record tick by tick.
        np.testing.assert_allclose(team.coverage, self.run_.coverage(), atol=1e-14)

    def test_members_alone_count(self):
        copy = self.folder / "left"
        shutil.copytree(self.run_dir, copy)
        text = (copy / "summary.json").read_text()
        (copy / "summary.json").write_text(text.replace('"active_until": null', '"active_until": 5', 1))
        left = ergocast.load(copy)
        self.assertTrue(np.array_equal(left.coverage(4), self.run_.coverage(4)))
        self.assertFalse(np.array_equal(left.coverage(5), self.run_.coverage(5)))

    def test_segments_are_one_table(self):
        copy = self.folder / "segments"
        shutil.copytree(self.run_dir, copy)
        for name in ("trajectory", "metrics"):
            lines = (copy / f"{name}.csv").read_text().splitlines(keepends=True)
            half = len(lines) // 2
            (copy / f"{name}.csv").write_text("".join(lines[:half]) + lines[half][:-3])
            (copy / f"{name}-001.csv").write_text(lines[0] + "".join(lines[half:]))
        self.assertTrue(ergocast.load(copy).trajectory.equals(self.run_.trajectory))

    def test_a_run_without_summary_and_density(self):
        copy = self.folder / "bare"
        shutil.copytree(self.run_dir, copy)
        (copy / "summary.json").unlink()
        (copy / "target_density.csv").unlink()
        bare = ergocast.load(copy)
        self.assertEqual(bare.summary, {})
        self.assertIsNone(bare.target_density)
        self.assertTrue(np.array_equal(bare.coverage(), self.run_.coverage()))


def target_hash(mu):
    """target_hash() of core/mission/amendments.h."""
    h = 1
    for bits in np.ravel(mu).view(np.uint64):
        h = (h ^ int(bits)) * 0x9E3779B97F4A7C15 % 2**64
        h ^= h >> 29
    return f"{h:016x}"


class ChangedTarget(WithRecord):
    """The record, as if its target had changed at tick 50, and another one had been void."""

    FROM = 50

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.mu = cls.run_.mu.copy()
        cls.mu[1::2] *= 0.5
        cls.mu[:, 1::2] += 0.01
        amendments = [
            {"number": 0, "from_tick": 20, "mu": cls.run_.mu / 2 + (np.arange(256) == 0).reshape(16, 16) / 2,
             "void": True},
            {"number": 0, "from_tick": cls.FROM, "mu": cls.mu},
        ]
        for one in amendments:
            mu = one.pop("mu")
            one |= {"kind": "target", "t_s": 0, "hash": target_hash(mu), "target": np.ravel(mu).tolist()}
        cls.changed = cls.folder / "changed"
        shutil.copytree(cls.run_dir, cls.changed)
        text = json.dumps({"holds": [], "amendments": amendments})
        (cls.changed / "amendments.json").write_text(text)

    def test_each_moment_counts_against_the_target_of_its_time(self):
        run, plan = ergocast.load(self.changed), self.run_
        before, after = plan.coverage([self.FROM - 1, 120]), run.coverage([self.FROM - 1, 120])
        self.assertTrue(np.array_equal(after[0], before[0]))
        share = (121 - self.FROM) / 121
        np.testing.assert_allclose(after[1], before[1] - share * (self.mu - plan.mu), atol=1e-14)

    def test_a_damaged_list_is_refused(self):
        copy = self.folder / "damaged"
        shutil.copytree(self.changed, copy)
        text = (copy / "amendments.json").read_text()
        (copy / "amendments.json").write_text(text.replace("[1.0, ", "[1.0, 7, ", 1))
        with self.assertRaisesRegex(ergocast.RecordError, "amendments.json: entry 0: .*remove it"):
            ergocast.load(copy)

    def exported(self, run_dir, form, name):
        done = command("export", run_dir, "--to", form, "--out", self.folder / name)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.folder / name

    def test_tables_have_the_last_target(self):
        table = self.exported(self.changed, "csv", "tables") / "density.csv"
        rows = list(csv.DictReader(table.open()))[::97]
        twice = np.where(np.arange(16) > 0, 2, 1)
        for row in rows:
            x, y = (np.cos(np.arange(16) * np.pi * float(row[c]) / 2000) * twice for c in ("x_m", "y_m"))
            self.assertAlmostEqual(float(row["target"]), x @ self.mu @ y, delta=1e-9)

    def test_mcap_has_each_target_in_its_time(self):
        grids = [
            self.exported(run_dir, "mcap", name).read_bytes().count(b'"column_count"')
            for run_dir, name in ((self.run_dir, "plan.mcap"), (self.changed, "changed.mcap"))
        ]
        self.assertEqual(grids[1], grids[0] + 1)


class InTheModesOfTheFreeDomain(unittest.TestCase):
    TWO_ROOMS = """
        domain { size_x_m: 100 size_y_m: 50 }
        target { gaussians { mean_x_m: 80 mean_y_m: 20 sigma_m: 5 } }
        basis { modes_x: 5 modes_y: 4 free_domain: true }
        law { u_max_mps: 5 }
        time { dt_s: 0.1 duration_s: 10 pace: LOCKSTEP }
        agents { starts { x_m: 10 y_m: 20 } starts { x_m: 90 y_m: 30 } }
        world {
          speed_limit_mps: 20 wall_clearance_m: 1
          walls { vertices { x_m: 49.8 y_m: 10 } vertices { x_m: 50.2 y_m: 10 }
                  vertices { x_m: 50.2 y_m: 60 } vertices { x_m: 49.8 y_m: 60 } }
        }"""

    def test_the_basis_says_so_and_the_metric_is_the_recorded_one(self):
        with tempfile.TemporaryDirectory() as folder:
            scenario = Path(folder) / "rooms.textproto"
            scenario.write_text(self.TWO_ROOMS)
            run = ergocast.simulate(scenario)
            cosines = ergocast.compile_mission(scenario, set={"basis.free_domain": False})
        self.assertTrue(run.mission.basis.free_domain)
        self.assertFalse(cosines.basis.free_domain)
        self.assertFalse(ergocast.Basis(5, 4).free_domain)
        recorded = run.summary["ergodic_metric"]
        self.assertEqual(recorded["basis"], "modes of the free domain")
        self.assertEqual(run.ergodic_metric(), recorded["last"])
        self.assertEqual(run.metrics["ergodic_metric"].iloc[-1], recorded["last"])
        self.assertNotEqual(run.summary["ergodic_metric_in_cosines"]["last"], recorded["last"])
        self.assertFalse(np.array_equal(run.mu, cosines.mu))
        for agent in run.summary["agents"]:
            self.assertEqual(agent["ergodic_metric_basis"], recorded["basis"])


class Refused(WithRecord):
    """An error in a record or a scenario raises one exception with the place and the remedy."""

    def damaged(self, file, change):
        copy = self.folder / f"damaged-{self.id()}"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.run_dir, copy)
        change(copy / file)
        with self.assertRaises(ergocast.RecordError) as caught:
            ergocast.load(copy)
        return str(caught.exception).replace(str(copy), "RUN")

    def replaced(self, old, new, line=0):
        def change(file):
            lines = file.read_text().splitlines(keepends=True)
            self.assertIn(old, lines[line])
            lines[line] = lines[line].replace(old, new, 1)
            file.write_text("".join(lines))

        return change

    def test_no_run_directory(self):
        with self.assertRaisesRegex(ergocast.RecordError, "nowhere/plan.binpb: missing .*directory"):
            ergocast.load(self.folder / "nowhere")

    def test_a_word_in_a_table(self):
        said = self.damaged("trajectory.csv", self.replaced(",2,", ",two,", line=3))
        self.assertRegex(said, r"^RUN/trajectory.csv:4: .*two.*whose agent is no number: copy the file again")

    def test_too_few_columns(self):
        change = lambda file: file.write_text(file.read_text().rsplit(",", 2)[0] + "\n")
        said = self.damaged("metrics.csv", change)
        self.assertRegex(said, r"^RUN/metrics.csv:\d+: .*whose contributions_lost is no number: copy the")

    def test_a_foreign_header(self):
        said = self.damaged("trajectory.csv", self.replaced("x_m", "east"))
        self.assertRegex(said, r"^RUN/trajectory.csv.*tick,t_s,agent,x_m")

    def test_ticks_that_go_back(self):
        said = self.damaged("trajectory.csv", self.replaced("1,", "0,", line=5))
        self.assertRegex(said, r"^RUN/trajectory.csv:6: the tick or its time does not follow")

    def test_ticks_beyond_the_plan(self):
        def change(file):
            with open(file, "a") as table:
                table.write("200,20,0,1,1,0,0\n")

        said = self.damaged("trajectory.csv", change)
        self.assertRegex(said, r"^RUN/trajectory.csv: tick: agent 0 .*200.*copy plan.binpb")

    def test_a_damaged_plan(self):
        said = self.damaged("plan.binpb", lambda file: file.write_bytes(file.read_bytes()[:-9]))
        self.assertRegex(said, r"^RUN/plan.binpb: ")

    def test_a_summary_that_is_no_json(self):
        said = self.damaged("summary.json", lambda file: file.write_text("{\n  nonsense"))
        self.assertRegex(said, r"^RUN/summary.json: is not JSON.* line 2, column.*: copy it again")

    def test_a_summary_that_is_a_list(self):
        said = self.damaged("summary.json", lambda file: file.write_text("[1, 2]"))
        self.assertRegex(said, r"^RUN/summary.json:1: is no object: copy it again")

    def test_a_pipe(self):
        def change(file):
            file.unlink()
            os.mkfifo(file)

        self.assertRegex(self.damaged("trajectory.csv", change), r"^RUN/trajectory.csv: ")

    def test_a_summary_with_other_members(self):
        copy = self.folder / "members"
        shutil.copytree(self.run_dir, copy)
        (copy / "summary.json").write_text('{"agents": [{"id": 0}]}')
        with self.assertRaisesRegex(ergocast.RecordError, "summary.json: agents: .*active_from"):
            ergocast.load(copy).coverage()

    def test_fields_have_the_errors_of_vary(self):
        for path, value in (("law.epsilom", 1), ("law.epsilon", "much"), ("law", 1), ("name", "x"),
                            ("agents.starts[9].x_m", 0), ("law.epsilon", -1)):
            with self.assertRaises(ergocast.ScenarioError) as caught:
                ergocast.simulate(SCENARIO, set={path: value})
            study = command("study", SCENARIO, "--vary", f"{path}={value}", "--seeds", "1:1",
                            "--out", self.folder / "study")
            self.assertEqual(study.returncode, 2)
            ours = str(caught.exception).replace("set ", "--vary ")
            self.assertIn(ours, study.stderr)
            self.assertEqual(len(caught.exception.problems), 1)

    def test_all_problems_at_once(self):
        with self.assertRaises(ergocast.ScenarioError) as caught:
            ergocast.compile_mission(SCENARIO, set={"law.epsilon": -1, "basis.modes_x": 1000})
        self.assertEqual(len(caught.exception.problems), 2)

    def test_a_scenario_that_is_not_there(self):
        with self.assertRaisesRegex(ergocast.ScenarioError, "no_such_name.*quadrimodal|no_such_name"):
            ergocast.simulate("no_such_name")
        with self.assertRaises(ergocast.ScenarioError):
            ergocast.simulate(self.folder / "no.textproto")
        with self.assertRaisesRegex(ergocast.ScenarioError, "seed=-1"):
            ergocast.simulate(SCENARIO, seed=-1)

    def test_a_folder_that_is_taken(self):
        with self.assertRaisesRegex(ergocast.RecordError, "is not empty; give a new folder"):
            ergocast.simulate(SCENARIO, set=SHORT, out=self.run_dir)

    def test_errors_are_value_errors(self):
        self.assertTrue(issubclass(ergocast.ScenarioError, ValueError))
        self.assertTrue(issubclass(ergocast.RecordError, ValueError))


if __name__ == "__main__":
    unittest.main()
