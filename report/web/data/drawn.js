// SPDX-License-Identifier: BSD-3-Clause
// Computes with a target that is drawn on the map: its density, its modes, and how far it is from others.
// Places are in metres from the domain's corner.
import { picture, planeOf } from './cosine_sums.js';

const CELLS = 96, // along the longer side
  BOX_CELLS = 40, // the same in a box
  FINE = 4, // places along each side of such a cell
  COMPARED = 24; // layers of a box in which two targets are compared
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

// Which share of a cell is inside a ring, by `fine` × `fine` of its places.
function shareInside(ring, [x, y], [dx, dy], fine) {
  let count = 0;
  for (let i = 0; i < fine; i++)
    for (let j = 0; j < fine; j++)
      if (inside([ring], x + ((i + 0.5) / fine - 0.5) * dx, y + ((j + 0.5) / fine - 0.5) * dy)) count++;
  return count / fine ** 2;
}

// The density of one part, which has mass 1, in a cell of that size: as seen from above, and the factor at a
// height.
function densityOf({ kind, at, z: middle, spread, corners, heights }, cell) {
  if (kind === 'polygon') {
    const level = 1 / Math.max(areaOf(corners), 1e-9),
      [low, high] = heights ?? [0, 0];
    return {
      above: (x, y) => level * shareInside(corners, [x, y], cell, cell[2] ? FINE : 1),
      up: z => {
        const common = Math.min(z + cell[2] / 2, high) - Math.max(z - cell[2] / 2, low);
        return Math.max(0, common) / cell[2] / Math.max(high - low, 1e-9);
      },
    };
  }
  const level = 1 / (2 * Math.PI * spread ** 2);
  return {
    above: (x, y) => level * Math.exp(-((x - at[0]) ** 2 + (y - at[1]) ** 2) / (2 * spread ** 2)),
    up: z => Math.sqrt(level) * Math.exp(-((z - middle) ** 2) / (2 * spread ** 2)),
  };
}

// Whether a part has a height, if it needs one.
export function isSound({ kind, z, heights }) {
  if (kind === 'peak') return z === undefined || isFinite(z);
  return !heights || heights[0] < heights[1];
}

// {width, height, depth, values}: the density in multiples of the uniform one. The lowest layer comes first,
// and in each the north-west; a plane has one layer. Null if no part of it is in the domain. Walls have none.
export function gridOf(parts, uniform, [lx, ly, lz], walls = []) {
  const scale = (lz ? BOX_CELLS : CELLS) / Math.max(lx, ly, lz ?? 0),
    [width, height] = [lx, ly].map(l => Math.max(8, Math.round(l * scale))),
    depth = lz ? Math.max(12, Math.round(lz * scale)) : 1,
    cell = [lx / width, ly / height, lz ? lz / depth : 0],
    densities = parts.map(part => densityOf(part, cell)),
    level = (parts.length * uniform) / (1 - uniform) / (lx * ly * (lz ?? 1)),
    factors = densities.map(({ up }) =>
      Float64Array.from({ length: depth }, (_, l) => (lz ? up(((l + 0.5) / depth) * lz) : 1)),
    ),
    values = new Float64Array(width * height * depth);
  let sum = 0;
  for (let j = 0; j < height; j++)
    for (let i = 0; i < width; i++) {
      const x = ((i + 0.5) / width) * lx,
        y = (1 - (j + 0.5) / height) * ly;
      if (walls.length && inside(walls, x, y)) continue;
      const above = densities.map(density => density.above(x, y));
      for (let l = 0; l < depth; l++) {
        const value = above.reduce((total, v, k) => total + v * factors[k][l], level);
        values[(l * height + j) * width + i] = value;
        sum += value;
      }
    }
  if (!(sum > 0)) return null;
  return { width, height, depth, values: values.map(value => (value * values.length) / sum) };
}

// The grid as seen from above: the average of its layers.
export function seenFromAbove({ width, height, depth, values }) {
  const seen = new Float64Array(width * height);
  values.forEach((value, i) => {
    seen[i % seen.length] += value / depth;
  });
  return { width, height, values: seen };
}

const wave = (k, i, size) => Math.cos((k * Math.PI * (i + 0.5)) / size);

// μ of a density on a grid: the mean of density · cos(mπx) · cos(nπy), in a box also · cos(lπz).
export function modesOf({ width, height, depth, values }, [M, N, P = 1]) {
  const mu = new Float64Array(M * N * P),
    cells = width * height;
  for (let layer = 0; layer < depth; layer++) {
    const flat = layerModes(values.subarray(layer * cells, (layer + 1) * cells), width, height, M, N);
    for (let l = 0; l < P; l++) {
      const c = wave(l, layer, depth) / depth;
      for (let k = 0; k < flat.length; k++) mu[l * flat.length + k] += c * flat[k];
    }
  }
  return mu;
}

function layerModes(values, width, height, M, N) {
  const columns = new Float64Array(M * height),
    mu = new Float64Array(M * N);
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

// The density of coefficients on all cells of a grid, layer by layer.
function densitiesOf(c, modes) {
  const [M, N] = modes;
  if (modes.length < 3) return [picture(c, M, N, 48, 48)];
  return Array.from({ length: COMPARED }, (_, l) =>
    picture(planeOf(c, modes, 2, (l + 0.5) / COMPARED), M, N, COMPARED, COMPARED),
  );
}

// What a new target would change at a row: φ² of the coverage so far against it and against the present
// target, and the share of its mass that is elsewhere than in the present target.
export function comparison(run, row, mu) {
  const { weights, modes } = run.mission,
    c = run.coverage.at(row),
    present = run.targetAt(row).coefficients,
    apart = other => c.reduce((sum, v, k) => sum + weights[k] * (v - other[k]) ** 2, 0);
  const layers = densitiesOf(
    mu.map((v, k) => v - present[k]),
    modes,
  );
  const all = layers.reduce((sum, layer) => sum + layer.reduce((total, v) => total + Math.abs(v), 0), 0);
  return {
    against: apart(mu),
    present: apart(present),
    moved: Math.min(1, all / 2 / (layers.length * layers[0].length)),
  };
}

// Decimals that resolve a ten-thousandth of the domain.
function rounding(size) {
  const digits = Math.max(0, Math.ceil(4 - Math.log10(Math.max(...size))));
  return v => Number(v.toFixed(digits));
}

// Places and heights in the scenario's coordinates, rounded.
export function placing({ size_m: size, origin_m: origin }) {
  const rounded = rounding(size);
  return {
    rounded,
    placed: at => at.map((v, k) => rounded(v + origin[k])),
    height: z => rounded(z + origin[2]),
  };
}

// What the page sends: {peaks: [[x, y, σ]], polygons: [[[x, y]]], uniform} in the scenario's coordinates. In
// a box peaks are [x, y, z, σ], and heights_m has [low, high] of each polygon.
export function requestOf(parts, uniform, mission) {
  const { rounded, placed, height } = placing(mission),
    inBox = mission.size_m.length > 2,
    of = kind => parts.filter(part => part.kind === kind);
  const request = {
    peaks: of('peak').map(({ at, z, spread }) => [
      ...placed(at),
      ...(inBox ? [height(z)] : []),
      rounded(spread),
    ]),
    polygons: of('polygon').map(({ corners }) => corners.map(placed)),
    uniform,
  };
  if (inBox) request.heights_m = of('polygon').map(({ heights }) => heights.map(height));
  return request;
}

// The same as a scenario's text.
export function textOf({ peaks, polygons, uniform, heights_m: heights }) {
  const lines = peaks.map(peak => {
    const z = peak.length > 3 ? `  mean_z_m: ${peak[2]}` : '';
    const centre = `mean_x_m: ${peak[0]}  mean_y_m: ${peak[1]}${z}`;
    return `  gaussians { ${centre}  sigma_m: ${peak.at(-1)}  weight: 1 }`;
  });
  polygons.forEach((corners, i) => {
    const vertices = corners.map(([x, y]) => `\n    vertices { x_m: ${x}  y_m: ${y} }`),
      z = heights ? `\n    low_z_m: ${heights[i][0]}  high_z_m: ${heights[i][1]}` : '';
    lines.push(`  regions { weight: 1  polygon {${vertices.join('')}${z}\n  } }`);
  });
  const parts = peaks.length + polygons.length;
  if (uniform > 0) lines.push(`  uniform_weight: ${+((parts * uniform) / (1 - uniform)).toFixed(4)}`);
  return `target {\n${lines.join('\n')}\n}\n`;
}
