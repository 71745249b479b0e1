// SPDX-License-Identifier: BSD-3-Clause
// Views a mission in a box along one axis: the result is a run in a plane, which the map can draw.
import { averageOf, picture } from './cosine_sums.js';
import { Places, axesOf } from './places.js';
import { Target, targetOfModes } from './targets.js';
import { stretchOf } from './stretch.js';

function projectedTrack(track, axes, factors) {
  const places = new Places(track, axes, factors),
    seen = Object.create(track);
  Object.defineProperty(seen, 'p', {
    get() {
      places.update();
      return places.array;
    },
  });
  seen.distance = row => track.distance(row);
  return seen;
}

// The run in two dimensions: `name` is "xy", "xz" or "yz", and the view is along the third axis. It
// changes with the run, which is its `whole`. Heights of a flat box are drawn `stretch[1]` times too large.
export function projected(run, name) {
  run.projections ??= new Map();
  if (run.projections.has(name)) return run.projections.get(name);
  const axes = axesOf(name),
    hidden = 3 - axes[0] - axes[1],
    { mission } = run,
    { modes } = mission,
    [a, b] = axes,
    tracks = new Map(),
    targets = new WeakMap();
  const pick = list => axes.map(axis => list[axis]),
    stretch = axes.map(axis => (axis === 2 ? stretchOf(mission.size_m) : 1));
  const size = pick(mission.size_m).map((l, i) => l * stretch[i]);
  // For the view from above, the record contains the density itself.
  const viewed = target =>
    new Target({
      ...target,
      density: () =>
        hidden === 2
          ? target.density
          : targetOfModes(averageOf(target.coefficients, modes, hidden), modes[a], modes[b], size),
    });
  const seen = Object.assign(Object.create(run), {
    whole: run,
    axes,
    size,
    stretch,
    pace: undefined,
    mission: { ...mission, size_m: size, box_m: mission.size_m, origin_m: pick(mission.origin_m) },
    targetAt: row => {
      const target = run.targetAt(row);
      if (!targets.has(target)) targets.set(target, viewed(target));
      return targets.get(target);
    },
    picture: (layer, row, width, height) =>
      picture(averageOf(run.coefficients(layer, row), modes, hidden), modes[a], modes[b], width, height),
    missed: row => run.missed(row, hidden),
  });
  Object.defineProperty(seen, 'tracks', {
    get: () =>
      run.tracks.map(track => {
        if (!tracks.has(track)) tracks.set(track, projectedTrack(track, axes, stretch));
        return tracks.get(track);
      }),
  });
  run.projections.set(name, seen);
  return seen;
}
