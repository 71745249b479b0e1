# SPDX-License-Identifier: BSD-3-Clause
"""The median of some runs with its interval, as studies, figures and the bench show it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pandas as pd


def interval(values: pd.Series | npt.ArrayLike) -> tuple[float, float, float]:
    """The median between the ends of its interval of 95 %: from the r-th smallest value to the r-th
    largest, r by the binomial distribution; of fewer than six, from the smallest to the largest."""
    found = np.sort(np.asarray(values, dtype=float))
    found = found[~np.isnan(found)]
    n = len(found)
    if n == 0:
        return math.nan, math.nan, math.nan
    k = np.arange(1, n // 2 + 1)
    log_terms = np.cumsum([n * math.log(0.5), *np.log((n - k + 1) / k)])
    rank = max(1, int(np.sum(np.cumsum(np.exp(log_terms)) <= 0.025)))
    return float(found[rank - 1]), float(np.median(found)), float(found[n - rank])
