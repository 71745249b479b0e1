# SPDX-License-Identifier: BSD-3-Clause
"""Draws what curves.cc has written: colours are series, kinds of line are kinds."""

import csv
import sys
from pathlib import Path

try:
    import matplotlib
except ModuleNotFoundError:
    sys.exit("the figures need matplotlib: sudo apt-get install python3-matplotlib")
matplotlib.use("agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a4fb5")
SOLID, DASHED, DOTS = {"linestyle": "-"}, {"linestyle": "--"}, {"linestyle": "none"}
plt.rcParams.update({"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "ergocast", "axes.linewidth": 0.6})


def draw(folder, images, name, panels, kinds=None, beside=0.0):
    """Draws FOLDER/NAME.csv into IMAGES/NAME.svg, if it is there.

    panels: what matplotlib's Axes.set() takes for each panel, in the order of the file;
        the file names them. `bound`, a height, and `equal`, where x is y, are dotted lines.
    kinds: how the lines of each kind look; intervals have a dot in their middle.
    beside: by which share of the axis neighbours are moved, so that all intervals can be seen.
    """
    file = Path(folder) / f"{name}.csv"
    if not file.exists():
        return
    with file.open(newline="") as opened:
        rows = list(csv.DictReader(opened))
    series, drawn_kinds, titles = (list(dict.fromkeys(row[key] for row in rows)) for key in ("series", "kind", "panel"))
    width = 6.5 if len(panels) == 1 else 4.8 * len(panels)
    figure, axes = plt.subplots(1, len(panels), figsize=(width, 3.4), layout="constrained", squeeze=False)
    lines = list(dict.fromkeys((row["series"], row["kind"]) for row in rows))
    for ax, title, panel in zip(axes[0], titles, panels):
        line = {"color": "#333333", "linewidth": 0.8, "linestyle": ":"}
        panel = dict(panel)
        if panel.pop("equal", False):
            ax.axline((1, 1), (10, 10), **line)
        if (bound := panel.pop("bound", None)) is not None:
            ax.axhline(bound, **line)
        ax.set(**{"title": title, **panel})
        for place, (one, kind) in enumerate(lines):
            points = [
                [float(row[key]) for key in ("x", "low", "middle", "high")]
                for row in rows if (row["panel"], row["series"], row["kind"]) == (title, one, kind)
            ]
            if not points:
                continue
            x, low, middle, high = map(list, zip(*sorted(points)))
            step = beside * (place - (len(lines) - 1) / 2)
            if ax.get_xscale() == "log":
                x = [value * (max(x) / min(x)) ** step for value in x]
            else:
                x = [value + step * max(x) for value in x]
            look = {"color": COLOURS[series.index(one) % len(COLOURS)], **(kinds or {}).get(kind, SOLID)}
            if high != low or look["linestyle"] == "none":
                errors = [[m - l for m, l in zip(middle, low)], [h - m for h, m in zip(high, middle)]]
                ax.errorbar(x, middle, yerr=errors, fmt="o", markersize=3.5, capsize=2, linewidth=1.2, **look)
            else:
                ax.plot(x, middle, linewidth=1.4, **look)
        ax.grid(color="#e3e5e8", linewidth=0.5)
        for axis in (ax.xaxis, ax.yaxis):
            low, high = axis.get_view_interval()
            if axis.get_scale() == "log" and 1e-3 < low and high < 100 * low:  # few powers of ten, and short numbers
                axis.set_minor_locator(LogLocator(subs=(1, 2, 5) if high > 4 * low else range(1, 10)))
                axis.set_minor_formatter("{x:g}")
                axis.set_major_formatter("{x:g}")
    key = [Line2D([], [], color=COLOURS[i % len(COLOURS)], label=text) for i, text in enumerate(series)]
    if len(drawn_kinds) > 1:
        for kind in drawn_kinds:
            look = (kinds or {}).get(kind, SOLID)
            key.append(Line2D([], [], color="#333333", label=kind, marker="o" if look == DOTS else None, markersize=4, **look))
    columns = max(1, int(width * 13 / max(len(line.get_label()) + 8 for line in key)))
    figure.legend(handles=key, loc="lower center", bbox_to_anchor=(0.5, 1), ncol=min(columns, len(key)), frameon=False)
    Path(images).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(images) / f"{name}.svg", bbox_inches="tight", pad_inches=0.05, metadata={"Date": None})
    plt.close(figure)
