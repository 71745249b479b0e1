# SPDX-License-Identifier: BSD-3-Clause
"""Random walks with the target's density, alone and without any memory.

RandomWalk: N. Metropolis, A. W. Rosenbluth, M. N. Rosenbluth, A. H. Teller and E. Teller, "Equation
of state calculations by fast computing machines", J. Chem. Phys. 21 (1953) 1087-1092. From x an
agent proposes y = x + ℓ n, with n uniform over directions, and

    goes to y with probability min(1, ρ(y) / ρ(x)), and else stays at x as long as a step takes.

y outside the domain has ρ = 0. Proposals are symmetric, so the chain's stationary density is ρ.
ℓ = STEP of the domain's shorter side.

Waypoints: the random waypoint model, with waypoints of the target's density. D. B. Johnson and D. A.
Maltz, "Dynamic source routing in ad hoc wireless networks", Mobile Computing (1996) 153-181, draw
them uniformly; here P(y) ∝ ρ(y). An agent goes straight to y, and then draws the next one. Its own
density is not ρ, because it also passes what lies between.

An agent that does not arrive in twice the time, for example because of a wall, draws anew.
"""

import numpy as np

import ergocast
from ergocast.bench.laws.target import density

STEP = 0.05
CELLS = 64


class _ToGoals(ergocast.Law):
    """Agents go straight to goals, one after another."""

    def __init__(self):
        self.random = None

    def wanted_mps(self, now):
        if self.random is None:
            # The number of the law keeps its draws apart from those of others with this seed.
            self.random = np.random.default_rng([now.mission.seed, self.NUMBER])
            domain, axes = now.mission.domain, now.x_m.shape[1]
            self.low_m = np.asarray(domain.origin_m)[:axes]
            self.high_m = self.low_m + np.asarray(domain.size_m)[:axes]
            self.goals_m, self.until = {}, {}
        reach_m = now.u_max_mps * now.mission.dt_s
        for i, agent in enumerate(now.agents.tolist()):
            if agent not in self.until or self.is_over(now, i, agent):
                goal_m, ticks = self.next_goal(now, now.x_m[i], reach_m[i])
                self.goals_m[agent], self.until[agent] = goal_m, now.tick + ticks
        way_m = np.array([self.goals_m[agent] for agent in now.agents.tolist()]) - now.x_m
        length_m = np.linalg.norm(way_m, axis=1)
        return way_m / np.maximum(length_m / now.u_max_mps, now.mission.dt_s)[:, None]


class RandomWalk(_ToGoals):
    """A Metropolis walk."""

    NUMBER = 1

    def is_over(self, now, i, agent):
        return now.tick >= self.until[agent]

    def next_goal(self, now, x_m, reach_m):
        step_m = STEP * np.min(self.high_m - self.low_m)
        ticks = int(np.ceil(step_m / reach_m))
        direction = self.random.standard_normal(len(x_m))
        to_m = x_m + step_m * direction / np.linalg.norm(direction)
        chance = self.random.random()
        if np.any(to_m < self.low_m) or np.any(to_m > self.high_m):
            return x_m.copy(), ticks
        here, there = density(now.mission, np.stack([x_m, to_m]))
        return (to_m if chance * here < there or here == 0 else x_m.copy()), ticks


class Waypoints(_ToGoals):
    """Random waypoints of the target's density."""

    NUMBER = 2

    def is_over(self, now, i, agent):
        there = np.allclose(now.x_m[i], self.goals_m[agent], rtol=0, atol=1e-6)
        return there or now.tick >= self.until[agent]

    def next_goal(self, now, x_m, reach_m):
        if not hasattr(self, "shares"):
            self.measure(now.mission)
        cell = np.searchsorted(self.shares, self.random.random() * self.shares[-1], side="right")
        index = np.array(np.unravel_index(cell, self.cells))
        place = (index + self.random.random(len(x_m))) / self.cells
        goal_m = self.low_m + place * (self.high_m - self.low_m)
        return goal_m, int(np.ceil(2 * np.linalg.norm(goal_m - x_m) / reach_m)) + 1

    def measure(self, mission):
        """The cumulative mass of the cells, whose order is that of their indices (x, y, z)."""
        axes = len(self.low_m)
        self.cells = np.full(axes, CELLS if axes == 2 else 24)
        middles = [
            self.low_m[i] + (self.high_m[i] - self.low_m[i]) * (np.arange(n) + 0.5) / n
            for i, n in enumerate(self.cells)
        ]
        places_m = np.stack(np.meshgrid(*middles, indexing="ij"), axis=-1).reshape(-1, axes)
        self.shares = np.cumsum(density(mission, places_m))
