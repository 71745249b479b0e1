# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of docs/law.md: draw.py FOLDER_OF_CURVES FOLDER_OF_IMAGES"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from curves import draw

LOG = {"xscale": "log", "yscale": "log"}
folder, images = sys.argv[1:]
draw(folder, images, "law_decay", [{**LOG, "xlabel": "time [s]", "ylabel": "φ², geometric mean"}])
draw(folder, images, "law_anticipation", [{**LOG, "xlabel": "anticipation", "ylabel": "φ² against its value at 2"}])
