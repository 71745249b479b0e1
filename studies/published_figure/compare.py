# SPDX-License-Identifier: BSD-3-Clause
"""SMC of the bench beside a published figure of its metric over time: docs/results/bench.md.

compare.py [SECONDS]: for the first SECONDS, by default all 100; the exit code is 1 if they differ by more
than the figure can be read.
"""

import csv
import sys
from pathlib import Path

import numpy as np

import ergocast
from ergocast.bench.laws import smc

HERE = Path(__file__).resolve().parent
# A pixel of the figure is 0.052 high: one for its line, one for the zero of its axis.
READABLE = 0.104


class Published(smc.FirstOrder):
    """SMC with the weights of the figure, Λ = (1 + ‖k‖)^−3/2; it also keeps φ² of each tick."""

    def __init__(self):
        super().__init__()
        self.metric = []

    def sobolev(self, k):
        return (1 + np.linalg.norm(k, axis=0)) ** -1.5

    def spectral_gradients(self, now):
        gradients = super().spectral_gradients(now)
        self.metric.append(float(np.sum(self.weights * (now.c - now.mu) ** 2)))
        return gradients


def ours(seconds, law):
    """φ² after each tick."""
    mission = ergocast.compile_mission(HERE / "three_peaks.textproto")
    ergocast.IdealTeam(mission, law=law).step(round(seconds / mission.dt_s))
    return mission.dt_s * np.arange(len(law.metric)), np.array(law.metric)


def read(seconds):
    """(t, φ²) read from the figure."""
    with (HERE / "read.csv").open() as file:
        rows = [(float(row["t_s"]), float(row["metric"])) for row in csv.DictReader(file)]
    return np.array([row for row in rows if row[0] < seconds]).T


def main(seconds=100.0):
    t_s, metric = ours(seconds, Published())
    read_s, published = read(seconds)
    found = np.interp(read_s, t_s, metric)
    print("after [s]  figure  here")
    for row in zip(read_s, published, found):
        print("{:9.1f}{:8.2f}{:6.2f}".format(*row))
    worst = np.abs(found - published).max()
    print(f"at most {worst:.3f} apart, {np.median(np.abs(found - published)):.3f} in the median")
    return 0 if worst <= READABLE else 1


if __name__ == "__main__":
    sys.exit(main(*map(float, sys.argv[1:])))
