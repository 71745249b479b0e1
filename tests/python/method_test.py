# SPDX-License-Identifier: BSD-3-Clause
"""The method in Python, against numpy's own arithmetic."""

import unittest

import numpy as np

import ergocast
from ergocast import Basis, Controller, CoverageTable, Domain, Gaussian, IdealTeam, Region, Target

DOMAIN = Domain(origin_m=(-1, 2), size_m=(4, 3))
BASIS = Basis(5, 6)
PLACES = np.random.default_rng(1).uniform((-1, 2), (3, 5), (50, 2))


def cosines(x_m):
    u = (np.atleast_2d(x_m) - DOMAIN.origin_m) / DOMAIN.size_m
    m, n = np.arange(5), np.arange(6)
    return np.cos(np.pi * u[:, :1] * m)[:, :, None] * np.cos(np.pi * u[:, 1:] * n)[:, None, :]


class OfTheBasis(unittest.TestCase):
    def test_values(self):
        np.testing.assert_allclose(BASIS.values(PLACES, DOMAIN), cosines(PLACES), atol=1e-13)

    def test_gradient(self):
        weights, h = np.random.default_rng(2).normal(size=(5, 6)), 1e-6
        steps = np.array([[h, 0], [0, h]])
        slope = [
            ((cosines(PLACES + d) - cosines(PLACES - d)) * weights).sum(axis=(1, 2)) / (2 * h)
            for d in steps
        ]
        np.testing.assert_allclose(
            BASIS.gradient(weights, PLACES, DOMAIN), np.transpose(slope), atol=1e-7
        )

    def test_weights_and_metric(self):
        k2 = np.arange(5)[:, None] ** 2 + np.arange(6) ** 2
        np.testing.assert_allclose(BASIS.weights(DOMAIN), (1.0 + k2) ** -1.5)
        norm = Basis(5, 6, "norm", 2, normalized=True)
        h2 = 12 * np.where(np.arange(5) > 0, 0.5, 1)[:, None] * np.where(np.arange(6) > 0, 0.5, 1)
        np.testing.assert_allclose(norm.weights(DOMAIN), (1 + np.sqrt(k2)) ** -2.0 / h2)
        c, mu = np.random.default_rng(3).normal(size=(2, 5, 6))
        phi2 = (BASIS.weights(DOMAIN) * (c - mu) ** 2).sum()
        self.assertAlmostEqual(ergocast.ergodic_metric(c, mu, BASIS, DOMAIN), phi2, places=12)


class OfTargets(unittest.TestCase):
    def check(self, target, atol):
        n = 400
        u = (np.stack(np.meshgrid(*[(np.arange(n) + 0.5) / n] * 2, indexing="ij"), -1)).reshape(-1, 2)
        x_m = DOMAIN.origin_m + u * DOMAIN.size_m
        rho = target.density(x_m, DOMAIN)
        mu, error = target.coefficients(DOMAIN, BASIS)
        self.assertLess(error, 1e-9)
        np.testing.assert_allclose(
            mu, np.tensordot(rho, cosines(x_m), 1) * 12 / n**2, atol=atol
        )

    def test_gaussians(self):
        self.check(Target([Gaussian((1, 3), sigma_m=0.4)]), 2e-6)
        self.check(Target([Gaussian((0, 3), covariance_m2=[[1, 0.4], [0.4, 0.5]], weight=2)], 1), 1e-4)

    def test_regions_and_keep_outs(self):
        region = Region([(0, 2.5), (2, 2.5), (1, 4.5)], [[(0.9, 3), (1.1, 3), (1, 3.2)]])
        self.check(Target(regions=[region], uniform_weight=0.5), 2e-3)
        self.check(Target(uniform_weight=1, keep_outs=[region]), 2e-3)

    def test_refusals(self):
        for make, said in (
            (lambda: Gaussian((0, 0)), "sigma_m or covariance_m2"),
            (lambda: Gaussian((0, 0), sigma_m=0), "sigma_m"),
            (lambda: Gaussian((0, 0), sigma_m=1, weight=-1), "weight"),
            (lambda: Gaussian((0, 0, 0), sigma_m=1), r"shape must be \(2,\), not \(3,\)"),
            (lambda: Gaussian((0, np.nan), sigma_m=1), "mean_m: every number must be finite"),
            (lambda: Gaussian((0, 0), covariance_m2=[[1, 2], [2, 1]]), "positive definite"),
            (lambda: Region([(0, 0), (1, 1), (0, 1), (1, 0)]), "outline_m: "),
            (lambda: Region([(0, 0), (1, 1)]), "outline_m: "),
            (lambda: Region([]), "outline_m"),
            (lambda: Target().coefficients(DOMAIN, BASIS), "no mass"),
            (lambda: Target([Gaussian((1e9, 0), sigma_m=1)]).density(PLACES, DOMAIN), "no mass"),
        ):
            with self.assertRaisesRegex(ValueError, said):
                make()


class OfTheTable(unittest.TestCase):
    def table(self, samples):
        table = CoverageTable(BASIS, DOMAIN, 0.1)
        for agent, x_m in samples:
            table.add_sample(agent, x_m)
        return table

    def test_average(self):
        table = self.table(enumerate(PLACES))
        np.testing.assert_allclose(table.average(), cosines(PLACES).mean(axis=0), atol=1e-12)
        self.assertAlmostEqual(table.covered_s, 5)
        self.assertEqual(table.steps(3), 1)
        self.assertIsNone(table.steps(3, incarnation=9))

    def test_merging_is_a_join(self):
        a = self.table([(0, p) for p in PLACES[:9]])
        b = self.table([(0, p) for p in PLACES[:4]] + [(1, p) for p in PLACES[9:]])
        self.assertEqual(a.merge(b), 1)
        self.assertEqual(a.merge(b), 0)
        np.testing.assert_allclose(a.average(), cosines(PLACES).mean(axis=0), atol=1e-12)
        with self.assertRaisesRegex(ValueError, "theirs"):
            a.merge(CoverageTable(Basis(4, 4), DOMAIN, 0.1))

    def test_full(self):
        table = CoverageTable(BASIS, DOMAIN, 0.1)
        for life in range(512):
            table.add_sample(life % 128, (0, 3), incarnation=life + 1)
        with self.assertRaisesRegex(ValueError, "full"):
            table.add_sample(0, (0, 3), incarnation=1000)
        with self.assertRaisesRegex(ValueError, "agent"):
            table.add_sample(128, (0, 3))


class OfTheController(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mission = ergocast.compile_mission("paper_fig2b", seed=5)

    def test_commands_are_those_of_the_team(self):
        team = IdealTeam(self.mission)
        controller = Controller(self.mission)
        for tick in range(20):
            before = team.positions_m
            team.step()
            controller.set_coverage(team.coverage)
            for agent, x_m in enumerate(before):
                command = controller.command(agent, tick, x_m)
                self.assertTrue(np.array_equal(command, team.velocities_mps[agent]))
        self.assertEqual(controller.metric(team.coverage), team.metric)
        gradient = self.mission.basis.gradient(
            self.mission.basis.weights(self.mission.domain) * (team.coverage - self.mission.mu),
            before[-1:], self.mission.domain,
        )
        np.testing.assert_allclose(controller.spectral_gradient, gradient[0], rtol=1e-9)

    def test_refusals(self):
        controller = Controller(self.mission)
        for make, said in (
            (lambda: controller.set_coverage(np.zeros((2, 2))), "coverage: the shape must be"),
            (lambda: controller.command(-1, 0, (0, 0)), "agent"),
            (lambda: controller.command(0, -1, (0, 0)), "tick"),
            (lambda: controller.command(0, 0, (0, np.inf)), "x_m: every number must be finite"),
            (lambda: IdealTeam(self.mission, edges="open"), "edges"),
            (lambda: IdealTeam(self.mission).step(-1), "count"),
            (lambda: Basis(0, 5), "modes_x"),
            (lambda: Basis(5, 65), "modes_y"),
            (lambda: Basis(5, 5, "l2"), "sobolev_form"),
            (lambda: Domain(size_m=(0, 1)), "size_m"),
            (lambda: Domain(origin_m=(1e14, 1)), "origin_m"),
            (lambda: CoverageTable(BASIS, DOMAIN, 0), "dt_s"),
        ):
            with self.assertRaisesRegex(ValueError, said):
                make()


if __name__ == "__main__":
    unittest.main()
