# SPDX-License-Identifier: BSD-3-Clause
"""The bench's table: rows of studies and of others, medians, ranks, and what it refuses."""

import csv
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from ergocast.bench import table

LAWS = Path(table.__file__).resolve().parent / "laws"
MEASURES = "ergodic_metric,detection_probability,time_to_half_s,time_to_four_fifths_s,sliced_wasserstein_m,greatest_age_s,path_m"
STUDY = f"scenario,agents.random_count,law.kind,seed,agents,{MEASURES}\n"


class Table(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "ring").mkdir()
        rows = [("COVER", seed, f"{1e-4 * seed}", 0.8, 100) for seed in range(1, 8)]
        rows += [("laws/smc.py:FirstOrder", seed, f"{1e-3 * seed}", 0.8, "inf") for seed in range(1, 8)]
        self.write("ring/study.csv", STUDY + "".join(
            f"ring,4,{law},{seed},4,{metric},{found},50,{late},10,,9000\n" for law, seed, metric, found, late in rows))

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return str(self.folder / name)

    def run_with(self, *files):
        return subprocess.run([sys.executable, "-m", "ergocast.bench.table", self.folder, *files], capture_output=True, text=True)

    def cells(self):
        with (self.folder / "bench.csv").open() as opened:
            return {(row["law"], row["measure"]): row for row in csv.DictReader(opened)}

    def test_medians_intervals_and_ranks(self):
        self.assertEqual(self.run_with().returncode, 0)
        cells = self.cells()
        best = cells["COVER", "ergodic_metric"]
        # With seven values the interval of 95 % reaches from the smallest to the largest.
        self.assertEqual([best[key] for key in ("runs", "median", "low", "high", "rank")],
                         ["7", "0.0004", "0.0001", "0.0007", "best"])
        self.assertEqual(cells["SMC", "ergodic_metric"]["rank"], "")
        self.assertEqual(cells["SMC", "detection_probability"]["rank"], "near")
        self.assertEqual(cells["SMC", "time_to_four_fifths_s"]["median"], "inf")
        self.assertEqual(cells["COVER", "greatest_age_s"]["median"], "")
        self.assertIn(f"--law {LAWS}/smc.py:FirstOrder {table.targets()['ring']} "
                      "--set agents.random_count=4 --seed 1", cells["SMC", "ergodic_metric"]["command"])
        page = (self.folder / "bench.html").read_text()
        self.assertIn(f'<td class="best" title="7 runs; one of them: ergocast run {table.targets()["ring"]}', page)
        self.assertIn("4.00e-04<br>[1.00e-04, 7.00e-04]", page)

    def test_the_published_tables_are_those_of_the_published_rows(self):
        (self.folder / "ring/study.csv").unlink()
        result = self.run_with(LAWS.parent / "published.csv")
        self.assertEqual(result.returncode, 0, result.stderr)
        page = (LAWS.parents[3] / "docs/results/bench.md").read_text()
        for text in (self.folder / "bench.md").read_text().split("\n\n"):
            self.assertIn(text.strip(), page)
        runs = len((self.folder / "rows.csv").read_text().splitlines()) - 1
        self.assertIn(f"\n{runs} runs", page)

    def test_rows_of_others_stand_beside_them(self):
        file = self.write("theirs.csv", "target,agents,law,seed,ergodic_metric\nring,4,THEIRS <b>,1,5e-5\nring,4,COVER,1,9\n")
        result = self.run_with(file)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 added rows left out", result.stderr)
        cells = self.cells()
        self.assertEqual(cells["THEIRS <b>", "ergodic_metric"]["rank"], "best")
        self.assertEqual(cells["COVER", "ergodic_metric"]["rank"], "")
        self.assertEqual(cells["COVER", "ergodic_metric"]["median"], "0.0004")
        self.assertEqual(cells["THEIRS <b>", "detection_probability"]["median"], "")
        self.assertEqual(cells["THEIRS <b>", "ergodic_metric"]["command"], "rows of theirs.csv")
        self.assertNotIn("<b>", (self.folder / "bench.html").read_text())

    def test_rows_of_targets_that_were_not_run_are_left_out(self):
        file = self.write("theirs.csv", "target,agents,law,seed,ergodic_metric\nlake,4,THEIRS,1,5e-5\nring,4,THEIRS,1,5e-5\n")
        result = self.run_with(file)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 added rows left out: their targets were not run here", result.stderr)
        self.assertIn(("THEIRS", "ergodic_metric"), self.cells())
        self.assertNotIn("lake", (self.folder / "rows.csv").read_text())

    def test_its_own_rows_can_be_added_to_another_bench(self):
        self.run_with()
        rows = (self.folder / "rows.csv").read_text()
        (self.folder / "ring" / "study.csv").unlink()
        file = self.write("before.csv", rows)
        self.assertEqual(self.run_with(file).returncode, 0)
        self.assertEqual((self.folder / "rows.csv").read_text(), rows)

    def test_bad_rows_are_refused_with_line_field_and_remedy(self):
        head = "target,agents,law,seed,ergodic_metric\n"
        for text, why in (
            ("target,agents,seed\n", "theirs.csv:1: there is no column law"),
            (head.replace("ergodic_metric", "phi2"), "'phi2' is no column of the bench (it has ergodic_metric"),
            (head + "square,4,A,1,1\n", "theirs.csv:2: 'square' is no target of the bench (it has box, four_peaks, lake"),
            (head + "ring,four,A,1,1\n", "theirs.csv:2: agents 'four' is no whole number"),
            (head + "ring,4,A,-1,1\n", "theirs.csv:2: seed '-1' is no whole number"),
            (head + "ring,4, ,1,1\n", "theirs.csv:2: the row names no law"),
            (head + "ring,4,A,1\n", "theirs.csv:2: expected 5 cells"),
            (head + "ring,4,A,1,1,2\n", "theirs.csv:2: expected 5 cells"),
            (head + "ring,4,A,1,nan\n", "theirs.csv:2: ergodic_metric: 'nan' is no number of 0 or more"),
            (head + "ring,4,A,1,-1\n", "theirs.csv:2: ergodic_metric: '-1' is no number of 0 or more"),
        ):
            with self.subTest(why):
                result = self.run_with(self.write("theirs.csv", text))
                self.assertEqual(result.returncode, 1)
                self.assertIn(why, result.stderr)
                self.assertNotIn("Traceback", result.stderr)

    def test_an_empty_folder_is_refused(self):
        (self.folder / "ring" / "study.csv").unlink()
        self.assertIn("has no study with a row", self.run_with().stderr)


if __name__ == "__main__":
    unittest.main()
