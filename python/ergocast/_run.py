# SPDX-License-Identifier: BSD-3-Clause
"""Records of missions as arrays and frames."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, overload

import numpy as np
import numpy.typing as npt
import pandas as pd

from ergocast import _native
from ergocast._errors import RecordError, raised_as

Floats = npt.NDArray[np.float64]

_END = 2**62


class Run:
    """The record of a mission: the contents of its run directory.

    Frames have the columns of the files, as docs/run_directory.md describes them. Arrays of
    coefficients have the shape (modes_x, modes_y), in a box (modes_z, modes_x, modes_y). All files
    are read when the run is loaded, so its directory may be removed afterwards.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        with raised_as(RecordError):
            self._record = _native.Record(os.fspath(path))
            self.summary: dict[str, Any] = self._read_summary()
            self.target_density: Floats | None = self._record.target_density()
        """The target density in multiples of the uniform one: entry (i, j) belongs to cell i along
        x and j along y, both from the lower left. None if the record has none."""

    def __repr__(self) -> str:
        return f"<ergocast.Run {self.name} in {self.path}, {len(self.trajectory)} rows>"

    @property
    def mission(self) -> _native.Mission:
        """The recorded mission: domain, basis, law, seed."""
        return self._record.mission

    @property
    def name(self) -> str:
        """Name of the scenario."""
        return self.mission.name

    @property
    def mu(self) -> Floats:
        """μ of the target in mission.basis, (3): shape (modes_x, modes_y)."""
        return self.mission.mu

    @cached_property
    def trajectory(self) -> pd.DataFrame:
        """trajectory.csv with all its segments: a row for each tick and agent, in this order.

        Columns: tick, t_s [s], agent, x_m, y_m [m], vx_mps, vy_mps [m/s]; in a box also z_m, vz_mps.
        """
        return pd.DataFrame(self._record.trajectory())

    @cached_property
    def metrics(self) -> pd.DataFrame:
        """metrics.csv with all its segments: a row for each mission second.

        Columns: tick, t_s [s], ergodic_metric (φ²), detection_probability, metric_spread,
        max_staleness_s [s], contributions_received, contributions_lost, blocked_share. φ² is in the modes that agents
        steer by: those of the free domain if mission.basis.free_domain, else cosines.
        """
        return pd.DataFrame(self._record.metrics())

    @property
    def agents(self) -> list[int]:
        """The numbers of the agents that have rows, ascending."""
        return [int(agent) for agent in np.unique(self.trajectory["agent"])]

    @property
    def positions_m(self) -> Floats:
        """The positions of agents(): shape (ticks, agents, d) [m]; index 0 is tick 0; nan: no row.

        d is 2, in a box 3.
        """
        return self._by_tick("{}_m")

    @property
    def velocities_mps(self) -> Floats:
        """The velocities applied from each tick on: shape (ticks, agents, d) [m/s]."""
        return self._by_tick("v{}_mps")

    @overload
    def coverage(self, tick: int | None = None) -> Floats: ...
    @overload
    def coverage(self, tick: Sequence[int] | npt.NDArray[np.integer[Any]]) -> Floats: ...

    def coverage(self, tick: Any = None) -> Floats:
        """c of (4) over the ticks 0 … tick, from the true positions of the team's members.

        tick: one number (default: the last recorded), or several that ascend.
        Returns (modes_x, modes_y), or (len(tick), modes_x, modes_y); 0 before the first row.
        metrics.ergodic_metric is φ² of these numbers, bit for bit, in a record of one membership.
        If the target changed to μ at some tick, mission.mu + mean of f − μ(t): each moment counts
        against the target of its own time. With law.history KEEP, mission.mu + mean of f − μ, for
        the μ of that tick.
        Raises ValueError if ticks descend.
        """
        one = tick is None or np.ndim(tick) == 0
        last = _END if tick is None else tick
        ticks = [int(t) for t in np.atleast_1d(np.asarray(last))]
        coverage = self._record.coverage(ticks, self._members())
        result: Floats = coverage[0] if one else coverage
        return result

    def ergodic_metric(self, tick: int | None = None) -> float:
        """φ² of coverage(tick) against the target, in mission.basis.

        It uses modes of the free domain if mission.basis.free_domain, else cosines;
        summary["ergodic_metric_in_cosines"] compares missions with either basis.
        """
        mission = self.mission
        return _native.ergodic_metric(
            self.coverage(tick), mission.mu, mission.basis, mission.domain
        )

    def _by_tick(self, name: str) -> Floats:
        rows = self.trajectory
        columns = [name.format(axis) for axis in "xyz" if name.format(axis) in rows]
        agents = self.agents
        ticks = 0 if rows.empty else int(rows["tick"].max()) + 1
        table = np.full((ticks, len(agents), len(columns)), np.nan)
        column = np.searchsorted(agents, rows["agent"])
        table[rows["tick"], column] = rows[columns]
        return table

    def _read_summary(self) -> dict[str, Any]:
        text = self._record.summary()
        summary = {} if text is None else json.loads(text)
        if not isinstance(summary, dict):
            raise RecordError(
                f"{self.path / 'summary.json'}:1: is no object: copy it again from where the run "
                "was recorded, or remove it"
            )
        return summary

    def _members(self) -> list[tuple[int, int, int]] | None:
        """(agent, first tick, first tick without it), from the summary; None: all count."""
        agents = self.summary.get("agents")
        if agents is None:
            return None
        try:
            return [
                (
                    int(agent["id"]),
                    int(agent["active_from"]),
                    _END if agent["active_until"] is None else int(agent["active_until"]),
                )
                for agent in agents
            ]
        except (KeyError, TypeError, ValueError) as error:
            raise RecordError(
                f"{self.path / 'summary.json'}: agents: {error!r} in an entry that needs id, "
                "active_from and active_until: copy it again from where the run was recorded, "
                "or remove it"
            ) from None


def load(run_dir: str | os.PathLike[str]) -> Run:
    """Reads the run directory that `ergocast run`, `simulate` or simulate() wrote.

    Raises RecordError, which names file, line and field, for a damaged directory or one
    of another kind. A last line without its line break comes from a killed process and does not
    count.
    """
    return Run(run_dir)
