# SPDX-License-Identifier: BSD-3-Clause
"""The target's density as the laws of papers know it: from its coefficients μ.

With f_k the cosines of the mission's basis and h_k² the integral of f_k² over the domain,

    ρ(x) = max(0, Σ_k μ_k f_k(x) / h_k²).

So each law knows of the target what the ergodic laws know, and no finer details.
"""

import numpy as np


def cosines_only(mission, law):
    """Refuses missions whose modes are no cosines."""
    if mission.basis.free_domain:
        raise ValueError(f"{law} needs cosines (leave out basis.free_domain)")


def wave_numbers(mission):
    """The half waves of each mode along x, y and in a box z: shape (axes,) + that of μ."""
    half_waves = np.indices(mission.mu.shape)
    return half_waves if mission.mu.ndim == 2 else half_waves[[1, 2, 0]]  # μ has z first


def squared_norms(mission):
    """h_k² = Π_i L_i · (1/2 if k_i > 0) [m², in a box m³], in the shape of μ."""
    size_m = np.asarray(mission.domain.size_m)[: len(wave_numbers(mission))]
    return np.prod(size_m) * 0.5 ** np.count_nonzero(wave_numbers(mission), axis=0)


def density(mission, x_m):
    """ρ at places (n, axes) [1/m², in a box 1/m³]."""
    cosines_only(mission, "the target's density")
    values = mission.basis.values(x_m, mission.domain)
    factors = mission.mu / squared_norms(mission)
    return np.maximum(0, np.tensordot(values, factors, axes=factors.ndim))


CELLS = {2: 64, 3: 24}
"""Cells along each axis, by the number of axes."""


def sampled(mission, count, axes, random):
    """Places of this density (count, axes): first the cell, then a place in it."""
    low_m = np.asarray(mission.domain.origin_m)[:axes]
    size_m = np.asarray(mission.domain.size_m)[:axes]
    shape = (CELLS[axes],) * axes
    index = np.indices(shape).reshape(axes, -1).T
    shares = np.cumsum(density(mission, low_m + size_m * (index + 0.5) / CELLS[axes]))
    cells = np.searchsorted(shares, random.random(count) * shares[-1], side="right")
    return low_m + size_m * (index[cells] + random.random((count, axes))) / CELLS[axes]
