// SPDX-License-Identifier: BSD-3-Clause
// Computes the coverage c_k from positions, for any row at once.
// The sums are kept every 128 rows. The order is that of the wire: the modes along z count slowest, those
// along y fastest. Where kinds of agents see differently, each place counts with its kind's quality and
// footprint. With a half-life, all sums are halved at its ticks, as in core/mission/half_life.h.
// After a change of the target each place counts against the target of its own time: c_k is compared with the
// average of the targets, each weighted by what was covered while it held. With law.history KEEP it is
// compared with the present target.
const EVERY = 128;

// cos(m π u) of all m, by recurrence.
function cosines(table, u) {
  const c = Math.cos(Math.PI * u);
  table[0] = 1;
  if (table.length > 1) table[1] = c;
  for (let m = 2; m < table.length; m++) table[m] = 2 * c * table[m - 1] - table[m - 2];
}

export class Coverage {
  constructor(run) {
    [this.M, this.N, this.P = 1] = run.mission.modes;
    this.run = run;
    this.cx = new Float64Array(this.M);
    this.cy = new Float64Array(this.N);
    this.cz = new Float64Array(this.P);
    this.reset(0);
  }
  // The planned kind of an agent, or null where all see alike.
  sensorOf(id) {
    const { seen } = this.run.mission;
    return seen ? (seen.find(kind => (id -= kind.count) < 0) ?? seen[0]) : null;
  }
  // Forgets what rows from `row` on say: they have changed.
  reset(row) {
    const keep = Math.floor(row / EVERY) + 1;
    if (!row || !this.sums) {
      // sums[i]: Σ f_k over the rows [0, 128 i), halved as often as at the last of them
      this.sums = [new Float64Array(this.M * this.N * this.P)];
      this.counts = [[]]; // how many positions these are, of each target's time
    }
    this.sums.length = this.counts.length = Math.min(this.sums.length, keep);
    if (!this.sum || this.upto > row) {
      this.sum = this.sums[0].slice();
      this.counted = [];
      this.upto = 0;
    }
  }
  // How many positions at() has counted.
  get count() {
    return this.counted.reduce((sum, n) => sum + n, 0);
  }
  // How often coverage has been halved by the sample of a row.
  halvingsAt(row) {
    const { dt_s, half_life_ticks } = this.run.mission;
    if (!half_life_ticks || row < 0) return 0;
    return Math.floor(Math.round(this.run.counted(row * this.run.step) / dt_s) / half_life_ticks);
  }
  // Adds the rows [from, to) to a sum and to the counts of those before.
  add(sum, counted, from, to) {
    if (from >= to) return;
    const { M, N, P, cx, cy, cz, run } = this,
      [lx, ly, lz] = run.size,
      { targets } = run,
      forgets = run.mission.half_life_ticks > 0,
      halvings = this.halvingsAt(to - 1),
      left = row => (forgets ? 2 ** Math.max(-512, this.halvingsAt(row) - halvings) : 1),
      weights = Float64Array.from({ length: to - from }, (_, i) => left(from + i)),
      kept = left(from - 1);
    if (kept !== 1) for (const numbers of [sum, counted]) numbers.forEach((n, i) => (numbers[i] = n * kept));
    cz[0] = 1;
    for (const track of run.tracks) {
      const sensor = this.sensorOf(track.id),
        rest = run.firstRest(track.id);
      for (const [begin, until] of track.member) {
        const { p, z } = track,
          end = Math.min(to, until, rest, track.last + 1);
        let holds = 0; // which target
        for (let k = Math.max(from, begin, track.first); k < end; k++) {
          const px = p[2 * k],
            py = p[2 * k + 1];
          if (run.holds.length && run.heldAt(k)) continue; // the mission is paused
          if (k > begin && run.charges(track, k)) continue;
          if (!(px >= 0 && px <= lx && py >= 0 && py <= ly)) continue;
          const weight = weights[k - from];
          while (targets[holds + 1]?.row <= k) holds++;
          counted[holds] = (counted[holds] ?? 0) + weight * (sensor ? sensor.quality : 1);
          cosines(cx, px / lx);
          cosines(cy, py / ly);
          if (z) cosines(cz, z[k] / lz);
          for (let l = 0, i = 0; l < P; l++)
            for (let m = 0; m < M; m++) {
              const c = weight * cz[l] * cx[m];
              if (sensor) for (let n = 0; n < N; n++, i++) sum[i] += sensor.qg[i] * c * cy[n];
              else for (let n = 0; n < N; n++) sum[i++] += c * cy[n];
            }
        }
      }
    }
  }
  // Makes checkpoints for at most `budget` ms; true when all are there.
  build(budget) {
    const stop = performance.now() + budget,
      last = Math.floor(this.run.rows / EVERY);
    while (this.sums.length <= last) {
      if (performance.now() > stop) return false;
      const i = this.sums.length,
        sum = this.sums[i - 1].slice(),
        counted = this.counts[i - 1].slice();
      this.add(sum, counted, (i - 1) * EVERY, i * EVERY);
      this.counts.push(counted);
      this.sums.push(sum);
    }
    return true;
  }
  // c_k over the rows 0 … row.
  at(row) {
    const to = row + 1,
      mark = Math.min(Math.floor(to / EVERY), this.sums.length - 1);
    if (to < this.upto || mark * EVERY > this.upto) {
      this.sum.set(this.sums[mark]);
      this.counted = this.counts[mark].slice();
      this.upto = mark * EVERY;
    }
    this.add(this.sum, this.counted, this.upto, to);
    this.upto = to;
    const { count } = this;
    return count ? this.sum.map(s => s / count) : this.sum.slice();
  }
  // The average of the targets that what at() returned last is compared with.
  meanTarget() {
    const { counted, count } = this,
      { targets, mission } = this.run;
    if (mission.keeps_history) return this.run.targetAt(this.upto - 1).coefficients;
    if (count === (counted[0] ?? 0)) return targets[0].coefficients;
    return targets[0].coefficients.map((_, k) =>
      counted.reduce((sum, n, i) => sum + (n / count) * targets[i].coefficients[k], 0),
    );
  }
  // φ² up to that row; NaN if nothing was covered.
  metric(row) {
    const { weights } = this.run.mission,
      c = this.at(row),
      target = this.meanTarget();
    let sum = 0;
    for (let k = 0; k < c.length; k++) sum += weights[k] * (c[k] - target[k]) ** 2;
    return this.count ? sum : NaN;
  }
}
