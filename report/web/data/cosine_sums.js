// SPDX-License-Identifier: BSD-3-Clause
// Sums cosines: makes pictures of coefficients, in multiples of the uniform density.

const tables = new Map();

// cos(mπu) / mean of its square, for the middles of `size` cells and all m < modes.
function table(modes, size, flip) {
  const key = [modes, size, flip].join();
  if (!tables.has(key)) {
    tables.set(
      key,
      Float32Array.from({ length: modes * size }, (_, i) => {
        const m = Math.floor(i / size),
          j = i % size,
          u = ((flip ? size - 1 - j : j) + 0.5) / size;
        return Math.cos(m * Math.PI * u) * (m ? 2 : 1);
      }),
    );
  }
  return tables.get(key);
}

// Σ c_k f_k / mean(f_k²) of M × N modes on a grid, the north-west first.
export function picture(c, M, N, width, height) {
  const tx = table(M, width, false),
    ty = table(N, height, true);
  const out = new Float32Array(width * height),
    columns = new Float32Array(M * height);
  for (let m = 0; m < M; m++)
    for (let n = 0; n < N; n++) {
      const v = c[m * N + n];
      for (let j = 0; j < height; j++) columns[m * height + j] += v * ty[n * height + j];
    }
  for (let m = 0; m < M; m++)
    for (let j = 0; j < height; j++) {
      const v = columns[m * height + j];
      for (let i = 0, o = j * width; i < width; i++) out[o++] += v * tx[m * width + i];
    }
  return out;
}

// The two axes of a plane: what its picture has to the right, and upwards.
export const ACROSS_AND_UP = [
  [1, 2],
  [0, 2],
  [0, 1],
];

// What modes [M, N, P] say of a plane across an axis, as modes of the plane. `weight(k)` is what mode
// k of that axis counts for.
function contracted(c, [M, N, P], axis, weight) {
  const [a, b] = ACROSS_AND_UP[axis],
    modes = [M, N, P],
    out = new Float64Array(modes[a] * modes[b]);
  for (let l = 0, i = 0; l < P; l++)
    for (let m = 0; m < M; m++)
      for (let n = 0; n < N; n++, i++) {
        const k = [m, n, l];
        out[k[a] * modes[b] + k[b]] += c[i] * weight(k[axis]);
      }
  return out;
}

// Coefficients of the plane at a share of the way along the axis.
export const planeOf = (c, modes, axis, share) =>
  contracted(c, modes, axis, k => Math.cos(k * Math.PI * share) * (k ? 2 : 1));

// Averaged along the axis.
export const averageOf = (c, modes, axis) => contracted(c, modes, axis, k => (k ? 0 : 1));
