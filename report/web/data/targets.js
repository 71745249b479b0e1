// SPDX-License-Identifier: BSD-3-Clause
// Holds a mission's targets: the plan's, and those that replaced it while the mission ran.
import { picture } from './cosine_sums.js';
import { bytesOf } from './tracks.js';

let made = 0;

// A target holds from its row until that of the next one.
export class Target {
  // `number`: of the amendment, null for the plan's target; `density()` makes the picture.
  constructor({ number, from, row, hash, coefficients, known, density }) {
    Object.assign(this, { id: ++made, number, from, row, hash, coefficients, known, makeDensity: density });
  }
  sameAs(other) {
    return ['number', 'from', 'hash', 'known'].every(key => this[key] === other[key]);
  }
  // {width, height, full, cells}: the picture, the north-west first; 255 is `full` times the average.
  get density() {
    return (this.picture ??= this.makeDensity());
  }
}

export function plannedTarget({ target, density, modes: [M, N], size_m: size }) {
  return new Target({
    number: null,
    from: 0,
    row: 0,
    coefficients: target,
    known: true,
    density: () => decodeDensity(density) ?? targetOfModes(target, M, N, size),
  });
}

// The target of an amendment. Without coefficients it is one that the page never received: all zero.
export function amendedTarget({ number, from, hash }, coefficients, run) {
  const { mission, stride, size } = run,
    [M, N] = mission.modes,
    c = coefficients ?? mission.target.map(() => 0);
  return new Target({
    number,
    from,
    row: Math.ceil(from / stride),
    hash,
    coefficients: c,
    known: Boolean(coefficients),
    // The modes of the wire begin with those without waves along z.
    density: () => targetOfModes(c, M, N, size),
  });
}

// The first row at which two lists of targets differ.
export function firstDifference(before, now) {
  const i = now.findIndex((target, k) => target !== before[k]),
    k = i < 0 ? now.length : i;
  return Math.min(before[k]?.row ?? Infinity, now[k]?.row ?? Infinity);
}

// The end of a scale of these values: few are above it.
export function fullOf(values) {
  const sorted = Float32Array.from(values).sort();
  return Math.max(2, sorted[Math.floor(0.998 * (sorted.length - 1))]);
}

// Without a recorded density the picture is what the modes say of the target.
export function targetOfModes(target, M, N, [lx, ly]) {
  const most = 160,
    scale = most / Math.max(lx, ly);
  const width = Math.max(16, Math.round(lx * scale)),
    height = Math.max(16, Math.round(ly * scale));
  const values = picture(target, M, N, width, height),
    full = fullOf(values);
  return {
    width,
    height,
    full,
    cells: Uint8Array.from(values, v => Math.max(1, Math.min(255, (255 * v) / full))),
  };
}

function decodeDensity(coded) {
  return coded && { width: coded.width, height: coded.height, full: coded.full, cells: bytesOf(coded.data) };
}
