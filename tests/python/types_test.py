# SPDX-License-Identifier: BSD-3-Clause
"""The types of the package: complete, equal to those of the C++ part, and useful to callers.

types_test.py FOLDER: mypy's cache is in FOLDER.
"""

import re
import subprocess
import sys
import unittest
from pathlib import Path

import ergocast
from ergocast import plot

PACKAGE = Path(ergocast.__file__).parent
FOLDER = Path(sys.argv.pop())
# Laws of the bench are written as a person writes one; its table reads cells of any kind.
CONFIGURATION = """[mypy]
strict = True
[mypy-ergocast.bench.laws.*]
ignore_errors = True
[mypy-ergocast.bench.*]
allow_untyped_defs = True
check_untyped_defs = False
allow_untyped_calls = True
[mypy-pandas.*]
ignore_missing_imports = True
[mypy-matplotlib.*]
ignore_missing_imports = True
"""


# Members that pybind11 gives every class, and classes that only C++ makes.
ALLOWED = """ergocast\\._native\\.[A-Z][A-Za-z]*
ergocast\\._native\\.(ControlLaw|LawInput|Mission)\\.__init__
"""

GOOD = """
import numpy as np
import numpy.typing as npt
import ergocast
from ergocast import plot

run: ergocast.Run = ergocast.load("runs/one")
c: npt.NDArray[np.float64] = run.coverage(5)
many = run.coverage([1, 2])
phi2: float = run.ergodic_metric()
simulated = ergocast.simulate("x", seed=1, set={"law.epsilon": 0.2, "time.pace": "LOCKSTEP"}, out=None)
mu, error = ergocast.Target([ergocast.Gaussian((0, 0), sigma_m=1)]).coefficients(
    simulated.mission.domain, simulated.mission.basis
)
ax = plot.map(run, view="xy")
plot.metric({"ours": [run, simulated], "theirs": run}, ax)
plot.study("runs/noise", y="slope")
amended: ergocast.Amendment = ergocast.connect(key_file="k").amend(np.ones((2, 2)), at=10, dry_run=True)
ergocast.connect().amend({"uniform_weight": 1}, set={"target.uniform_weight": 0.1})
command: npt.NDArray[np.float64] = ergocast.Controller(run.mission).command(0, 0, (1.0, 2.0))
"""

# Each line from the second on is wrong.
BAD = """import ergocast
ergocast.simulate("x", seed="one")
ergocast.load("x").coverage("end")
x: int = ergocast.load("x").mission.dt_s
ergocast.Basis(1)
"""


def mypy(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", FOLDER / "mypy.ini", "--cache-dir",
         FOLDER / "mypy", *arguments],
        capture_output=True, text=True,
    )


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        (FOLDER / "mypy.ini").write_text(CONFIGURATION)

    def test_the_package_is_strictly_typed(self):
        self.assertTrue((PACKAGE / "py.typed").exists())
        checked = mypy("-p", "ergocast")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_callers_are_checked(self):
        self.assertEqual(mypy("-c", GOOD).stdout.splitlines()[-1], "Success: no issues found in 1 source file")
        errors = re.findall(r"^<string>:(\d+): error", mypy("-c", BAD).stdout, re.MULTILINE)
        self.assertEqual(sorted(set(errors)), ["2", "3", "4", "5"])

    def test_the_stub_is_true(self):
        (FOLDER / "allowed").write_text(ALLOWED)
        checked = subprocess.run(
            [sys.executable, "-m", "mypy.stubtest", "ergocast._native", "--allowlist", FOLDER / "allowed",
             "--ignore-missing-stub", "--mypy-config-file", FOLDER / "mypy.ini"],
            capture_output=True, text=True, cwd=FOLDER,
        )
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_everything_public_has_a_contract(self):
        public = [(module, name) for module in (ergocast, plot) for name in module.__all__]
        for module, name in public:
            thing = getattr(module, name)
            if name.startswith("__") or name.isupper():
                continue
            self.assertTrue(thing.__doc__, name)
            for member, value in vars(thing).items() if isinstance(thing, type) else ():
                if not member.startswith("_") and (callable(value) or hasattr(value, "fget")):
                    self.assertTrue(value.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
