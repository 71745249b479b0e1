# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of docs/network.md: draw.py FOLDER_OF_CURVES FOLDER_OF_IMAGES"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from curves import DASHED, SOLID, draw

folder, images = sys.argv[1:]
VARIED = {
    "period": "broadcast period [s]",
    "period30": "broadcast period [s], 30 % lost",
    "period10": "broadcast period [s], 10 % lost on all buses",
    "loss": "broadcasts lost [%]",
    "everywhere": "messages lost on all buses [%]",
    "delay": "mean delay [s]",
    "crashes": "agents killed in 100 s",
}
for name, text in VARIED.items():
    panel = {
        "xscale": "log" if name.startswith("period") else "linear",
        "yscale": "log",
        "xlabel": text,
        "ylabel": "φ² at the end against central",
    }
    draw(folder, images, f"network_{name}", [panel], {"places": SOLID, "broadcasts": DASHED}, beside=0.006)
