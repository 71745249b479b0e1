# SPDX-License-Identifier: BSD-3-Clause
"""Ergodic coverage by teams of agents: records, simulations, running teams, and the method.

load() reads a run directory, simulate() simulates a mission, connect() names a running one, Law is a
law of your own. The
classes of the method are those of the C++ code, and compute the same bits. docs/python.md is the
introduction.
"""

from ergocast._errors import ErgocastError, LawError, RecordError, ScenarioError, TeamError
from ergocast._law import Law
from ergocast._live import Amendment, LiveRun, connect
from ergocast._native import (
    Basis,
    ControlLaw,
    Controller,
    CoverageTable,
    Domain,
    Gaussian,
    IdealTeam,
    LawInput,
    Mission,
    Region,
    Target,
    __version__,
    ergodic_metric,
)
from ergocast._run import Run, load
from ergocast._simulate import compile_mission, simulate

__all__ = [
    "Amendment",
    "Basis",
    "ControlLaw",
    "Controller",
    "CoverageTable",
    "Domain",
    "ErgocastError",
    "Gaussian",
    "IdealTeam",
    "Law",
    "LawError",
    "LawInput",
    "LiveRun",
    "Mission",
    "RecordError",
    "Region",
    "Run",
    "ScenarioError",
    "Target",
    "TeamError",
    "__version__",
    "compile_mission",
    "connect",
    "ergodic_metric",
    "load",
    "simulate",
]
