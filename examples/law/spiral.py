# SPDX-License-Identifier: BSD-3-Clause
"""A law of your own. docs/laws.md explains it."""

import numpy as np

import ergocast


class Spiral(ergocast.Law):
    """Agents circle the middle of the domain, farther and nearer by turns."""

    def wanted_mps(self, now):
        domain = now.mission.domain
        out_m = now.x_m - (domain.origin_m + domain.size_m / 2)
        radius_m = np.maximum(np.linalg.norm(out_m, axis=1), 1)
        wanted_m = domain.size_m.min() / 2 * abs(np.sin(now.t_s / 100))
        along_m = out_m[:, ::-1] * [-1, 1]  # a quarter turn to the left
        way_m = along_m + out_m * (wanted_m / radius_m - 1)[:, None]
        length_m = np.maximum(np.linalg.norm(way_m, axis=1), 1e-9)
        return way_m * (now.u_max_mps / length_m)[:, None]
