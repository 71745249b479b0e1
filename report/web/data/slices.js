// SPDX-License-Identifier: BSD-3-Clause
// Makes slices through a box: pictures of a layer of the map in planes across its axes.
import { ACROSS_AND_UP, picture, planeOf } from './cosine_sums.js';
import { fullOf } from './targets.js';
import { clamp } from '../text.js';

const CELLS = 96,
  SAMPLES = 24;

// The end of a target's scale, and where it is densest, as shares of the box's sides.
export const rangeOf = (run, target) =>
  (target.range ??= rangeOfTarget(target.coefficients, run.mission.modes));

function rangeOfTarget(target, modes) {
  const values = new Float32Array(SAMPLES ** 3);
  for (let l = 0; l < SAMPLES; l++) {
    values.set(
      picture(planeOf(target, modes, 2, (l + 0.5) / SAMPLES), modes[0], modes[1], SAMPLES, SAMPLES),
      l * SAMPLES ** 2,
    );
  }
  let best = 0;
  values.forEach((v, i) => {
    if (v > values[best]) best = i;
  });
  const l = Math.floor(best / SAMPLES ** 2),
    j = Math.floor(best / SAMPLES) % SAMPLES,
    i = best % SAMPLES;
  return { full: fullOf(values), densest: [i, SAMPLES - 1 - j, l].map(k => (k + 0.5) / SAMPLES) };
}

// What is little is nearly transparent.
const alphaOf = (level, difference) => {
  const much = difference ? Math.abs(level - 127.5) / 127.5 : level / 255;
  return Math.round(255 * (0.22 + 0.74 * much ** 0.7));
};

// The plane across an axis at a share of the way along it.
export function sliceImage(run, { layer, row, colours }, axis, share) {
  const { modes } = run.mission,
    [a, b] = ACROSS_AND_UP[axis],
    { full } = rangeOf(run, run.targetAt(row)),
    difference = layer === 'difference';
  const { width, height, values } =
    layer === 'missed'
      ? run.missed(row, axis, share)
      : {
          width: CELLS,
          height: CELLS,
          values: picture(
            planeOf(run.coefficients(layer, row), modes, axis, share),
            modes[a],
            modes[b],
            CELLS,
            CELLS,
          ),
        };
  const table = difference ? colours.difference : colours.amount,
    zero = difference ? 127.5 : 0;
  const image = new ImageData(width, height),
    pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < pixels.length; i++) {
    const level = clamp(zero + (255 * values[i]) / full, 0, 255);
    pixels[i] = ((table[level | 0] & 0xffffff) | (alphaOf(level, difference) << 24)) >>> 0;
  }
  return image;
}

// The parts into which planes at `places`, null for none, divide each other, the farthest from an
// eye first: {axis, box: [low, high]}. `sides[axis]` says on which side of the plane the eye is.
export function partsOf(size, places, sides) {
  const parts = [];
  const visit = (axis, low, high) => {
    if (axis > 2) return;
    const at = places[axis];
    if (at === null) {
      visit(axis + 1, low, high);
      return;
    }
    const cut = corner => corner.map((v, i) => (i === axis ? at : v)),
      below = () => visit(axis + 1, low, cut(high)),
      above = () => visit(axis + 1, cut(low), high);
    (sides[axis] > 0 ? below : above)();
    parts.push({ axis, low: cut(low), high: cut(high) });
    (sides[axis] > 0 ? above : below)();
  };
  visit(0, [0, 0, 0], size);
  return parts;
}

// The corners of a part for SpaceGl.drawPlane().
export function cornersOf({ axis, low, high }, size) {
  const [a, b] = ACROSS_AND_UP[axis];
  return [
    [0, 0],
    [1, 0],
    [0, 1],
    [1, 1],
  ].map(([right, up]) => {
    const at = low.slice();
    if (right) at[a] = high[a];
    if (up) at[b] = high[b];
    return [...at, at[a] / size[a], 1 - at[b] / size[b]];
  });
}
