# SPDX-License-Identifier: BSD-3-Clause
"""Descent of the kernel ergodic metric, a maximum mean discrepancy (MMD).

C. Hughes, H. Warren, D. Lee, F. Ramos and I. Abraham, "Ergodic trajectory optimization on generalized
domains using maximum mean discrepancy", arXiv 2410.10599 (2024); M. M. Sun, A. Gaggar, P. Trautman
and T. Murphey, "Fast ergodic search with kernel functions", IEEE Transactions on Robotics 41 (2025).

With a kernel k and the n places x_i where the team has been, the discrepancy is

    MMD² = ∬ k(x, y) ρ(x) ρ(y) dx dy − (2/n) Σ_i ∫ k(x_i, y) ρ(y) dy + (1/n²) Σ_i Σ_l k(x_i, x_l)

The papers optimise whole trajectories by it. Here each agent goes at each tick where the next place
lowers it most, as kernel herding does (Y. Chen, M. Welling and A. Smola, "Super-samples from kernel
herding", UAI 2010):

    h(x) = ∫ k(x, y) ρ(y) dy − (1/n) Σ_i k(x, x_i),      x_j' = u_max ∇h / ‖∇h‖

k is a Gaussian with standard deviation WIDTH · √area, in a box WIDTH · ∛volume. The integral is the sum
over the middles of cells. Edges and walls do not bend it.
"""

import numpy as np

import ergocast
from ergocast.bench.laws.smc import directions
from ergocast.bench.laws.target import density

WIDTH = 0.025
CELLS = {2: 64, 3: 24}  # along each axis, by the number of axes


class Kernel(ergocast.Law):
    """x_j' = u_max ∇h / ‖∇h‖"""

    def __init__(self):
        self.visited_m = None

    def wanted_mps(self, now):
        if self.visited_m is None:
            self.measure(now.mission, now.x_m.shape[1])
        self.visited_m = np.concatenate([self.visited_m, now.x_m])
        return now.u_max_mps[:, None] * directions(self.gradient(now.x_m))

    def measure(self, mission, axes):
        """The target in cells of equal size, of mass 1."""
        low_m = np.asarray(mission.domain.origin_m)[:axes]
        size_m = np.asarray(mission.domain.size_m)[:axes]
        shares = (np.arange(CELLS[axes]) + 0.5) / CELLS[axes]
        grid = np.meshgrid(*[shares] * axes, indexing="ij")
        self.cells_m = low_m + size_m * np.stack(grid, axis=-1).reshape(-1, axes)
        mass = density(mission, self.cells_m)
        self.mass = mass / mass.sum()
        self.width_m = WIDTH * np.prod(size_m) ** (1 / axes)
        self.visited_m = np.empty((0, axes))

    def gradient(self, x_m):
        """∇h at places (n, axes), but for a positive factor."""
        visits = np.full(len(self.visited_m), 1 / len(self.visited_m))
        return self.pull(x_m, self.cells_m, self.mass) - self.pull(x_m, self.visited_m, visits)

    def pull(self, x_m, to_m, mass):
        """Σ_i mass_i k(x, to_i) (to_i − x) for each x."""
        square = np.sum((x_m[:, None] - to_m) ** 2, axis=2)
        kernel = mass * np.exp(-0.5 * square / self.width_m**2)
        return kernel @ to_m - kernel.sum(axis=1, keepdims=True) * x_m
