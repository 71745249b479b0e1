# SPDX-License-Identifier: BSD-3-Clause
"""Figures of runs and studies for papers, drawn by matplotlib.

map(), coverage(), metric() and study() return matplotlib axes, so that everything about them can be
changed. Without `ax` they make a figure for a column of a paper, with letters of 8 pt; with `ax` they
draw into it, in its own style. save() writes the figures of a run, for `ergocast report --figures`.
"""

from __future__ import annotations

import contextlib
import math
import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np
import numpy.typing as npt
import pandas as pd

import matplotlib.pyplot as plt  # sudo apt-get install python3-matplotlib
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path as Outline
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogFormatterSciNotation, LogLocator

from ergocast._errors import ErgocastError
from ergocast._interval import interval
from ergocast._native import Domain, Mission
from ergocast._run import Run, load

__all__ = ["COLOURS", "STYLE", "coverage", "map", "metric", "save", "study"]

Floats = npt.NDArray[np.float64]
Place = Union[str, "os.PathLike[str]"]
Runs = Union[Run, Sequence[Run], Mapping[str, Union[Run, Sequence[Run]]]]

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a4fb5")
"""The colours of agents and lines, in turn: distinct with any colour vision (Okabe and Ito's, without the palest)."""

STYLE: dict[str, Any] = {
    "font.size": 8, "legend.fontsize": 7, "legend.frameon": False,
    "axes.linewidth": 0.6, "hatch.linewidth": 0.4, "lines.linewidth": 1.2,
    "savefig.bbox": "tight", "savefig.dpi": 300, "savefig.pad_inches": 0.02,
    "pdf.fonttype": 42,  # journals refuse Type 3
    "svg.fonttype": "none", "svg.hashsalt": "ergocast",
}
"""What figures without `ax` are drawn with: settings of matplotlib."""

_DASHES = ("-", "--", "-.", ":")
_PENCIL = LinearSegmentedColormap.from_list("pencil", ["#ffffff", "#d9dce1", "#9aa0aa"])
_INK, _GREY = "#222222", "#777777"
_MOST_POINTS = 100_000  # of lines that stay lines; more become a picture
_METRIC = "ergodic metric φ²"
_UNITS = {"mps2": "m/s²", "mps": "m/s", "radps": "rad/s", "per_s": "1/s", "m2": "m²", "s": "s", "m": "m"}


def map(run: Run, ax: Any = None, *, view: str = "xy") -> Any:
    """Trajectories over the target density, with walls, keep-outs and stations.

    Crosses are starts, circles ends. Hatched ground is kept out: the target is 0 there. The grey scale
    ends where 0.2 % of the cells are above it. Each track has the gid "agent-N".
    view: of a box also "xz" or "yz", where the target is the average along the third axis.
    """
    seen = _View(run.mission.domain, view)
    with _style(ax):
        if ax is None:
            width, height = seen.inches(5.8 if seen.size[0] > 2 * seen.size[1] else 2.4)
            ax = plt.subplots(figsize=(max(width + 1.1, 3.5), height + 1), layout="constrained")[1]
        keys = _draw_tracks(ax, run, seen)
        density = run.target_density if view == "xy" else None
        if density is None and not run.mission.basis.free_domain:
            density = seen.field(run.mu)
        if density is not None:
            top = max(2.0, float(np.quantile(density, 0.998)))
            image = ax.imshow(density.T, vmin=0, vmax=top, cmap=_PENCIL, **seen.picture)
            _draw_bar(ax, image, "density (uniform = 1)", density.max() > top)
        if view == "xy":
            keys += _draw_walls(ax, run.mission) + _draw_kept_out(ax, run.target_density, seen)
        seen.frame(ax)
        ax.legend(handles=keys, loc="lower center", bbox_to_anchor=(0.5, 1), ncol=4, columnspacing=1, frameon=False)
    return ax


def coverage(run: Run, axs: Any = None, *, tick: int | None = None, view: str = "xy") -> Any:
    """What the team has covered up to `tick` (default: the last), and the target, as the modes see both.

    These are Σ c_k f_k and Σ μ_k f_k in multiples of the uniform density, in one colour scale.
    axs: two axes; they are returned. Raises ValueError for a mission with basis.free_domain.
    """
    if run.mission.basis.free_domain:
        raise ValueError("coverage: modes of a free domain are not drawn; map() draws the tracks")
    seen = _View(run.mission.domain, view)
    fields = [seen.field(run.coverage(tick)), seen.field(run.mu)]
    top = max(2.0, float(fields[1].max()))
    with _style(axs):
        if axs is None:
            width, height = seen.inches(2.6)
            size = (2 * width + 1.4, height + 0.8)
            axs = plt.subplots(1, 2, figsize=size, sharey=True, layout="constrained")[1]
        for ax, field, title in zip(axs, fields, ("covered", "target")):
            image = ax.imshow(field.T, vmin=0, vmax=top, cmap="viridis", **seen.picture)
            seen.frame(ax)
            ax.set(title=title)
        axs[1].set_ylabel("")
        _draw_bar(axs[1], image, "density (uniform = 1)", fields[0].max() > top)
    return axs


def metric(runs: Runs, ax: Any = None) -> Any:
    """φ² over time, on logarithmic axes.

    runs: one, several, or a mapping from labels to one or several. Several with one label are their
        median, with a band of its 95 % interval at each time.

    The band of a single run is as wide as the agents' own φ² differ (metric_spread), around φ² of the
    true positions. A run that is alone has the power of t that fits the last decade of time.
    """
    groups = _groups(runs)
    with _style(ax):
        ax = _new_axes() if ax is None else ax
        for i, (label, group) in enumerate(groups.items()):
            t_s, low, middle, high = _metric_band(group)
            ax.plot(t_s, middle, label=label, gid=f"line-{i}", **_look(i))
            ax.fill_between(t_s, low, high, color=_look(i)["color"], alpha=0.25, linewidth=0)
            if len(groups) == len(group) == 1:
                _draw_slope(ax, group[0].summary.get("log_log_slope"), t_s, middle)
        free = all(run.mission.basis.free_domain for group in groups.values() for run in group)
        ax.set(xlabel="time t [s]", ylabel=_METRIC + (", free domain’s modes" if free else ""))
        _make_logarithmic(ax, "x", "y")
        if len(ax.lines) > 1:
            ax.legend()
    return ax


def study(table: Place, ax: Any = None, *, x: str | None = None, y: str = "ergodic_metric") -> Any:
    """Medians of a study over a field that it varies, with the 95 % intervals of `ergocast study`.

    table: study.csv, or the folder with it.
    x: the field; by default the one with most values. What else varies makes one line each.
    y: a column of study.csv. φ² has a logarithmic axis.
    """
    rows, fields = _read_study(table)
    field = x or max(fields or ["scenario"], key=lambda name: int(rows[name].nunique()))
    if lacking := {field, y} - set(rows):
        raise ErgocastError(f"{os.fspath(table)} has no column {lacking.pop()}")
    numbers = pd.to_numeric(rows[field], errors="coerce")
    words = None if numbers.notna().all() else list(dict.fromkeys(rows[field]))
    places = numbers if words is None else rows[field].map(words.index).astype(float)
    logarithmic = words is None and places.min() > 0 and places.max() >= 8 * places.min()
    lines = _lines(rows, [name for name in fields if name != field])
    with _style(ax):
        ax = _new_axes() if ax is None else ax
        for i, (label, line) in enumerate(lines.items()):
            groups = line.groupby(places[line.index])[y]
            low, middle, high = np.array([interval(values) for _, values in groups]).T
            at = np.array([place for place, _ in groups])
            # A little beside each other, so that all intervals are seen.
            step, span = 0.01 * (i - (len(lines) - 1) / 2), places.max() - places.min()
            at = at * (places.max() / places.min()) ** step if logarithmic else at + step * span
            ax.errorbar(at, middle, yerr=[middle - low, high - middle], label=label, gid=f"line-{i}",
                        capsize=2, markersize=4, marker="osD^vP*"[i % 7], **_look(i))
        ax.set(xlabel=_with_unit(field), ylabel="median " + _with_unit(y))
        if words is not None:
            ax.set_xticks(range(len(words)), words)
        _make_logarithmic(ax, *("x" if logarithmic else ""), *("y" if y.startswith("ergodic_metric") else ""))
        if len(lines) > 1:
            ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncol=2)
    return ax


def save(run: Run, folder: Place | None = None, formats: Iterable[str] = ("svg", "pdf")) -> list[Path]:
    """Writes map, coverage and metric of a run into `folder`, by default figures/ of its directory.

    A box has the views from the side, too. The same record gives the same bytes. Returns the paths.
    """
    folder = run.path / "figures" if folder is None else Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    views = {"": "xy"} if len(run.mission.domain.size_m) == 2 else {"": "xy", "_xz": "xz", "_yz": "yz"}
    drawn = {f"map{ending}": map(run, view=view) for ending, view in views.items()}
    drawn["metric"] = metric(run)
    if not run.mission.basis.free_domain:
        drawn |= {f"coverage{ending}": coverage(run, view=view)[0] for ending, view in views.items()}
    undated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    written = []
    with plt.rc_context(STYLE):
        for name, ax in drawn.items():
            for suffix in formats:
                written.append(folder / f"{name}.{suffix}")
                ax.figure.savefig(written[-1], metadata=undated.get(suffix))
            plt.close(ax.figure)
    return written


def main(arguments: Sequence[str]) -> int:
    """What `ergocast report --figures RUN_DIR` runs: save(), the paths printed, and an exit code."""
    (run_dir,) = arguments
    plt.switch_backend("agg")
    try:
        for path in save(load(run_dir)):
            print(path.absolute())
    except (ErgocastError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


# ---- maps ----


class _View:
    """Two axes of space, and how a map of them is drawn."""

    def __init__(self, domain: Domain, name: str) -> None:
        axes = {"xy": [0, 1], "xz": [0, 2], "yz": [1, 2]}.get(name)
        if axes is None or axes[1] >= len(domain.size_m):
            raise ValueError(f"view={name!r}: is not xy, or of a box xz or yz")
        self.name, self.axes, self.size = name, axes, domain.size_m[axes]
        low, high = domain.origin_m[axes], (domain.origin_m + domain.size_m)[axes]
        self.extent = (low[0], high[0], low[1], high[1])
        self.picture = {"origin": "lower", "extent": self.extent, "interpolation": "none"}
        # Heights of a flat box are drawn larger, so that they fill a quarter of the length.
        self.stretch = max(1, math.ceil(self.size[0] / self.size[1] / 4)) if "z" in name else 1

    def inches(self, width: float) -> tuple[float, float]:
        ratio = self.stretch * self.size[1] / self.size[0]
        height = min(width * ratio, 5.0)
        return max(height / ratio, 0.8), max(height, 0.4)

    def frame(self, ax: Any) -> None:
        ax.set(xlim=self.extent[:2], ylim=self.extent[2:], aspect=self.stretch, xlabel=f"{self.name[0]} [m]")
        ax.set_ylabel(f"{self.name[1]} [m]" + (f", drawn × {self.stretch}" if self.stretch > 1 else ""))

    def field(self, coefficients: Floats) -> Floats:
        """The density that they describe, in multiples of the uniform one: [i along x, j along y] of
        the view. What has waves along the third axis averages out."""
        planes = coefficients if coefficients.ndim == 3 else coefficients[None]
        seen = {"xy": planes[0], "xz": planes[:, :, 0].T, "yz": planes[:, 0, :].T}[self.name]
        halves = [np.where(np.arange(n) > 0, 2.0, 1.0) for n in seen.shape]  # mean(cos²) is a half
        places = np.pi * (np.arange(200) + 0.5) / 200
        x, y = (np.cos(np.outer(places, np.arange(n))) for n in seen.shape)
        return np.asarray(x @ (seen * np.outer(*halves)) @ y.T)


def _draw_bar(ax: Any, image: Any, label: str, above: bool) -> None:
    beside = ax.inset_axes([1.04, 0, 0.05, 1])  # as high as the map
    ax.figure.colorbar(image, cax=beside, label=label, extend="max" if above else "neither")


def _draw_kept_out(ax: Any, density: Floats | None, seen: _View) -> list[Any]:
    if density is None or density.all():
        return []
    out = np.pad(density == 0, 1, mode="edge").astype(float)
    lows = seen.extent[::2]
    x, y = (low + side * (np.arange(n) - 0.5) / (n - 2) for low, side, n in zip(lows, seen.size, out.shape))
    for part in ax.contourf(x, y, out.T, levels=[0.5, 1.5], colors="none", hatches=["////"]).collections:
        part.set(edgecolor=_GREY, linewidth=0)
    return [Patch(facecolor="none", edgecolor=_GREY, hatch="//////", linewidth=0.4, label="kept out")]


def _draw_walls(ax: Any, mission: Mission) -> list[Any]:
    """Solid is where an odd number of rings is around: every other one turns the other way."""
    rings = [Outline(np.vstack([ring, ring[:1]]), closed=True) for ring in mission.walls_m]
    if not rings:
        return []
    for i, ring in enumerate(list(rings)):
        around = sum(other.contains_point(ring.vertices[0]) for other in rings if other is not rings[i])
        x, y = ring.vertices.T
        if (np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) > 0) == (around % 2 == 1):
            rings[i] = Outline(ring.vertices[::-1], ring.codes)
    ax.add_patch(PathPatch(Outline.make_compound_path(*rings), facecolor="#444444", linewidth=0, gid="walls"))
    return [Patch(facecolor="#444444", label="wall")]


def _draw_tracks(ax: Any, run: Run, seen: _View) -> list[Any]:
    columns = ["xyz"[axis] + "_m" for axis in seen.axes]
    tracks = {int(agent): rows[columns].to_numpy() for agent, rows in run.trajectory.groupby("agent")}
    # Together they cover at most half of a map of 2.4 inches.
    scale = 2.4 * 72 / seen.size.max()
    length = sum(np.hypot(*np.diff(track, axis=0).T).sum() for track in tracks.values())
    width = float(np.clip(0.5 * seen.size.prod() * scale / max(length, 1e-9), 0.3, 1.0))
    mark = {"linestyle": "none", "markerfacecolor": "white", "markersize": 5, "markeredgewidth": 1.4}
    halo = [withStroke(linewidth=3, foreground="white")]
    keys: list[Any] = []
    for agent, track in tracks.items():
        colour = COLOURS[agent % len(COLOURS)]
        keys += ax.plot(*track.T, color=colour, linewidth=width, gid=f"agent-{agent}", zorder=2,
                        label=f"agent {agent}", rasterized=len(run.trajectory) > _MOST_POINTS)
        for place, marker in ((track[-1], "o"), (track[0], "x")):  # a cross in a circle where they meet
            ax.plot(*place, marker=marker, color=colour, path_effects=halo, zorder=3, clip_on=False, **mark)
    if len(tracks) > len(COLOURS):
        keys = [Line2D([], [], color=COLOURS[0], label=f"{len(tracks)} agents")]
    square = {"marker": "s", "markersize": 9, "fillstyle": "none", "linestyle": "none", "color": _INK}
    stations = [place for agent, place in run.mission.stations_m.items() if agent in tracks]
    for place in stations:
        ax.plot(*place[seen.axes], zorder=4, **square)
    for marker, label in (("x", "start"), ("o", "end")):
        keys.append(Line2D([], [], marker=marker, color=_INK, label=label, **mark))
    return keys + ([Line2D([], [], label="station", **square)] if stations else [])


def _style(ax: Any) -> Any:
    return plt.rc_context(STYLE) if ax is None else contextlib.nullcontext()


def _new_axes() -> Any:
    return plt.subplots(figsize=(3.5, 2.5), layout="constrained")[1]


def _make_logarithmic(ax: Any, *names: str) -> None:
    """Fewer than two decades have numbers between their powers of ten, too."""
    for name in names:
        ax.set(**{f"{name}scale": "log"})
        axis = getattr(ax, f"{name}axis")
        low, high = axis.get_view_interval()
        axis.set_minor_formatter(LogFormatterSciNotation(minor_thresholds=(2, 0.5)))
        if name == "x":  # labels beside each other need more room
            axis.set_minor_locator(LogLocator(subs=(2, 5)))
            axis.set_minor_formatter("{x:g}" if high < 100 * low else "")
            axis.set_major_formatter("{x:g}" if low > 1e-4 else LogFormatterSciNotation())


def _look(i: int) -> dict[str, Any]:
    return {"color": COLOURS[i % len(COLOURS)], "linestyle": _DASHES[i % len(_DASHES)]}


def _groups(runs: Runs) -> dict[str, list[Run]]:
    if isinstance(runs, Run):
        return {"φ²": [runs]}
    if not isinstance(runs, Mapping):
        runs = {f"{run.name}, seed {run.mission.seed}": run for run in runs}
    return {label: [one] if isinstance(one, Run) else list(one) for label, one in runs.items()}


def _metric_band(group: Sequence[Run]) -> tuple[Floats, Floats, Floats, Floats]:
    """Times after 0, low, middle and high."""
    rows = pd.concat([run.metrics[run.metrics["t_s"] > 0] for run in group])
    if len(group) > 1:
        times = rows.groupby("t_s")["ergodic_metric"]
        bands = np.array([interval(values) for _, values in times]).reshape(-1, 3)
        return np.array([t for t, _ in times]), bands[:, 0], bands[:, 1], bands[:, 2]
    middle, half = rows["ergodic_metric"].to_numpy(), rows["metric_spread"].to_numpy() / 2
    return rows["t_s"].to_numpy(), np.maximum(middle - half, middle / 100), middle, middle + half


def _draw_slope(ax: Any, slope: Any, t_s: Floats, phi2: Floats) -> None:
    late = (t_s >= t_s.max(initial=0) / 10) & (phi2 > 0)
    if not isinstance(slope, (int, float)) or late.sum() < 3:
        return
    log_t = np.log(t_s[late])
    above = np.average(np.log(phi2[late]) - slope * log_t, weights=np.gradient(log_t))
    ends = t_s[late][[0, -1]]
    label = rf"$\propto t^{{{slope:.2f}}}$"
    ax.plot(ends, np.exp(above) * ends**slope, color=_INK, linestyle="--", linewidth=1, label=label)


def _read_study(table: Place) -> tuple[pd.DataFrame, list[str]]:
    """The rows, and the columns that name a point and differ."""
    file = Path(table) / "study.csv" if Path(table).is_dir() else Path(table)
    rows = pd.read_csv(file)
    names = list(rows.columns)
    if names[:1] != ["scenario"] or "seed" not in names or rows.empty:
        raise ErgocastError(f"{file}: is no table of a study, or has no runs yet")
    return rows, [name for name in names[: names.index("seed")] if rows[name].nunique() > 1]


def _lines(rows: pd.DataFrame, fields: list[str]) -> dict[str, pd.DataFrame]:
    """The rows of each point but for the field along x, by a label."""
    if not fields:
        return {"all": rows}
    named = [(f, "" if f == "scenario" else f.split(".")[-1] + " ") for f in fields]
    labels = rows.apply(lambda row: ", ".join(f"{name}{row[f]}" for f, name in named), axis=1)
    return {str(label): line for label, line in rows.groupby(labels, sort=False)}


def _with_unit(name: str) -> str:
    if name == "ergodic_metric":
        return "φ² at the end"
    if at := re.match(r"ergodic_metric_at_(.+)_s$", name):
        return f"φ² after {at[1]} s"
    ending = next((ending for ending in _UNITS if name.endswith("_" + ending)), None)
    return name if ending is None else f"{name[: -len(ending) - 1]} [{_UNITS[ending]}]"
