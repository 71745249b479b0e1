// SPDX-License-Identifier: BSD-3-Clause
// Computes how likely the team has found an object, and where it may still be, for any row.
// The rules are those of core/measure/detection.h; the cells and the ticks between two looks come with the
// mission. Each cell counts the looks of sensors near it since the newest target began. Going back in time
// takes looks away again, so that a step of the slider costs only the looks in between. Where the page has
// not every tick, agents move straight between two rows.
import { ACROSS_AND_UP, picture, planeOf } from './cosine_sums.js';

const MOST_LOOKS = 8; // between two rows
const SHARES = [0.5, 0.8];

// Takes the mass out of the cells whose middles are in walls, in a plane.
function emptyWalls(mass, walls, [nx, ny], [sx, sy]) {
  for (let i = 0; i < nx; i++) {
    const x = (i + 0.5) * sx,
      crossings = [];
    for (const ring of walls)
      ring.forEach(([x1, y1], k) => {
        const [x0, y0] = ring[(k || ring.length) - 1];
        if (x0 > x !== x1 > x) crossings.push(y0 + ((x - x0) / (x1 - x0)) * (y1 - y0));
      });
    crossings.sort((a, b) => a - b);
    for (let j = 0, passed = 0; j < ny; j++) {
      while (passed < crossings.length && crossings[passed] < (j + 0.5) * sy) passed++;
      if (passed % 2) mass[(ny - 1 - j) * nx + i] = 0;
    }
  }
}

// How likely an object that is drawn from a target is in each cell; all 0 if the target is not known.
function massesOf({ mission }, target, count, side) {
  const { modes, walls = [] } = mission,
    [M, N] = modes,
    [nx, ny, nz] = count,
    mass = new Float64Array(nx * ny * nz);
  if (!target.known) return mass;
  for (let l = 0; l < nz; l++) {
    const { coefficients: c } = target,
      layer = modes.length > 2 ? planeOf(c, modes, 2, (l + 0.5) / nz) : c;
    mass.set(picture(layer, M, N, nx, ny), l * nx * ny);
  }
  if (modes.length === 2) emptyWalls(mass, walls, count, side);
  let total = 0;
  mass.forEach((m, i) => (total += mass[i] = Math.max(0, m)));
  return total > 0 ? mass.map(m => m / total) : mass;
}

export class Detection {
  constructor(run) {
    const { sensor, dt_s: dt } = run.mission,
      { cells: count } = sensor,
      // Fewer looks suffice where the page has few ticks.
      period = Math.max(sensor.ticks_per_look, Math.ceil(run.stride / MOST_LOOKS));
    Object.assign(this, { run, count, period, phase: Math.floor(period / 2), radius: sensor.radius_m });
    this.side = count.map((n, axis) => (run.size[axis] ?? 0) / n);
    this.missedInLook = Math.exp(-sensor.detections_per_s * dt * period);
    this.powers = [1]; // missedInLook to the power of 0, 1, …
    this.looks = null; // of each cell, the north-west of the lowest layer first
    this.reset();
  }
  // What was counted may have changed.
  reset() {
    this.target = null;
  }
  // Forgets the looks that need places of `row` or later ones, before these change.
  rewind(row) {
    if (!this.target) return;
    if (this.target.row >= row) this.reset();
    else if (this.looksUntil(row - 1) < this.done) this.at(row - 1);
  }
  // How many looks there are before so many ticks that count.
  looksIn(ticks) {
    return Math.max(0, Math.ceil((ticks - this.phase) / this.period));
  }
  counted(tick) {
    const { run } = this,
      { dt_s: dt } = run.mission;
    return Math.round(run.counted(tick * dt) / dt);
  }
  looksUntil(row) {
    return this.looksIn(this.counted(row * this.run.stride) + (this.run.heldAt(row) ? 0 : 1));
  }
  begin(target) {
    const { run, count, side } = this;
    target.mass ??= massesOf(run, target, count, side);
    this.looks ??= new Uint32Array(target.mass.length);
    this.looks.fill(0);
    this.begun = this.counted(target.from); // in ticks that count
    this.first = this.done = this.looksIn(this.begun);
    Object.assign(this, { target, found: 0, times: SHARES.map(() => null) });
  }
  // Counts looks up to a row, until `stop` at the latest. Whether all are counted.
  build(row, stop) {
    const target = this.run.targetAt(row),
      wanted = this.looksUntil(row);
    if (target !== this.target || wanted - this.first < this.done - wanted) this.begin(target);
    while (this.done !== wanted) {
      if (performance.now() >= stop) return false;
      if (this.done < wanted) this.look(this.done++, 1);
      else this.look(--this.done, -1);
    }
    return true;
  }
  at(row) {
    this.build(row, Infinity);
    return this;
  }
  // How likely an object of the target that holds at a row has been found by then; NaN if it is not known.
  probability(row) {
    return this.at(row).target.known ? this.found : NaN;
  }
  // Adds or takes away look number `number` of all sensors.
  look(number, by) {
    const { run } = this,
      counted = number * this.period + this.phase;
    let tick = counted;
    for (const [from, until] of run.holds) if (tick >= from) tick += (until ?? Infinity) - from;
    const row = tick / run.stride,
      before = Math.floor(row),
      after = Math.ceil(row),
      share = row - before;
    for (const track of run.tracks) {
      if (!track.has(before) || !track.has(after) || !track.isMember(after)) continue;
      if (run.restsAt(track.id, tick, counted) || run.charges(track, after)) continue;
      const { p, z } = track,
        between = (v, w) => v + share * (w - v),
        x = between(p[2 * before], p[2 * after]),
        y = between(p[2 * before + 1], p[2 * after + 1]),
        up = z ? between(z[before], z[after]) : 0;
      const at = [x, y, up];
      if (run.size.every((l, axis) => at[axis] >= 0 && at[axis] <= l)) this.see(at, by);
    }
    SHARES.forEach((least, i) => {
      if (this.found < least) this.times[i] = null;
      else this.times[i] ??= (counted + 1 - this.begun) * run.mission.dt_s;
    });
  }
  // The cells along an axis whose middles are at most `reach` from `at`: the first, and the last.
  near(axis, at, reach) {
    if (this.count[axis] === 1) return [0, 0];
    const middle = at / this.side[axis] - 0.5,
      half = reach / this.side[axis];
    return [Math.max(0, Math.ceil(middle - half)), Math.min(this.count[axis] - 1, Math.floor(middle + half))];
  }
  see([x, y, z], by) {
    const { radius, side, count, run } = this,
      [nx, ny] = count,
      [lowest, highest] = this.near(2, z, radius),
      [west, east] = this.near(0, x, radius);
    for (let l = lowest; l <= highest; l++) {
      const up = run.inBox ? (l + 0.5) * side[2] - z : 0;
      for (let i = west; i <= east; i++) {
        const left = radius ** 2 - ((i + 0.5) * side[0] - x) ** 2 - up ** 2;
        if (left < 0) continue;
        const [south, north] = this.near(1, y, Math.sqrt(left));
        for (let j = south; j <= north; j++) this.note(l * nx * ny + (ny - 1 - j) * nx + i, by);
      }
    }
  }
  // One look more or less at a cell.
  note(cell, by) {
    const { looks, powers, target } = this,
      before = looks[cell],
      now = before + by;
    if (now >= powers.length) powers.push(this.missedInLook ** now);
    looks[cell] = now;
    this.found += target.mass[cell] * (powers[before] - powers[now]);
  }
  // Where an object may be that has not been found up to a row, in multiples of the uniform density, the
  // north-west first: in the plane across an axis, or averaged along it if `share` of the way is null.
  missed(row, axis, share) {
    const { looks, powers, count, target, found } = this.at(row),
      [nx, ny, nz] = count,
      [a, b] = ACROSS_AND_UP[axis],
      width = count[a],
      height = count[b];
    const first = share === null ? 0 : Math.min(count[axis] - 1, Math.floor(share * count[axis])),
      depth = share === null ? count[axis] : 1,
      scale = (nx * ny * nz) / depth / Math.max(1 - found, 1e-9),
      steps = [1, -nx, nx * ny],
      corner = (ny - 1) * nx; // the cell (0, 0, 0)
    const values = new Float32Array(width * height);
    for (let v = 0, o = 0; v < height; v++)
      for (let u = 0; u < width; u++, o++) {
        let cell = corner + u * steps[a] + (height - 1 - v) * steps[b] + first * steps[axis];
        for (let k = 0; k < depth; k++, cell += steps[axis])
          values[o] += scale * target.mass[cell] * powers[looks[cell]];
      }
    return { width, height, values };
  }
  // How likely an object at a place of the plane has not been found up to a row.
  missedAt(row, x, y) {
    const { looks, powers, count, side } = this.at(row),
      [i, j] = [x, y].map((v, axis) => Math.min(count[axis] - 1, Math.floor(v / side[axis])));
    return powers[looks[(count[1] - 1 - j) * count[0] + i]];
  }
}

// The probability after each row, which a running team appends to.
export class FoundCurve {
  constructor(run) {
    this.detection = new Detection(run);
    this.values = [];
    this.changed = 0; // the first row whose value takeChanged() has not named
  }
  // Computes the values up to a row, until `stop` at the latest. Whether all are there.
  build(row, stop) {
    const { values, detection } = this;
    while (values.length <= row) {
      if (!detection.build(values.length, stop)) return false;
      values.push(detection.probability(values.length));
    }
    return true;
  }
  at(row) {
    this.build(row, Infinity);
    return this.values[row];
  }
  // The first row that is new or has changed since the last call.
  takeChanged() {
    const first = this.changed;
    this.changed = this.values.length;
    return first;
  }
  forget(row) {
    this.values.length = Math.min(this.values.length, row);
    this.changed = Math.min(this.changed, row);
  }
  reset(row) {
    this.forget(row);
    this.detection.reset();
  }
  rewind(row) {
    this.forget(row);
    this.detection.rewind(row);
  }
}
