// SPDX-License-Identifier: BSD-3-Clause
// Computes the ticks and names of a box's axes.
import { ticksOf } from '../axes.js';
import { nameOf } from '../data/places.js';
import { stretchOf } from '../data/stretch.js';

// Ticks of an axis from the box's corner; their texts are in the scenario's coordinates.
export function ticksFor(run, axis) {
  const origin = run.mission.origin_m[axis],
    ticks = ticksOf({ low: origin, high: origin + run.size[axis], log: false });
  return ticks.map(({ at, text }) => ({ at: at - origin, text }));
}

// "x [m]"; of heights that are drawn longer than they are, "z [m] × 10".
export const axisName = (size, axis) =>
  `${nameOf(axis)} [m]${axis === 2 && stretchOf(size) > 1 ? ` × ${stretchOf(size)}` : ''}`;
