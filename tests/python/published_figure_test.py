# SPDX-License-Identifier: BSD-3-Clause
"""SMC follows a published figure of its metric, for the figure's first seconds; other weights do not.

published_figure_test.py FOLDER: studies/published_figure.
"""

import sys
import unittest

import numpy as np

sys.path.insert(0, sys.argv.pop())
import compare  # noqa: E402

from ergocast.bench.laws import smc

SECONDS = 16.5


class Figure(unittest.TestCase):
    def test_the_metric_is_that_of_the_figure(self):
        t_s, metric = compare.ours(SECONDS, compare.Published())
        read_s, published = compare.read(SECONDS)
        self.assertGreater(len(read_s), 12)
        self.assertLess(np.abs(np.interp(read_s, t_s, metric) - published).max(), compare.READABLE)
        # Its dip and its hump, read at 3.4 s and 4.7 s.
        early = (t_s > 2) & (t_s < 4)
        self.assertAlmostEqual(t_s[early][np.argmin(metric[early])], 3.4, delta=0.3)
        late = (t_s > 4) & (t_s < 6)
        self.assertAlmostEqual(t_s[late][np.argmax(metric[late])], 4.7, delta=0.3)

    def test_the_weights_of_the_paper_give_another_curve(self):
        class Paper(compare.Published):
            sobolev = smc.FirstOrder.sobolev

        t_s, metric = compare.ours(SECONDS, Paper())
        read_s, published = compare.read(SECONDS)
        self.assertGreater(np.abs(np.interp(read_s, t_s, metric) - published).max(), 2 * compare.READABLE)


if __name__ == "__main__":
    unittest.main()
