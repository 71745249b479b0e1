#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes a running team follow a plume: measures it at the agents' places, fits a Gaussian to the
latest measurements, and gives it to the team as its target. README.md has the commands."""

import argparse
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import ergocast

SIDE_M, CELLS = 400, 80  # of the domain, and of the grid over it
WIDTH_M, NOISE = 40, 0.05  # of the plume, and of a measurement
MEMORY_S = 20  # older measurements hardly count, because the plume has drifted on


def plume_m(t_s):
    """Where the plume is. The wind carries it for 200 s; then it lies still."""
    return np.array([100, 100]) + np.array([1.0, 0.8]) * min(t_s, 200)


def concentration(at_m, centre_m):
    return np.exp(-((at_m - centre_m) ** 2).sum(axis=-1) / (2 * WIDTH_M**2))


class Estimator:
    def __init__(self):
        axis_m = (np.arange(CELLS) + 0.5) * SIDE_M / CELLS
        self.centres_m = np.stack(np.meshgrid(axis_m, axis_m, indexing="ij"), axis=-1)
        self.log_likelihood = np.zeros((CELLS, CELLS))  # of the plume's centre, in each cell
        self.t_s = 0.0

    def add(self, t_s, places_m, values):
        self.log_likelihood *= np.exp((self.t_s - t_s) / MEMORY_S)
        self.t_s = t_s
        for place_m, value in zip(places_m, values):
            error = value - concentration(place_m, self.centres_m)
            self.log_likelihood -= error**2 / (2 * (2 * NOISE) ** 2)  # the drift adds to the noise

    def gaussian(self):
        share = np.exp(self.log_likelihood - self.log_likelihood.max())[..., np.newaxis]
        share /= share.sum()
        mean_m = (share * self.centres_m).sum(axis=(0, 1))
        variance_m2 = (share * (self.centres_m - mean_m) ** 2).sum() / 2
        return mean_m, np.sqrt(WIDTH_M**2 + variance_m2)


def follow(run):
    estimator, random, order = Estimator(), np.random.default_rng(1), None
    with ThreadPoolExecutor(1) as orders:  # measuring goes on until the team has obeyed
        for state in run.watch():
            places_m = np.array([a["position_m"] for a in state["agents"] if a["position_m"]])
            if state["state"] != "running" or len(places_m) == 0:
                continue
            t_s, centre_m = state["t_s"], plume_m(state["t_s"])
            values = concentration(places_m, centre_m) + random.normal(0, NOISE, len(places_m))
            estimator.add(t_s, places_m, values)
            if order is not None and not order.done():
                continue
            report(order)
            mean_m, sigma_m = estimator.gaussian()
            print(f"t = {t_s:5.1f} s: the plume seems to be at {mean_m.round()} m, "
                  f"{np.linalg.norm(mean_m - centre_m):.0f} m off", flush=True)
            peak = {"mean_x_m": mean_m[0], "mean_y_m": mean_m[1], "sigma_m": sigma_m, "weight": 0.9}
            order = orders.submit(run.amend, {"gaussians": [peak], "uniform_weight": 0.1})
    report(order)
    print("the mission has ended")


def report(order):
    if order is None:
        return
    if problem := order.exception():
        print(f"not obeyed: {problem}", flush=True)
    else:
        print(f"amendment {order.result().number} holds since t = {order.result().t_s} s", flush=True)


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--run-id", help="needed where several runs are live")
    follow(ergocast.connect(options.parse_args().run_id))
