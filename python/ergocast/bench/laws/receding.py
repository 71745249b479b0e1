# SPDX-License-Identifier: BSD-3-Clause
"""Receding-horizon ergodic control of a team.

I. Abraham and T. D. Murphey, "Decentralized ergodic control: distribution-driven sensing and
exploration for multiagent systems", IEEE Robotics and Automation Letters 3 (2018) 2987-2994. For one
agent: A. Mavrommati, E. Tzorakoleftherakis, I. Abraham and T. D. Murphey, "Real-time area coverage and
target localization using receding-horizon ergodic exploration", IEEE Transactions on Robotics 34 (2018)
62-80.

An agent predicts for a time T where its plan u leads it. Then it improves the plan by the adjoint ρ_j of
the team's metric, which for x_j' = u_j is

    c_k = 1/N Σ_j 1/(t + T) ∫_0^(t+T) f_k(x_j(τ)) dτ        (past and predicted)
    ρ_j' = −q Σ_k Λ_k (c_k − μ_k) ∇f_k(x_j),    ρ_j(t + T) = 0,    Λ_k = (1 + ‖k‖²)^−(d + 1)/2
    u_j = −R⁻¹ ρ_j, shortened to u_max

The first input of the plan is the command, and the rest is the plan of the next tick. The agents'
predicted coverage is the message of the paper. Here an agent always has that of all others.

f_k is divided by its norm h_k. With lengths in L = √area, in a box ∛volume, and times in L / u_max, the
papers leave free: T = HORIZON and q/R = GAIN. They also have a barrier along edges. It is left out: a
prediction ends at the edge, as the vehicle does.
"""

import numpy as np

import ergocast
from ergocast.bench.laws.smc import shortened
from ergocast.bench.laws.target import cosines_only, squared_norms, wave_numbers

HORIZON = 0.1
GAIN = 10.0


class Receding(ergocast.Law):
    """u_j = −R⁻¹ ρ_j"""

    def __init__(self):
        self.plan = None

    def wanted_mps(self, now):
        if self.plan is None:
            self.prepare(now.mission, now.x_m.shape[1])
        if self.plan.shape[1:] != now.x_m.shape:
            self.plan = np.zeros((self.steps, *now.x_m.shape))
        self.plan = self.improved(now, np.concatenate([self.plan[1:], np.zeros_like(self.plan[:1])]))
        return self.plan[0]

    def prepare(self, mission, axes):
        cosines_only(mission, "receding-horizon ergodic control")
        self.low_m = np.asarray(mission.domain.origin_m)[:axes]
        size_m = np.asarray(mission.domain.size_m)[:axes]
        self.high_m = self.low_m + size_m
        self.volume = np.prod(size_m)
        time_s = HORIZON * self.volume ** (1 / axes) / mission.law.u_max_mps
        self.steps = max(2, round(time_s / mission.dt_s))
        sobolev = (1 + np.sum(wave_numbers(mission) ** 2, axis=0)) ** (-(axes + 1) / 2)
        self.weights = sobolev / squared_norms(mission)
        self.plan = np.zeros((self.steps, 0, axes))

    def predicted(self, now, plan):
        """The places of the plan's steps, from now.x_m on, shape (steps, n, axes)."""
        places_m = [now.x_m]
        for velocity in plan[:-1]:
            next_m = places_m[-1] + velocity * now.mission.dt_s
            places_m.append(np.clip(next_m, self.low_m, self.high_m))
        return np.array(places_m)

    def improved(self, now, plan):
        """−R⁻¹ ρ_j at the plan's steps, shape (steps, n, axes)."""
        basis, domain = now.mission.basis, now.mission.domain
        places_m = self.predicted(now, plan)
        axes = places_m.shape[2]
        # The present tick is part of now.c.
        ahead = basis.values(places_m[1:].reshape(-1, axes), domain).mean(axis=0)
        ticks = now.tick + 1
        c = (ticks * now.c + (self.steps - 1) * ahead) / (ticks + self.steps - 1)
        slopes = basis.gradient(self.weights * (c - now.mu), places_m.reshape(-1, axes), domain)
        # ρ_j by the sum from the plan's end.
        adjoint = np.cumsum(slopes.reshape(places_m.shape)[::-1], axis=0)[::-1]
        u_max = now.u_max_mps[:, None]
        wanted = -GAIN * self.volume * u_max**2 * now.mission.dt_s * adjoint
        return shortened(wanted.reshape(-1, axes), np.tile(u_max, (self.steps, 1))).reshape(places_m.shape)
