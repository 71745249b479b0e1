# SPDX-License-Identifier: BSD-3-Clause
"""Running teams: their state, and new targets for them. The command `ergocast` does the work."""

from __future__ import annotations

import json
import os
import re
import select
import shutil
import subprocess
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Union

import numpy as np
import numpy.typing as npt

from ergocast import _native
from ergocast._errors import ScenarioError, TeamError
from ergocast._simulate import Value, fields_of, text_of

Target = Union[npt.NDArray[Any], Mapping[str, Any], str, "os.PathLike[str]"]
"""A grid over the domain, a scenario's `target` as a dict or as text, or a file."""

_BAD_INPUT = 2
# Enumerations have words without quotation marks in a scenario's text.
_ENUMERATIONS = {"first_row"}
_NAMED = re.compile(
    r"^amendment (?P<number>\d+), (?:target|law) (?P<target>[0-9a-f]+)(?: \(.*\))?, "
    r"(?:holds since|held from) tick (?P<tick>\d+), t = (?P<t_s>[\d.]+) s(?:, until .*)?(?:, by .*)?$",
    re.MULTILINE,
)
_PLANNED = re.compile(
    r"(?:target|law) (?P<target>[0-9a-f]+),.*\n"
    r"(?:about (?P<moved>\d+) % of its mass|now the law is).*\n"
    r"it would be amendment (?P<number>\d+), at the earliest from tick (?P<tick>\d+), "
    r"t = (?P<t_s>[\d.]+) s"
)


@dataclass(frozen=True)
class Amendment:
    """A new target or another law of a running mission."""

    number: int
    """Its number among the amendments of the mission, from 0."""
    tick: int
    """From this tick on it holds, counted without ticks of pauses; after a dry run the earliest one."""
    t_s: float
    """The mission time of that tick [s]."""
    target: str
    """The hash of the target or law, as `ergocast amend --list` and amendments.json have it."""
    moved_share: float | None = None
    """After a dry run of a target: the share of the target's mass that is elsewhere than in the present target."""


class LiveRun:
    """A running mission. connect() finds it."""

    def __init__(self, options: Sequence[str]) -> None:
        self._options = list(options)

    def __repr__(self) -> str:
        return f"<ergocast.LiveRun {' '.join(self._options) or 'of this host'}>"

    def status(self) -> dict[str, Any]:
        """The state of the team now, as `ergocast status --json` prints it (docs/monitoring.md).

        Raises TeamError if no team is found, ScenarioError if several are.
        """
        answer = self._run("status", "--json")
        if not answer.stdout:
            _complain(answer.returncode, answer.stderr)
        status: dict[str, Any] = json.loads(answer.stdout)
        return status

    def watch(self) -> Iterator[dict[str, Any]]:
        """The state of the team each second of wall time, as status(), until the mission's end.

        It waits for the team. States that came while the caller was busy are left out, so each one
        is new. Raises TeamError if the mission fails, ScenarioError if several teams are found.
        """
        command = [_program(), "status", "--watch", "--json", *self._options]
        with tempfile.TemporaryFile("w+") as errors:
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=errors) as process:
                assert process.stdout is not None
                try:
                    for line in _newest_lines(process.stdout):
                        yield json.loads(line)
                    process.wait()
                finally:
                    process.terminate()
            if process.returncode > 0:
                errors.seek(0)
                _complain(process.returncode, errors.read() or "the mission has failed")

    def amend(
        self,
        target: Target | None = None,
        *,
        set: Mapping[str, Value] | None = None,
        at: float = 0,
        dry_run: bool = False,
    ) -> Amendment:
        """Gives the team a new target, as `ergocast amend` does, and returns once it holds.

        target: one of
            an array (nx, ny) of densities of at least 0 over the whole domain: entry [i, j] belongs
                to cell i along x and j along y, both from the lower left, as in Run.target_density;
            a dict with the fields of a scenario's target, such as
                {"gaussians": [{"mean_x_m": 30, "mean_y_m": 40, "sigma_m": 5}], "uniform_weight": 0.1};
            a scenario's text, such as "target { uniform_weight: 1 }";
            a file: a scenario, of which only the target counts, a map, GeoJSON or a drawing; or the
                name of a shipped scenario.
        set: fields of the target and their values, such as {"target.uniform_weight": 0.1}. Without
            `target` they change the scenario in the run's directory.
        at: how much later than necessary it shall hold, in the world's time, which a pause does not
            stop [s].
        dry_run: only checks the target; sends nothing.

        Raises ScenarioError if the target has problems, with all of them, or if several teams are
        found; TeamError if no team is found, or if it was not seen to obey.
        """
        with tempfile.TemporaryDirectory(prefix="ergocast-") as folder:
            command = ["amend", *_target_options(target, Path(folder))]
            for path, text, _ in fields_of(set):
                command += ["--set", f"{path}={text}"]
            return self._amend(command, at, dry_run)

    def amend_law(
        self,
        *,
        u_max_mps: float | None = None,
        noise_intensity: float | None = None,
        noise_ceiling: float | None = None,
        kind: str | None = None,
        at: float = 0,
        dry_run: bool = False,
    ) -> Amendment:
        """Gives the law another speed or noise, as `ergocast amend --law` does; returns once it holds.

        Numbers that are not named stay as they are. A speed is at most that of the plan.

        kind: only the agents of this kind.
        at, dry_run: as in amend().

        Raises ScenarioError if the mission cannot have these numbers, or if several teams are found;
        TeamError if no team is found, or if it was not seen to obey.
        """
        numbers = {
            "u_max_mps": u_max_mps,
            "noise_intensity": noise_intensity,
            "noise_ceiling": noise_ceiling,
        }
        command = ["amend"]
        for field, value in numbers.items():
            if value is not None:
                path = field if kind is None else f"{kind}.{field}"
                command += ["--law", f"{path}={float(value)!r}"]
        if len(command) == 1:
            raise ScenarioError("amend_law: name u_max_mps, noise_intensity or noise_ceiling")
        return self._amend(command, at, dry_run)

    def cancel(self, number: int) -> None:
        """Undoes an amendment, as `ergocast amend --cancel` does, and returns once that holds.

        What held before the newest target, end or law holds again; a zone ends.

        Raises TeamError if that is not possible, if no team is found, or if it was not seen to obey;
        ScenarioError if several teams are found.
        """
        answer = self._run("amend", "--cancel", str(int(number)))
        if answer.returncode:
            _complain(answer.returncode, answer.stderr)

    def _amend(self, command: list[str], at: float, dry_run: bool) -> Amendment:
        if at:
            command += ["--at", f"+{float(at)!r}s"]
        if dry_run:
            command.append("--dry-run")
        answer = self._run(*command)
        if answer.returncode:
            _complain(answer.returncode, answer.stderr)
        for line in answer.stderr.splitlines():
            warnings.warn(line.removeprefix("warning: "), stacklevel=3)
        return _amendment(answer.stdout, _PLANNED if dry_run else _NAMED)

    def _run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [_program(), *arguments, *self._options]
        return subprocess.run(command, capture_output=True, text=True)


def connect(
    run_id: str | None = None,
    *,
    lcm_url: str | None = None,
    key_file: str | os.PathLike[str] | None = None,
) -> LiveRun:
    """Names a running mission. Nothing is sent or received before one of its methods is called.

    run_id: the identifier, as `ergocast list` prints it. Default: your only live run on this host.
    lcm_url: the base URL of the team. Default: that of the run, or $LCM_DEFAULT_URL.
    key_file: the team's key; amend() needs the coordinator's. Default: that of the run.
    """
    options: list[str] = []
    for name, value in (("--run-id", run_id), ("--lcm-url", lcm_url), ("--key-file", key_file)):
        if value is not None:
            options += [name, os.fspath(value)]
    return LiveRun(options)


def _program() -> str:
    """The command of the package's own version, else the one on PATH."""
    here = Path(_native.__file__)
    # Below the prefix of an installation, or in the build folder.
    for folder in (here.parents[4] / "bin", here.parents[2] / "bin"):
        if (folder / "ergocast").is_file():
            return str(folder / "ergocast")
    found = shutil.which("ergocast")
    if found is None:
        raise TeamError("the command ergocast is not installed: apt-get install ergocast")
    return found


def _complain(code: int, text: str) -> None:
    problem = text.strip() or f"ergocast ended with code {code}"
    raise (ScenarioError if code == _BAD_INPUT else TeamError)(problem)


def _newest_lines(stream: IO[bytes]) -> Iterator[bytes]:
    """Each line of a pipe, but for those that have later ones behind them."""
    rest = b""
    while chunk := os.read(stream.fileno(), 1 << 16):
        rest += chunk
        while select.select([stream], [], [], 0)[0]:
            more = os.read(stream.fileno(), 1 << 16)
            if not more:
                break
            rest += more
        *lines, rest = rest.split(b"\n")
        if lines:
            yield lines[-1]


def _amendment(printed: str, form: re.Pattern[str]) -> Amendment:
    found = form.search(printed)
    if found is None:
        raise TeamError(f"{_program()} is of another version than this package: it has printed {printed!r}")
    moved = found.groupdict().get("moved")
    return Amendment(
        int(found["number"]),
        int(found["tick"]),
        float(found["t_s"]),
        found["target"],
        None if moved is None else int(moved) / 100,
    )


def _target_options(target: Target | None, folder: Path) -> list[str]:
    if target is None:
        return []
    file = folder / "target.textproto"
    if isinstance(target, np.ndarray):
        file = folder / "target.csv"
        _write_map(target, file)
    elif isinstance(target, Mapping):
        file.write_text("target {\n" + _fields_text(target) + "}\n")
    elif isinstance(target, str) and "{" in target:
        file.write_text(target)
    else:
        file = Path(os.fspath(target))
    return ["--target", str(file)]


def _write_map(grid: npt.NDArray[Any], file: Path) -> None:
    if grid.ndim != 2:
        raise ScenarioError(
            f"target: an array of shape {grid.shape} is no grid over a plane: give an array (nx, ny); "
            "for a box, give the text of a scenario that names a NetCDF file"
        )
    # In the file the north is first, and x grows along a line.
    np.savetxt(file, np.flipud(np.asarray(grid, dtype=float).T), delimiter=",", fmt="%.17g")


def _fields_text(message: Mapping[str, Any]) -> str:
    """The fields of a dict as a scenario's text. Files are relative to the present folder."""
    lines = []
    for name, value in message.items():
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if isinstance(one, Mapping):
                lines.append(f"{name} {{\n{_fields_text(one)}}}\n")
            elif isinstance(one, (str, os.PathLike)) and name not in _ENUMERATIONS:
                text = os.path.abspath(one) if name == "file" else os.fspath(one)
                lines.append(f"{name}: {json.dumps(text, ensure_ascii=False)}\n")
            else:
                lines.append(f"{name}: {text_of(one)}\n")
    return "".join(lines)

