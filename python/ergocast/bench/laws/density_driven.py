# SPDX-License-Identifier: BSD-3-Clause
"""Density-driven optimal control, D²OC.

S. Seo and K. Lee, "Density-driven optimal control for efficient and collaborative multiagent nonuniform
coverage", IEEE Transactions on Systems, Man, and Cybernetics: Systems (2025), arXiv 2511.12756.

Sample points y_i of the target have weights w_i, at first 1/POINTS each. N agents with M steps have N M
agent-points of weight α = 1/(N M). Three stages make the distance of Wasserstein between both small:

    A  The points in the order of ‖y_i − x_j‖² / w_i², until their weights sum up to α, have the mean
       g_j. The inputs u minimise Σ_h α ‖x_j(h) − g_j‖² + R ‖u(h)‖² over the steps h of a horizon.
    B  x_j takes the weight α from the nearest points that have some left.
    C  Agents send each other what they have taken.

Here vehicles are x_j(h + 1) = x_j(h) + dt u(h), so the minimum is u(0) = K (g_j − x_j) / dt with a number
K < 1, and u is shortened to u_max. In stage C an agent always receives from all others. All agents take,
in their order, before any chooses; in the paper they move one after another. The paper leaves POINTS,
HORIZON in steps and R = COST α dt² free.

The law knows when the mission ends: after its last step all weights are 0.
"""

import numpy as np

import ergocast
from ergocast.bench.laws.smc import shortened
from ergocast.bench.laws.target import sampled

POINTS = 3000
HORIZON = 10
COST = 1.0


class DensityDriven(ergocast.Law):
    """u_j = K (g_j − x_j) / dt"""

    def __init__(self):
        self.points_m = None

    def wanted_mps(self, now):
        mission = now.mission
        if self.points_m is None:
            random = np.random.default_rng([mission.seed, 3])
            self.points_m = sampled(mission, POINTS, now.x_m.shape[1], random)
            self.weights = np.full(POINTS, 1 / POINTS)
            self.share = 1 / (len(now.agents) * mission.tick_count)
        for x_m in now.x_m:
            self.take(x_m)
        goals_m = np.array([self.goal(x_m) for x_m in now.x_m])
        return shortened(gain() * (goals_m - now.x_m) / mission.dt_s, now.u_max_mps[:, None])

    def take(self, x_m):
        """Stage B: the nearest points pay for one step at x_m. Points without weight are forgotten."""
        for i, part in self.cheapest(self.squares_m2(x_m)):
            self.weights[i] -= part
        some = self.weights > 0
        if not some.all():
            self.points_m, self.weights = self.points_m[some], self.weights[some]

    def goal(self, x_m):
        """g of stage A; x_m if no point is left."""
        chosen = self.cheapest(self.squares_m2(x_m) / self.weights**2)
        total = sum(part for _, part in chosen)
        return sum(part * self.points_m[i] for i, part in chosen) / total if chosen else x_m

    def squares_m2(self, x_m):
        way_m = self.points_m - x_m
        return np.einsum("ia,ia->i", way_m, way_m)

    def cheapest(self, cost):
        """[(point, part of its weight)] in the order of cost, until the parts sum up to α."""
        chosen, left = [], self.share
        while left > 0 and len(chosen) < len(cost):
            i = np.argmin(cost)
            part = min(left, self.weights[i])
            chosen.append((i, part))
            left -= part
            cost[i] = np.inf
        return chosen


def gain():
    """K of the first step, by the recursion of Riccati in numbers without units."""
    value = 1.0
    for _ in range(HORIZON - 1):
        value = 1 + COST * value / (COST + value)
    return value / (COST + value)
