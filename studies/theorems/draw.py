# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of docs/theorems.md: draw.py FOLDER_OF_CURVES FOLDER_OF_IMAGES"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from curves import DASHED, DOTS, SOLID, draw

folder, images = sys.argv[1:]
ESCAPE = {"measured": DOTS, "predicted": SOLID, "past neglected": DASHED}
draw(
    folder, images, "theorem_1_noise",
    [{"xscale": "log", "xlabel": "σ [m/√s]", "ylabel": "time of escape [s]", "ylim": (0, 600)}] * 2,
    ESCAPE,
)
draw(
    folder, images, "theorem_1_epsilon",
    [{"xscale": "log", "yscale": "log", "xlabel": "ε [1/m]", "ylabel": "time of escape [s]"}] * 2,
    ESCAPE,
)
draw(
    folder, images, "theorem_1_distribution",
    [{"xlabel": "time [s]", "ylabel": "share escaped"}] * 2,
    {"measured": SOLID, "predicted": DASHED},
)
draw(
    folder, images, "theorem_1_growth",
    [
        {"title": "spread of the linearised recursion, σ = 1 m/√s", "yscale": "log", "xlabel": "time [s]",
         "ylabel": "standard deviation [m]", "ylim": (0.1, 1e12)},
        {"title": "equal if the law is exact: a dot a set and σ", "xscale": "log", "yscale": "log",
         "xlabel": "predicted spread at the measured median, σ = 1 m/√s [m]",
         "ylabel": "spread that escape takes: 20 m / (0.674 σ)", "equal": True},
    ],
    ESCAPE,
)
draw(
    folder, images, "theorem_2_mean_square",
    [{"xlabel": "time / duration of the case", "ylabel": "mean of ‖x − c‖² / bound", "ylim": (0, 1.1), "bound": 1}],
    {"edges reflect": SOLID, "no edges": DASHED},
)
draw(
    folder, images, "theorem_p1_rounding",
    [{"xlabel": "time [s]", "ylabel": "share of places that rounding has driven off", "ylim": (0, 1)}],
)
