# SPDX-License-Identifier: BSD-3-Clause
"""`ergocast bench`: a law of one's own beside the others, continuation, parts, and what it refuses."""

import csv
import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

COMMAND = Path(os.environ["ERGOCAST_BIN_DIR"]) / "ergocast"
STAY = """
import ergocast
import numpy as np


class Stay(ergocast.Law):
    def wanted_mps(self, now):
        return np.zeros_like(now.x_m)


class Broken(ergocast.Law):
    def wanted_mps(self, now):
        if now.mission.seed == 2:
            raise ValueError("a fault of the law")
        return np.zeros_like(now.x_m)
"""


class Bench(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.law = self.folder / "my law.py"
        self.law.write_text(STAY)
        self.out = self.folder / "bench"

    def bench(self, *words, out=None, program=COMMAND, **options):
        return subprocess.run([program, "bench", "--out", out or self.out, *map(str, words)],
                              capture_output=True, text=True, cwd=self.folder, **options)

    def own(self, *words, seeds="1:2", law="Stay", **options):
        return self.bench("--own", "--law", f"my law.py:{law}", "--agents", 1, "--seeds", seeds,
                          "--only", "one_peak", *words, **options)

    def rows(self, out=None):
        with ((out or self.out) / "rows.csv").open() as file:
            return [(row["target"], row["agents"], row["law"], row["seed"]) for row in csv.DictReader(file)]

    def test_a_law_of_ones_own_stands_beside_the_published_rows(self):
        result = self.bench("--own", "--law", "my law.py:Stay", "--agents", 4, "--seeds", "1:2", "--only", "ring",
                            "--published")
        self.assertEqual(result.returncode, 0, result.stderr)
        table = (self.out / "bench.md").read_text()
        # Printed: with intervals, a line for each law.
        self.assertRegex(result.stdout, r"\| COVER \| 6 \| \*\*8.56e-05 \[\d.\d\de-05, \d.\d\de-0\d\]\*\* \|")
        self.assertRegex(result.stdout, r"\| Stay \| 2 \| \d.\d\de-0\d \[")
        heading = next(line for line in table.splitlines() if "φ²" in line)
        self.assertIn("| COVER |", heading)
        self.assertTrue(heading.endswith("| Stay |"), heading)
        self.assertIn(("ring", "4", "COVER", "1"), self.rows())
        self.assertIn(("ring", "4", "Stay", "2"), self.rows())
        page = (self.out / "bench.html").read_text()
        self.assertIn(f"/usr/bin/python3 -m ergocast --law {self.law.resolve()}:Stay ", page)

    def test_the_same_command_goes_on_also_with_more_seeds(self):
        self.assertEqual(self.own(seeds="1:1").returncode, 0)
        before = (self.out / "one_peak/study.csv").read_text()
        result = self.own(seeds="1:2")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.out / "one_peak/study.csv").read_text().startswith(before))
        self.assertEqual([row[3] for row in self.rows()], ["1", "2"])
        self.assertIn("1 runs done now, 2 in", (self.out / "one_peak.txt").read_text())

    def test_parts_in_one_folder_are_the_whole(self):
        for part in ("1/2", "2/2"):
            result = self.own("--shard", part, seeds="1:3")
            self.assertEqual(result.returncode, 0, result.stderr)
        whole = self.folder / "whole"
        self.assertEqual(self.own(seeds="1:3", out=whole).returncode, 0)
        self.assertEqual(len(self.rows()), 3)
        self.assertEqual((self.out / "rows.csv").read_text(), (whole / "rows.csv").read_text())

    def test_laws_of_papers_keep_their_names(self):
        result = self.bench("--only", "box", "--agents", 1, "--seeds", "1:1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual({row[2] for row in self.rows()},
                         {"COVER", "MOW", "SMC", "SMC2", "KERNEL", "RECEDING", "D2OC", "WALK", "WAYPOINTS"})

    def test_runs_that_fail_are_left_out_and_named(self):
        result = self.own(law="Broken")
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn("a fault of the law", result.stderr)
        self.assertIn("some runs failed", result.stdout)
        self.assertEqual([row[3] for row in self.rows()], ["1"])

    def test_an_end_by_signal_keeps_what_is_done(self):
        words = [COMMAND, "bench", "--out", self.out, "--own", "--law", "my law.py:Stay", "--agents", "1",
                 "--seeds", "1:100000", "--only", "one_peak,ring", "--jobs", "1"]
        bench = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder)
        study = self.out / "one_peak/study.csv"
        while bench.poll() is None and not (study.exists() and study.read_text().count("\n") > 1):
            time.sleep(0.05)
        bench.send_signal(signal.SIGTERM)
        said, errors = bench.communicate()
        self.assertEqual(bench.returncode, 0, errors)
        self.assertIn("stopped: the same command goes on", said)
        self.assertEqual(len(self.rows()), study.read_text().count("\n") - 1)
        self.assertFalse((self.out / "ring").exists())

    def test_what_it_refuses(self):
        (self.folder / "rows.csv").write_text("target,agents,seed\n")
        (self.folder / "twin.py").write_text(STAY)
        for words, why in (
            (("--only", "square"), "there is no target 'square' (it has box, four_peaks, lake"),
            (("--law", "none.py:Stay"), "--law none.py:Stay: there is no such file (give FILE.py:CLASS)"),
            (("--law", "my law.py:Stay", "--law", "twin.py:Stay"), "two laws are named Stay (rename your class)"),
            (("--add", "rows.csv"), "rows.csv:1: there is no column law"),
            (("--own",), "--own requires --law"),
            (("--agents", "0"), "--agents"),
        ):
            with self.subTest(why):
                result = self.bench("--only", "one_peak", "--agents", 1, "--seeds", "1:1", *words)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(why, result.stderr)
                self.assertNotIn("Traceback", result.stderr)
                self.assertFalse(self.out.exists())

    def test_says_what_is_missing(self):
        planted = self.folder / "planted"
        planted.mkdir()
        (planted / "ergocast.py").write_text("raise ModuleNotFoundError(name='ergocast')\n")
        # Apart from its build, the command finds what is installed or named.
        program = shutil.copy(COMMAND, planted)
        result = self.bench(program=program, env={**os.environ, "PYTHONPATH": str(planted)})
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertEqual(result.stderr, "no bench: it needs python3-ergocast; as root: "
                                        "apt-get install python3-ergocast\n")


if __name__ == "__main__":
    unittest.main()
