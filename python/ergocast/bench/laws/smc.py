# SPDX-License-Identifier: BSD-3-Clause
"""Spectral multiscale coverage, SMC, in first and in second order.

G. Mathew and I. Mezić, "Metrics for ergodicity and design of ergodic dynamics for multi-agent
systems", Physica D 240 (2011) 432-442; the feedback laws of its section on control design.

With N agents, cosines f_k divided by their norms h_k, and the target's coefficients μ_k:

    S_k(t) = Σ_j ∫ f_k(x_j(τ)) dτ − N t μ_k,    Λ_k = (1 + ‖k‖²)^−(d + 1)/2
    B_j(t) = Σ_k Λ_k S_k(t) ∇f_k(x_j(t))
    first order,  x_j' = u_j, ‖u_j‖ ≤ u_max:   u_j = −u_max B_j / ‖B_j‖
    second order, x_j" = u_j, ‖u_j‖ ≤ F_max:   u_j = −F_max (c x_j' + B_j) / ‖c x_j' + B_j‖

The integral is the sum over ticks, times dt, the present tick included. Where B_j = 0, u_j = 0: the
paper leaves this open.

The paper's second order has no limit of speed; a vehicle here keeps u_max. The paper leaves F_max and
c free. Here F_max reaches u_max within RAMP of the shorter side L, F_max = u_max² / (2 · RAMP · L), and
c = DAMPING / (u_max² · area), in a box its volume.
"""

import numpy as np

import ergocast
from ergocast.bench.laws.target import cosines_only, squared_norms, wave_numbers


class FirstOrder(ergocast.Law):
    """u_j = −u_max B_j / ‖B_j‖"""

    def __init__(self):
        self.weights = None

    def sobolev(self, k):
        """Λ of the wave numbers k, whose first index is the axis."""
        return (1 + np.sum(k**2, axis=0)) ** (-(len(k) + 1) / 2)

    def spectral_gradients(self, now):
        """B_j of each agent, shape (n, axes)."""
        if self.weights is None:
            mission = now.mission
            cosines_only(mission, "SMC")
            # Both f_k in Λ_k S_k ∇f_k are divided by h_k.
            self.weights = self.sobolev(wave_numbers(mission)) / squared_norms(mission)
        agent_time_s = len(now.agents) * (now.tick + 1) * now.mission.dt_s
        deficit_s = agent_time_s * (now.c - now.mu)
        return now.mission.basis.gradient(self.weights * deficit_s, now.x_m, now.mission.domain)

    def wanted_mps(self, now):
        gradient = self.spectral_gradients(now)
        return now.u_max_mps[:, None] * directions(-gradient)


class SecondOrder(FirstOrder):
    """u_j = −F_max (c x_j' + B_j) / ‖c x_j' + B_j‖"""

    RAMP = 0.025
    DAMPING = 0.1

    def __init__(self):
        super().__init__()
        self.before_m = None

    def wanted_mps(self, now):
        gradient = self.spectral_gradients(now)
        u_max = now.u_max_mps[:, None]
        dt_s = now.mission.dt_s
        # The measured velocity: at an edge it differs from the command.
        known = self.before_m is not None and self.before_m.shape == now.x_m.shape
        velocity = (now.x_m - self.before_m) / dt_s if known else np.zeros_like(now.x_m)
        self.before_m = now.x_m.copy()
        size_m = np.asarray(now.mission.domain.size_m)[: now.x_m.shape[1]]
        damping = self.DAMPING / u_max**2 / np.prod(size_m)
        force = u_max**2 / (2 * self.RAMP * size_m.min()) * directions(-(damping * velocity + gradient))
        return shortened(velocity + force * dt_s, u_max)


def directions(vectors):
    """Each row divided by its length; rows of 0 stay."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0)


def shortened(vectors, most):
    """Rows no longer than `most`."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors * np.minimum(1, most / np.maximum(lengths, 1e-300))
