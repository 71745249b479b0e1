# SPDX-License-Identifier: BSD-3-Clause
"""The laws of papers: each equation against a second computation, and their missions."""

import os
import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import ergocast
from ergocast.bench.laws import density_driven, hedac, kernel, random_walk, receding, smc, target

BENCH = Path(os.environ["ERGOCAST_SCENARIO_DIR"]) / "bench"
SHORT = {"time.duration_s": 30}


def mission_of(name, **fields):
    return ergocast.compile_mission(BENCH / f"{name}.textproto", set=fields)


def tick_of(mission, x_m, c, tick=0):
    """What a law gets."""
    n = len(x_m)
    return SimpleNamespace(mission=mission, tick=tick, t_s=tick * mission.dt_s, x_m=np.array(x_m, float),
                           c=c, mu=mission.mu, agents=np.arange(n),
                           u_max_mps=np.full(n, mission.law.u_max_mps))


class TheTarget(unittest.TestCase):
    def test_its_density_is_that_of_the_target(self):
        mission = mission_of("one_peak")
        places = np.random.default_rng(1).uniform(0, 2000, (50, 2))
        square = np.sum((places - (700, 1200)) ** 2, axis=1)
        exact = np.exp(-square / (2 * 200**2)) / (2 * np.pi * 200**2)
        self.assertTrue(np.allclose(target.density(mission, places), exact, atol=0.01 * exact.max()))

    def test_in_a_box_the_density_has_three_axes(self):
        mission = mission_of("box")
        peak, middle = target.density(mission, np.array([[250.0, 250, 750], [500, 500, 500]]))
        # One of eight Gaussians of 100 m; what lies outside the cube counts inside.
        self.assertAlmostEqual(peak * 8 * (2 * np.pi) ** 1.5 * 100**3, 1, delta=0.12)
        self.assertLess(middle, 0.1 * peak)


def smc_by_hand(mission, visited_m, x_m):
    """B of the paper for one place, mode by mode: a double loop over cosines."""
    size = mission.domain.size_m
    total = np.zeros(2)
    for m in range(mission.basis.modes_x):
        for n in range(mission.basis.modes_y):
            h = np.sqrt(np.prod(size) * (1 if m == 0 else 0.5) * (1 if n == 0 else 0.5))
            def f(p):
                return np.cos(m * np.pi * p[0] / size[0]) * np.cos(n * np.pi * p[1] / size[1]) / h
            deficit = sum(f(p) - mission.mu[m, n] / h for p in visited_m) * mission.dt_s
            phase = np.array([m, n]) * np.pi * x_m / size
            slope = -np.array([m, n]) * np.pi / size * np.sin(phase) * np.cos(phase[::-1]) / h
            total += (1 + m**2 + n**2) ** -1.5 * deficit * slope
    return total


class Smc(unittest.TestCase):
    def setUp(self):
        self.mission = mission_of("two_far", **{"basis.modes_x": 6, "basis.modes_y": 5})
        self.visited_m = np.random.default_rng(2).uniform(0, 2000, (6, 2))  # 2 agents, 3 ticks
        self.x_m = self.visited_m[-2:]
        values = self.mission.basis.values(self.visited_m, self.mission.domain)
        self.now = tick_of(self.mission, self.x_m, values.mean(axis=0), tick=2)

    def expected(self):
        return np.array([smc_by_hand(self.mission, self.visited_m, x) for x in self.x_m])

    def test_the_spectral_gradient_is_that_of_the_paper(self):
        gradient = smc.FirstOrder().spectral_gradients(self.now)
        self.assertTrue(np.allclose(gradient, self.expected(), rtol=1e-9, atol=0))

    def test_first_order_goes_against_it_at_full_speed(self):
        wanted = smc.FirstOrder().wanted_mps(self.now)
        b = self.expected()
        self.assertTrue(np.allclose(wanted, -20 * b / np.linalg.norm(b, axis=1)[:, None], rtol=1e-9))

    def test_second_order_adds_force_to_what_the_vehicle_did(self):
        law = smc.SecondOrder()
        law.before_m = self.x_m - np.array([[4.0, 0], [0, -3]])  # in 0.5 s: 8 m/s and −6 m/s
        velocity = np.array([[8.0, 0], [0, -6]])
        damping = 0.1 / 20**2 / 2000**2
        way = damping * velocity + self.expected()
        force = -(20**2 / (2 * 0.025 * 2000)) * way / np.linalg.norm(way, axis=1)[:, None]
        self.assertTrue(np.allclose(law.wanted_mps(self.now), velocity + 0.5 * force, rtol=1e-9))

    def test_second_order_is_never_faster_than_u_max(self):
        law = smc.SecondOrder()
        law.DAMPING = 0
        law.before_m = self.x_m - 10 * smc.directions(-self.expected())
        self.assertTrue(np.allclose(np.linalg.norm(law.wanted_mps(self.now), axis=1), 20))

    def test_without_a_gradient_agents_stay(self):
        mission = mission_of("uniform")
        at_rest = tick_of(mission, [[1000, 1000]], mission.mu)
        self.assertTrue(np.array_equal(smc.FirstOrder().wanted_mps(at_rest), [[0, 0]]))

    def test_it_is_the_classical_law_of_ergocast(self):
        """COVER without ε, noise, contraction and forecast has the same direction."""
        fields = {"basis.normalized": True, "law.regularization": "ABSOLUTE", "law.epsilon": 0,
                  "law.perturbation": "CONSTANT", "law.noise_intensity": 0,
                  "law.contraction_gain_per_s": 0, "law.anticipation": 0}
        mission = mission_of("four_peaks", **fields)
        team = ergocast.IdealTeam(mission)
        theirs = ergocast.IdealTeam(mission, law=smc.FirstOrder())
        team.step(40)
        theirs.step(40)
        self.assertLess(np.abs(team.positions_m - theirs.positions_m).max(), 1e-3)


def heat_by_differences(source, size_m, beta):
    """Δu = β u − s with no flux through edges: finite volumes, one dense system."""
    n = len(source)
    d_m = np.asarray(size_m) / n
    matrix = np.zeros((n * n, n * n))
    for i in range(n):
        for j in range(n):
            row = i * n + j
            matrix[row, row] += beta
            for di, dj in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                if 0 <= i + di < n and 0 <= j + dj < n:
                    weight = 1 / d_m[0 if di else 1] ** 2
                    matrix[row, row] += weight
                    matrix[row, (i + di) * n + j + dj] -= weight
    return np.linalg.solve(matrix, source.ravel()).reshape(n, n)


class Hedac(unittest.TestCase):
    def test_the_potential_solves_the_heat_equation(self):
        cells, hedac.CELLS = hedac.CELLS, 40
        self.addCleanup(setattr, hedac, "CELLS", cells)
        field = hedac.Field(mission_of("four_peaks"))
        field.cover(np.array([[600.0, 700], [1200, 300]]), 0.5)
        beta = 1 / (0.1 * 2000) ** 2
        expected = heat_by_differences(field.source(), (2000, 2000), beta)
        found = field.cosines.T @ field.potential @ field.cosines
        self.assertLess(np.abs(found - expected).max(), 0.02 * np.ptp(expected))
        # Its gradient: differences of that solution, between cells.
        d_m = 2000 / 40
        slopes = (expected[1:] - expected[:-1]) / d_m
        between = np.array([[(i + 1) * d_m, (17 + 0.5) * d_m] for i in range(39)])
        self.assertLess(np.abs(field.gradient(between)[:, 0] - slopes[:, 17]).max(), 0.04 * np.abs(slopes).max())
        slopes = (expected[:, 1:] - expected[:, :-1]) / d_m
        between = np.array([[(11 + 0.5) * d_m, (j + 1) * d_m] for j in range(39)])
        self.assertLess(np.abs(field.gradient(between)[:, 1] - slopes[11]).max(), 0.04 * np.abs(slopes).max())

    def test_a_cosine_of_heat_keeps_its_form(self):
        """For s = cos(2πx/L) cos(3πy/L) the equation has the solution s / (β + 13 π²/L²)."""
        field = hedac.Field(mission_of("four_peaks"))
        middles = (np.arange(64) + 0.5) / 64
        source = np.cos(2 * np.pi * middles)[:, None] * np.cos(3 * np.pi * middles)
        found = field.cosines.T @ field.solved(source) @ field.cosines
        factor = 1 / 200**2 + 13 * np.pi**2 / 2000**2
        self.assertTrue(np.allclose(found, source / factor, rtol=1e-9, atol=1e-9))

    def test_the_source_is_the_square_of_what_is_missing(self):
        field = hedac.Field(mission_of("uniform"))
        x_m = np.array([[1000.0, 1000]])
        field.cover(x_m, 0.5)
        field.cover(x_m, 0.5)
        area = 2000.0**2
        middles = (np.arange(64) + 0.5) / 64 * 2000
        gaussian = np.exp(-((middles[:, None] - 1000) ** 2 + (middles - 1000) ** 2) / (2 * 50**2))
        coverage = gaussian / (2 * np.pi * 50**2)
        missing = np.maximum(1 / area - coverage, 0) ** 2
        expected = missing / (missing.sum() * area / 64**2)
        self.assertTrue(np.allclose(field.source(), expected, rtol=1e-6, atol=1e-12))

    def test_agents_climb_at_full_speed(self):
        mission = mission_of("one_peak")
        wanted = hedac.Hedac().wanted_mps(tick_of(mission, [[700, 300], [1900, 1200]], mission.mu))
        self.assertTrue(np.allclose(np.linalg.norm(wanted, axis=1), 20))
        self.assertGreater(wanted[0, 1], 19)   # north, to the peak at (700, 1200)
        self.assertLess(wanted[1, 0], -19)     # west

    def test_boxes_and_walls_are_refused(self):
        for name, why in (("box", "the domain is a box"), ("rooms", "knows no walls")):
            with self.assertRaisesRegex(ValueError, why):
                hedac.Field(mission_of(name))


class Kernel(unittest.TestCase):
    @staticmethod
    def discrepancy(law, places_m):
        """MMD² but for its first term, pair by pair."""
        def k(a, b):
            return np.exp(-sum((u - v) ** 2 for u, v in zip(a, b)) / (2 * law.width_m**2))
        n = len(places_m)
        target = sum(m * k(x, y) for x in places_m for m, y in zip(law.mass, law.cells_m))
        return -2 / n * target + sum(k(x, y) for x in places_m for y in places_m) / n**2

    def test_the_next_place_lowers_the_discrepancy_along_the_gradient(self):
        self.addCleanup(setattr, kernel, "CELLS", kernel.CELLS)
        kernel.CELLS = {2: 12, 3: 6}
        for name in ("four_peaks", "box"):
            mission = mission_of(name)
            axes, size_m = mission.mu.ndim, np.asarray(mission.domain.size_m)[:mission.mu.ndim]
            law = kernel.Kernel()
            law.measure(mission, axes)
            visited_m = np.random.default_rng(3).uniform(0, 1, (7, axes)) * size_m
            law.visited_m = visited_m
            for x_m in visited_m[-3:]:
                # The derivative of the discrepancy with one more place there, by differences.
                slope, n = np.zeros(axes), len(visited_m)
                for i in range(axes):
                    step = np.eye(axes)[i] * 0.05
                    ends = [self.discrepancy(law, np.vstack([visited_m, x_m + s * step])) for s in (1, -1)]
                    slope[i] = (ends[0] - ends[1]) / 0.1
                gradient = law.gradient(x_m[None])[0]
                # The new place weighs 1/(n + 1); the mean of the visits then has n of n + 1 shares.
                mean = law.pull(x_m[None], visited_m, np.full(n, 1 / n))[0]
                descent = gradient + mean / (n + 1)
                expected = -slope * (n + 1) * law.width_m**2 / 2
                self.assertLess(np.abs(descent - expected).max(), 1e-4 * np.abs(expected).max() + 1e-12)

    def test_agents_go_at_full_speed_to_what_is_missing(self):
        mission = mission_of("one_peak")
        law = kernel.Kernel()
        wanted = law.wanted_mps(tick_of(mission, [[700, 900], [1000, 1200]], mission.mu))
        self.assertTrue(np.allclose(np.linalg.norm(wanted, axis=1), 20))
        self.assertGreater(wanted[0, 1], 19)   # north, to the peak at (700, 1200)
        self.assertLess(wanted[1, 0], -19)     # west


class Receding(unittest.TestCase):
    @staticmethod
    def metric(mission, paths_m, before_m):
        """Σ Λ_k (c_k − μ_k)² / h_k² of what agents have passed and will pass, mode by mode."""
        size = mission.domain.size_m
        places, total = np.concatenate([before_m, paths_m]).reshape(-1, 2), 0.0
        for m in range(mission.basis.modes_x):
            for n in range(mission.basis.modes_y):
                square = np.prod(size) * (1 if m == 0 else 0.5) * (1 if n == 0 else 0.5)
                f = np.cos(m * np.pi * places[:, 0] / size[0]) * np.cos(n * np.pi * places[:, 1] / size[1])
                total += (1 + m**2 + n**2) ** -1.5 * (f.mean() - mission.mu[m, n]) ** 2 / square
        return total

    def law_and_tick(self):
        """A law with a short plan, amid a mission of two agents."""
        mission = mission_of("two_far", **{"basis.modes_x": 5, "basis.modes_y": 4})
        before_m = np.random.default_rng(5).uniform(200, 1800, (4, 2, 2))  # ticks 0 to 3
        values = mission.basis.values(before_m.reshape(-1, 2), mission.domain)
        now = tick_of(mission, before_m[-1], values.mean(axis=0), tick=3)
        law = receding.Receding()
        law.prepare(mission, 2)
        law.steps = 6
        return law, now, before_m

    def test_the_plan_follows_the_slope_of_the_metric(self):
        """Each step goes against the derivative of the metric by all later places of this agent."""
        law, now, before_m = self.law_and_tick()
        self.addCleanup(setattr, receding, "GAIN", receding.GAIN)
        receding.GAIN = 0.01  # so small that nothing is shortened
        plan = np.random.default_rng(6).uniform(-14, 14, (6, 2, 2))
        paths_m = law.predicted(now, plan)
        wanted = law.improved(now, plan)
        places = 2 * (4 + 5)  # of both agents
        for step in range(6):
            for agent in range(2):
                for axis in range(2):
                    ends = []
                    for sign in (1, -1):
                        moved = paths_m.copy()
                        moved[step:, agent, axis] += sign * 0.01
                        ends.append(self.metric(now.mission, moved[1:], np.concatenate([before_m[:-1], moved[:1]])))
                    slope = (ends[0] - ends[1]) / 0.02 * places / 2
                    expected = -0.01 * 2000**2 * 20**2 * 0.5 * slope
                    self.assertAlmostEqual(wanted[step, agent, axis], expected, delta=1e-5 * np.abs(wanted).max())

    def test_the_plan_moves_on_by_one_step_each_tick(self):
        law, now, _ = self.law_and_tick()
        law.plan = np.zeros((6, 2, 2))
        first = law.wanted_mps(now)
        self.assertTrue(np.array_equal(first, law.plan[0]))
        expected = law.improved(now, np.concatenate([law.plan[1:], np.zeros((1, 2, 2))]))
        self.assertTrue(np.array_equal(law.wanted_mps(now), expected[0]))

    def test_predictions_end_at_edges_and_inputs_at_u_max(self):
        law, now, _ = self.law_and_tick()
        plan = np.full((6, 2, 2), 14.0) * [[[1, 1], [-1, -1]]]
        now.x_m = np.array([[1999.0, 1995], [1, 1000]])
        path_m = law.predicted(now, plan)
        self.assertEqual(path_m[-1, 0].tolist(), [2000, 2000])
        self.assertEqual(path_m[-1, 1].tolist(), [0, 1000 - 5 * 7])
        self.assertLessEqual(np.linalg.norm(law.improved(now, plan), axis=2).max(), 20 * (1 + 1e-12))


def chosen_by_hand(points_m, weights, share, x_m):
    """g of D²OC: sort all points, and take weight from the first until `share` is full."""
    ranked = sorted(range(len(points_m)), key=lambda i: np.sum((points_m[i] - x_m) ** 2) / weights[i] ** 2)
    mean, left = np.zeros(len(x_m)), share
    for i in ranked:
        part = min(left, weights[i])
        mean += part * points_m[i]
        left -= part
        if left <= 0:
            break
    return mean / (share - left)


class DensityDriven(unittest.TestCase):
    def law_with(self, points_m, weights, share):
        law = density_driven.DensityDriven()
        law.points_m, law.weights, law.share = np.array(points_m, float), np.array(weights, float), share
        return law

    def test_goals_are_those_of_a_sort(self):
        random = np.random.default_rng(7)
        for axes in (2, 3):
            for share in (0.003, 0.05):  # less than a point, and several
                points_m, weights = random.uniform(0, 1000, (80, axes)), random.uniform(0.004, 0.02, 80)
                law = self.law_with(points_m, weights, share)
                for x_m in random.uniform(0, 1000, (20, axes)):
                    expected = chosen_by_hand(points_m, weights, share, x_m)
                    self.assertTrue(np.allclose(law.goal(x_m), expected, rtol=0, atol=1e-9))

    def test_the_nearest_points_pay(self):
        law = self.law_with([[0, 0], [10, 0], [30, 0]], [0.2, 0.3, 0.5], 0.35)
        law.take(np.array([9.0, 0]))
        self.assertEqual(law.points_m.tolist(), [[0, 0], [30, 0]])
        self.assertTrue(np.allclose(law.weights, [0.15, 0.5], atol=1e-15))

    def test_after_the_last_step_nothing_is_left(self):
        mission = mission_of("one_peak", **SHORT)
        law, random = density_driven.DensityDriven(), np.random.default_rng(8)
        x_m = np.array([[700.0, 1200], [300, 300], [1900, 100]])
        for tick in range(mission.tick_count):
            law.wanted_mps(tick_of(mission, x_m, mission.mu, tick))
            x_m = random.uniform(0, 2000, (3, 2))
        self.assertLess(law.weights.sum(), 1e-9)
        self.assertTrue(np.isfinite(law.wanted_mps(tick_of(mission, x_m, mission.mu))).all())

    def test_the_first_input_is_that_of_the_whole_horizon(self):
        """K by one linear system: the minimum of Σ (x_h − g)² + COST (u_h dt)² over all inputs."""
        steps = density_driven.HORIZON
        sums = np.tril(np.ones((steps, steps)))  # places by inputs
        way = np.linalg.solve(sums.T @ sums + density_driven.COST * np.eye(steps), sums.T @ np.ones(steps))
        self.assertAlmostEqual(density_driven.gain(), way[0], places=12)

    def test_points_have_the_density_of_the_target(self):
        points_m = target.sampled(mission_of("two_far"), 8000, 2, np.random.default_rng(9))
        self.assertAlmostEqual(np.mean(np.linalg.norm(points_m - (300, 300), axis=1) < 500), 0.8, delta=0.05)
        self.assertAlmostEqual(np.mean(np.linalg.norm(points_m - (1700, 1700), axis=1) < 500), 0.2, delta=0.05)


class RandomWalks(unittest.TestCase):
    def test_the_walk_spends_its_time_as_the_target_demands(self):
        """A long chain by next_goal() alone, without motion: its histogram is the density."""
        mission = mission_of("one_peak")
        walk = random_walk.RandomWalk()
        now = tick_of(mission, [[700, 1200]], mission.mu)
        walk.wanted_mps(now)
        place, inside = np.array([700.0, 1200]), []
        for _ in range(20000):
            place, ticks = walk.next_goal(now, place, 10.0)
            inside.append(np.linalg.norm(place - (700, 1200)) < 200)
        self.assertEqual(ticks, 10)  # 100 m at 10 m a tick
        # Within one standard deviation of a Gaussian of the plane.
        self.assertAlmostEqual(np.mean(inside), 1 - np.exp(-0.5), delta=0.05)

    def test_steps_have_one_length_and_the_chances_of_the_paper(self):
        mission = mission_of("one_peak")
        walk = random_walk.RandomWalk()
        now = tick_of(mission, [[1000, 1200]], mission.mu)
        walk.wanted_mps(now)
        here = np.array([1000.0, 1200])
        lengths = np.array([np.linalg.norm(walk.next_goal(now, here, 10.0)[0] - here) for _ in range(4000)])
        self.assertTrue(np.all((lengths == 0) | np.isclose(lengths, 100)))
        angles = (np.arange(3600) + 0.5) * np.pi / 1800
        ring = here + 100 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        ratio = target.density(mission, ring) / target.density(mission, here[None])
        self.assertAlmostEqual(np.mean(lengths > 0), np.minimum(1, ratio).mean(), delta=0.03)

    def test_waypoints_have_the_density_of_the_target(self):
        mission = mission_of("two_far")
        law = random_walk.Waypoints()
        now = tick_of(mission, [[1000, 1000]], mission.mu)
        law.wanted_mps(now)
        goals = np.array([law.next_goal(now, now.x_m[0], 10.0)[0] for _ in range(8000)])
        first = np.linalg.norm(goals - (300, 300), axis=1) < 500
        second = np.linalg.norm(goals - (1700, 1700), axis=1) < 500
        self.assertAlmostEqual(first.mean(), 0.8, delta=0.05)
        self.assertAlmostEqual(second.mean(), 0.2, delta=0.05)

    def test_agents_arrive_and_draw_anew(self):
        run = ergocast.simulate(BENCH / "two_far.textproto", set={"time.duration_s": 300},
                                law=random_walk.Waypoints)
        speeds = np.linalg.norm(run.velocities_mps, axis=2)
        self.assertGreater(np.mean(np.isclose(speeds, 20)), 0.9)
        self.assertLess(run.positions_m[:, :, 0].min(), 500)


class Missions(unittest.TestCase):
    def test_every_law_runs_in_the_domains_that_it_allows_and_repeats(self):
        everywhere = [smc.FirstOrder, smc.SecondOrder, kernel.Kernel, receding.Receding, density_driven.DensityDriven,
                      random_walk.RandomWalk, random_walk.Waypoints]
        for name in ("four_peaks", "rooms", "box"):
            laws = everywhere + ([hedac.Hedac] if name == "four_peaks" else [])
            for law in laws:
                with self.subTest(f"{law.__name__}, {name}"):
                    runs = [ergocast.simulate(BENCH / f"{name}.textproto", set=SHORT, law=law) for _ in "12"]
                    self.assertTrue(runs[0].trajectory.equals(runs[1].trajectory))
                    self.assertTrue(np.isfinite(runs[0].positions_m).all())


if __name__ == "__main__":
    unittest.main()
