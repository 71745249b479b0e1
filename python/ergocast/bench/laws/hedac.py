# SPDX-License-Identifier: BSD-3-Clause
"""Heat equation driven area coverage, HEDAC.

S. Ivić, B. Crnković and I. Mezić, "Ergodicity-based cooperative multiagent area coverage via a
potential field", IEEE Transactions on Cybernetics 47 (2017) 1983-1993.

Agents climb a potential u, which a source of heat makes where the team has been too little:

    C(x, t) = Σ_j ∫ φ(x − x_j(τ)) dτ,      c = C / ∫ C dx       (coverage, of mass 1)
    e = max(ρ − c, 0),                     s = e² / ∫ e² dx     (source, of power 1)
    α Δu = β u − s,    ∂u/∂n = 0 at edges                       (stationary heat equation)
    x_j' = u_max ∇u / ‖∇u‖

The paper also cools the surroundings of each agent, against collisions. This term is left out:
points cannot collide, and Ergocast keeps the distances of bodies by other means. α and β matter by
their ratio only, which says how far heat reaches: √(α/β) = REACH · √area. φ is a Gaussian with
standard deviation FOOTPRINT · √area.

The equation is solved in cosines, which have its boundary condition: û_k = ŝ_k / (β + α ‖π k/L‖²).
The integrals are sums over the middles of CELLS² cells. Only planes without walls.
"""

import numpy as np

import ergocast
from ergocast.bench.laws.smc import directions
from ergocast.bench.laws.target import density

CELLS = 64
REACH = 0.1
FOOTPRINT = 0.025


class Hedac(ergocast.Law):
    """x_j' = u_max ∇u / ‖∇u‖"""

    def __init__(self):
        self.field = None

    def wanted_mps(self, now):
        if self.field is None:
            self.field = Field(now.mission)
        self.field.cover(now.x_m, now.mission.dt_s)
        return now.u_max_mps[:, None] * directions(self.field.gradient(now.x_m))


class Field:
    """Coverage, source and potential over the domain."""

    def __init__(self, mission):
        if mission.mu.ndim != 2:
            raise ValueError("HEDAC is for a plane, and the domain is a box (leave HEDAC out)")
        if mission.walls_m:
            raise ValueError("HEDAC here knows no walls (leave HEDAC out, or the walls)")
        self.origin_m = np.asarray(mission.domain.origin_m)[:2]
        self.size_m = np.asarray(mission.domain.size_m)[:2]
        self.cell_m2 = np.prod(self.size_m) / CELLS**2
        side_m = np.sqrt(np.prod(self.size_m))
        self.footprint_m = FOOTPRINT * side_m
        middles = (np.arange(CELLS) + 0.5) / CELLS
        self.middles_m = self.origin_m[:, None] + self.size_m[:, None] * middles  # along x, along y
        places = np.stack(np.meshgrid(*self.middles_m, indexing="ij"), axis=-1)
        target = density(mission, places.reshape(-1, 2)).reshape(CELLS, CELLS)
        self.target = target / (target.sum() * self.cell_m2)
        self.covered = np.zeros((CELLS, CELLS))
        # Row k: cosine k at the middles, of norm 1 over the cells.
        self.cosines = np.cos(np.pi * np.arange(CELLS)[:, None] * middles)
        self.cosines *= np.sqrt(np.where(np.arange(CELLS) > 0, 2, 1) / CELLS)[:, None]
        waves = np.pi * np.arange(CELLS) / self.size_m[:, None]
        self.waves_per_m = waves
        beta_over_alpha = 1 / (REACH * side_m) ** 2
        self.stiffness = beta_over_alpha + waves[0][:, None] ** 2 + waves[1] ** 2

    def cover(self, x_m, dt_s):
        """Agents at x_m cover for dt_s; the potential follows."""
        along = [
            np.exp(-0.5 * ((self.middles_m[i] - x_m[:, i, None]) / self.footprint_m) ** 2)
            for i in range(2)
        ]
        self.covered += dt_s * along[0].T @ along[1]
        self.potential = self.solved(self.source())

    def source(self):
        """s in cells [1/m²]."""
        coverage = self.covered / (self.covered.sum() * self.cell_m2)
        squared = np.maximum(self.target - coverage, 0) ** 2
        power = squared.sum() * self.cell_m2
        return squared / power if power > 0 else squared

    def solved(self, source):
        """û of α Δu = β u − s with α = 1, for cosines of norm 1 over the cells."""
        return (self.cosines @ source @ self.cosines.T) / self.stiffness

    def gradient(self, x_m):
        """∇u at places (n, 2)."""
        scale = np.sqrt(np.where(np.arange(CELLS) > 0, 2, 1) / CELLS)
        phases = [np.outer(x_m[:, i] - self.origin_m[i], self.waves_per_m[i]) for i in range(2)]
        values = [scale * np.cos(phase) for phase in phases]
        slopes = [-scale * self.waves_per_m[i] * np.sin(phases[i]) for i in range(2)]
        along_x = np.einsum("nk,kl,nl->n", slopes[0], self.potential, values[1], optimize=True)
        along_y = np.einsum("nk,kl,nl->n", values[0], self.potential, slopes[1], optimize=True)
        return np.stack([along_x, along_y], axis=1)
