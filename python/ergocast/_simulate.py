# SPDX-License-Identifier: BSD-3-Clause
"""Missions simulated in this process."""

from __future__ import annotations

import numbers
import os
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Union

import numpy as np

from ergocast import _native
from ergocast._errors import RecordError, ScenarioError, raised_as
from ergocast._law import LawLike, made
from ergocast._run import Run

Value = Union[bool, int, float, str, "np.generic"]
"""A number, a truth value, or one of a field's words."""


def simulate(
    scenario: str | os.PathLike[str],
    *,
    seed: int | None = None,
    set: Mapping[str, Value] | None = None,
    out: str | os.PathLike[str] | None = None,
    law: LawLike | None = None,
) -> Run:
    """Simulates a mission, as `ergocast simulate` does: the same bytes in the same files.

    scenario: a file, or the name of a shipped one.
    seed: other random numbers.
    set: fields and their values, such as {"law.epsilon": 0.2, "agents.starts[0].x_m": 3}; the
        paths and values of `ergocast study --vary`.
    out: a new folder, which becomes the run directory with its report; without it no file
        remains.
    law: one of your own in the place of the scenario's: an object of Law, its class, or
        "FILE.py:CLASS". What it raises ends the simulation, and leaves an incomplete record.

    Other threads can run meanwhile. Ctrl-C raises KeyboardInterrupt, and ends the mission in order,
    unless it interrupts `law`.
    Raises ScenarioError with all problems at once, RecordError if `out` cannot be used, LawError
    if the law wants what no agent may want.
    """
    compiled = _compile(scenario, seed, set)
    own, name = (None, "") if law is None else made(law)
    with raised_as(RecordError):
        if out is not None:
            compiled.simulate(os.fspath(out), True, own, name)
            return Run(out)
        with tempfile.TemporaryDirectory(prefix="ergocast-") as folder:
            run_dir = Path(folder) / "run"
            compiled.simulate(os.fspath(run_dir), False, own, name)
            return Run(run_dir)


def compile_mission(
    scenario: str | os.PathLike[str],
    *,
    seed: int | None = None,
    set: Mapping[str, Value] | None = None,
) -> _native.Mission:
    """The mission that simulate() would run: for IdealTeam, Controller and others.

    Parameters and errors as for simulate().
    """
    return _compile(scenario, seed, set).mission


def _compile(
    scenario: str | os.PathLike[str], seed: int | None, values: Mapping[str, Value] | None
) -> _native.Scenario:
    if seed is not None and not 0 <= seed < 2**64:
        raise ScenarioError(f"seed={seed}: is not a whole number from 0 to 2**64 - 1")
    with raised_as(ScenarioError):
        return _native.Scenario(_file(scenario), seed, fields_of(values))


def _file(scenario: str | os.PathLike[str]) -> str:
    """The file of a shipped scenario, if `scenario` is the name of one; else `scenario`."""
    name = os.fspath(scenario)
    if name.isidentifier() and not os.path.exists(name):
        for folder in shipped_folders():
            file = folder / f"{name}.textproto"
            if file.exists():
                return str(file)
    return name


def shipped_folders() -> list[Path]:
    """Where shipped scenarios may be: below the prefix of an installation, or in the source tree."""
    here = Path(__file__).resolve()
    return [here.parents[4] / "share/ergocast/scenarios", here.parents[2] / "scenarios"]


def fields_of(values: Mapping[str, Value] | None) -> list[tuple[str, str, str]]:
    """(path, value in a scenario's format, name in errors)."""
    fields = []
    for path, value in (values or {}).items():
        text = text_of(value)
        fields.append((path, text, f"set {path}={text}"))
    return fields


def text_of(value: Value) -> str:
    """A value in a scenario's format."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    return str(value)
