// SPDX-License-Identifier: BSD-3-Clause
// Keeps a track's places along chosen axes in one array, which follows the track as it grows.
const AXES = 'xyz';

// A place's coordinate along an axis, in metres from the domain's corner.
export const coordinate = (track, axis, k) => (axis < 2 ? track.p[2 * k + axis] : track.z[k]);

// "xz" → [0, 2].
export const axesOf = name => [...name].map(letter => AXES.indexOf(letter));
export const nameOf = axis => AXES[axis];

export class Places {
  // What is copied is `factors[i]` times the coordinate along axes[i].
  constructor(track, axes, factors = axes.map(() => 1)) {
    Object.assign(this, { track, axes, factors, rows: 0, version: -1, array: new Float32Array(0) });
  }
  // Copies what is new; the first row that it wrote, and the number of rows if there was none.
  update() {
    const { track, axes, factors } = this,
      width = axes.length,
      capacity = track.p.length / 2,
      rows = track.last + 1;
    if (this.version !== track.version) {
      this.version = track.version;
      this.rows = 0;
    }
    if (this.array.length < width * capacity) {
      const array = new Float32Array(width * capacity).fill(NaN);
      array.set(this.array);
      this.array = array;
    }
    const first = this.rows;
    for (let k = first; k < rows; k++)
      for (let i = 0; i < width; i++) this.array[width * k + i] = factors[i] * coordinate(track, axes[i], k);
    this.rows = Math.max(rows, 0);
    return first;
  }
}
