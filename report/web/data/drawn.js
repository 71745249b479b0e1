// SPDX-License-Identifier: BSD-3-Clause
// Computes with a target that is drawn on the map: its density, its modes, and how far it is from others.
// Places are in metres from the domain's corner.
import { picture } from './cosine_sums.js';

const CELLS = 96; // along the longer side
export const MOST_PARTS = 16; // peaks and polygons
export const MOST_BYTES = 3500; // of a request's target

// Whether a place is inside an odd number of rings.
export function inside(rings, x, y) {
  let odd = false;
  for (const ring of rings)
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
      const [xi, yi] = ring[i],
        [xj, yj] = ring[j];
      if (yi > y !== yj > y && x < xi + ((y - yi) / (yj - yi)) * (xj - xi)) odd = !odd;
    }
  return odd;
}

function areaOf(ring) {
  let sum = 0;
  for (let i = 0, j = ring.length - 1; i < ring.length; j = i++)
    sum += ring[j][0] * ring[i][1] - ring[i][0] * ring[j][1];
  return Math.abs(sum) / 2;
}

// The density of one part, which has mass 1.
function densityOf({ kind, at, spread, corners }) {
  if (kind === 'polygon') {
    const level = 1 / Math.max(areaOf(corners), 1e-9);
    return (x, y) => (inside([corners], x, y) ? level : 0);
  }
  const level = 1 / (2 * Math.PI * spread ** 2);
  return (x, y) => level * Math.exp(-((x - at[0]) ** 2 + (y - at[1]) ** 2) / (2 * spread ** 2));
}

// {width, height, values}: the density in multiples of the uniform one, the north-west first; null if no part
// of it is in the domain. Walls have none of it.
export function gridOf(parts, uniform, [lx, ly], walls = []) {
  const scale = CELLS / Math.max(lx, ly),
    width = Math.max(8, Math.round(lx * scale)),
    height = Math.max(8, Math.round(ly * scale)),
    densities = parts.map(densityOf),
    level = (parts.length * uniform) / (1 - uniform) / (lx * ly),
    values = new Float64Array(width * height);
  let sum = 0;
  for (let j = 0; j < height; j++)
    for (let i = 0; i < width; i++) {
      const x = ((i + 0.5) / width) * lx,
        y = (1 - (j + 0.5) / height) * ly;
      if (walls.length && inside(walls, x, y)) continue;
      const value = densities.reduce((total, density) => total + density(x, y), level);
      values[j * width + i] = value;
      sum += value;
    }
  if (!(sum > 0)) return null;
  return { width, height, values: values.map(value => (value * values.length) / sum) };
}

// μ of a density on a grid, with M × N modes: the mean of density · cos(mπx) · cos(nπy).
export function modesOf({ width, height, values }, M, N) {
  const columns = new Float64Array(M * height),
    mu = new Float64Array(M * N);
  const wave = (k, i, size) => Math.cos((k * Math.PI * (i + 0.5)) / size);
  for (let m = 0; m < M; m++)
    for (let i = 0; i < width; i++) {
      const c = wave(m, i, width);
      for (let j = 0; j < height; j++) columns[m * height + j] += c * values[j * width + i];
    }
  for (let n = 0; n < N; n++)
    for (let j = 0; j < height; j++) {
      const c = wave(n, height - 1 - j, height) / values.length;
      for (let m = 0; m < M; m++) mu[m * N + n] += c * columns[m * height + j];
    }
  return mu;
}

// What a new target would change at a row: φ² of the coverage so far against it and against the present
// target, and the share of its mass that is elsewhere than in the present target.
export function comparison(run, row, mu) {
  const { weights } = run.mission,
    [M, N] = run.mission.modes,
    c = run.coverage.at(row),
    present = run.targetAt(row).coefficients,
    apart = other => c.reduce((sum, v, k) => sum + weights[k] * (v - other[k]) ** 2, 0);
  const difference = picture(
    mu.map((v, k) => v - present[k]),
    M,
    N,
    48,
    48,
  );
  return {
    against: apart(mu),
    present: apart(present),
    moved: Math.min(1, difference.reduce((sum, v) => sum + Math.abs(v), 0) / 2 / difference.length),
  };
}

// Decimals that resolve a ten-thousandth of the domain.
function rounding(size) {
  const digits = Math.max(0, Math.ceil(4 - Math.log10(Math.max(...size))));
  return v => Number(v.toFixed(digits));
}

// What the page sends: {peaks: [[x, y, σ]], polygons: [[[x, y]]], uniform} in the scenario's coordinates.
export function requestOf(parts, uniform, { size_m: size, origin_m: origin }) {
  const rounded = rounding(size),
    placed = at => at.map((v, k) => rounded(v + origin[k]));
  const of = kind => parts.filter(part => part.kind === kind);
  return {
    peaks: of('peak').map(({ at, spread }) => [...placed(at), rounded(spread)]),
    polygons: of('polygon').map(({ corners }) => corners.map(placed)),
    uniform,
  };
}

// The same as a scenario's text.
export function textOf({ peaks, polygons, uniform }) {
  const lines = peaks.map(
    ([x, y, s]) => `  gaussians { mean_x_m: ${x}  mean_y_m: ${y}  sigma_m: ${s}  weight: 1 }`,
  );
  for (const corners of polygons) {
    const vertices = corners.map(([x, y]) => `\n    vertices { x_m: ${x}  y_m: ${y} }`);
    lines.push(`  regions { weight: 1  polygon {${vertices.join('')}\n  } }`);
  }
  const parts = peaks.length + polygons.length;
  if (uniform > 0) lines.push(`  uniform_weight: ${+((parts * uniform) / (1 - uniform)).toFixed(4)}`);
  return `target {\n${lines.join('\n')}\n}\n`;
}
