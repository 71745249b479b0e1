// SPDX-License-Identifier: BSD-3-Clause
// Reads tracks on a grid of ticks, as report/track_grid.h codes them.

export function bytesOf(base64) {
  const text = atob(base64),
    bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// One agent: p[2r], p[2r + 1] is its place at row r in metres from the domain's corner; NaN where
// nothing is known. In a box z[r] is its height there. h[r] is its heading, if the mission's vehicles have
// one: 256 are a turn to the left, from 0 along x.
export class Track {
  constructor(id, inBox) {
    this.id = id;
    this.p = new Float32Array(0);
    this.z = inBox ? new Float32Array(0) : null;
    this.h = null;
    this.first = Infinity;
    this.last = -1;
    this.count = 0; // of known rows
    this.member = [[0, Infinity]]; // rows in which its coverage counts, ascending
    this.way = new Float64Array(0); // metres gone up to a row, filled on demand
    this.known = 0;
    this.version = 0; // grows when rows have changed that were known
  }
  reserve(rows) {
    if (this.p.length >= 2 * rows) return;
    const most = Math.max(rows, this.p.length, 64),
      p = new Float32Array(2 * most).fill(NaN);
    p.set(this.p);
    this.p = p;
    for (const key of ['z', 'h'])
      if (this[key]) {
        const values = new Float32Array(most).fill(NaN);
        values.set(this[key]);
        this[key] = values;
      }
  }
  has(row) {
    return row >= 0 && 2 * row < this.p.length && this.p[2 * row] === this.p[2 * row];
  }
  // Whether rows between known ones were never received.
  get hasGaps() {
    return this.count < this.last + 1 - this.first;
  }
  // The newest row up to `row` that is known; −1: none.
  rowAt(row) {
    if (row > this.last) row = this.last;
    while (row >= this.first && !this.has(row)) row--;
    return row >= this.first ? row : -1;
  }
  // Metres between the places of two rows.
  between(i, k) {
    const { p, z } = this;
    return Math.hypot(p[2 * k] - p[2 * i], p[2 * k + 1] - p[2 * i + 1], z ? z[k] - z[i] : 0);
  }
  isMember(row) {
    return this.member.some(([from, until]) => row >= from && row < until);
  }
  // The way up to each row, in metres.
  distance(row) {
    if (this.way.length < this.p.length / 2) {
      const way = new Float64Array(this.p.length / 2);
      way.set(this.way);
      this.way = way;
    }
    for (; this.known <= row; this.known++) {
      const k = this.known,
        d = k > 0 ? this.between(k - 1, k) : 0;
      this.way[k] = (k > 0 ? this.way[k - 1] : 0) + (d === d ? d : 0);
    }
    return this.way[row];
  }
}

const coordinateOf = (track, axis) =>
  axis < 2 ? (k, v) => (track.p[2 * k + axis] = v) : (k, v) => (track.z[k] = v);

// The first row that a block adds or changes.
export const firstRowOf = ({ agents }) => Math.min(...agents.map(({ runs }) => runs[0] ?? Infinity));

// Adds a block of rows to the run's tracks. Returns the first row that it changed.
export function addTracks(run, block) {
  const bytes = bytesOf(block.data),
    full = 2 ** block.bits - 1;
  run.steps = run.size.map(l => l / full);
  let at = 0,
    first = Infinity;
  for (const { id, runs } of block.agents) {
    const track = run.track(id);
    if (block.headings) track.h ??= new Float32Array(track.p.length / 2).fill(NaN);
    for (let i = 0; i < runs.length; i += 2) {
      const from = runs[i],
        count = runs[i + 1];
      track.reserve(from + count > run.capacity ? from + count : Math.min(run.capacity, 2 * (from + count)));
      for (let k = from; k < from + count; k++) if (!track.has(k)) track.count++;
      const lists = [
        ...run.size.map((l, axis) => ({ scale: l / full, put: coordinateOf(track, axis) })),
        ...(block.headings ? [{ scale: 1, put: (k, v) => (track.h[k] = v) }] : []),
      ];
      for (const { scale, put } of lists) {
        for (let k = from, before = 0, beforeThat = 0; k < from + count; k++) {
          let z = 0,
            unit = 1,
            byte;
          do {
            byte = bytes[at++];
            z += (byte & 127) * unit;
            unit *= 128;
          } while (byte > 127);
          const v = (z % 2 ? -(z + 1) / 2 : z / 2) + 2 * before - beforeThat;
          beforeThat = before;
          before = v;
          put(k, v * scale);
        }
      }
      if (from <= track.last) track.version++;
      track.first = Math.min(track.first, from);
      track.last = Math.max(track.last, from + count - 1);
      track.known = Math.min(track.known, from);
      run.rows = Math.max(run.rows, from + count);
      first = Math.min(first, from);
    }
  }
  return first;
}
