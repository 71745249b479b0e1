// SPDX-License-Identifier: BSD-3-Clause
// c_k from positions, for any row at once: the sums are kept every 128 rows. Where kinds of agents
// see differently, each place counts with its kind's quality and footprint.
const EVERY = 128;

export class Coverage {
  constructor(run) {
    [this.M, this.N] = run.mission.modes;
    this.run = run;
    this.cx = new Float64Array(this.M);
    this.cy = new Float64Array(this.N);
    this.reset(0);
  }
  // The planned kind of an agent, or null where all see alike.
  sensorOf(id) {
    const { seen } = this.run.mission;
    return seen ? seen.find(kind => (id -= kind.count) < 0) ?? seen[0] : null;
  }
  // Forgets what rows from `row` on say: they have changed.
  reset(row) {
    const keep = Math.floor(row / EVERY) + 1;
    if (!row || !this.sums) {
      this.sums = [new Float64Array(this.M * this.N)];  // sums[i]: Σ f_k over the rows [0, 128 i)
      this.counts = [0];                                // how many positions these are
    }
    this.sums.length = this.counts.length = Math.min(this.sums.length, keep);
    if (!this.sum || this.upto > row) { this.sum = this.sums[0].slice(); this.count = 0; this.upto = 0; }
  }
  add(sum, from, to) {
    const { M, N, cx, cy, run } = this, [lx, ly] = run.size;
    let count = 0;
    cx[0] = cy[0] = 1;
    for (const track of run.tracks) {
      const sensor = this.sensorOf(track.id);
      for (const [begin, until] of track.member) {
        const { p } = track, end = Math.min(to, until, track.last + 1);
        for (let k = Math.max(from, begin, track.first); k < end; k++) {
          const px = p[2 * k], py = p[2 * k + 1];
          if (!(px >= 0 && px <= lx && py >= 0 && py <= ly)) continue;
          count += sensor ? sensor.quality : 1;
          const x = Math.cos((Math.PI * px) / lx), y = Math.cos((Math.PI * py) / ly);
          if (M > 1) cx[1] = x;
          if (N > 1) cy[1] = y;
          for (let m = 2; m < M; m++) cx[m] = 2 * x * cx[m - 1] - cx[m - 2];
          for (let n = 2; n < N; n++) cy[n] = 2 * y * cy[n - 1] - cy[n - 2];
          for (let m = 0, i = 0; m < M; m++) {
            const c = cx[m];
            if (sensor) for (let n = 0; n < N; n++, i++) sum[i] += sensor.qg[i] * c * cy[n];
            else for (let n = 0; n < N; n++) sum[i++] += c * cy[n];
          }
        }
      }
    }
    return count;
  }
  // Makes checkpoints for at most `budget` ms; true when all are there.
  build(budget) {
    const stop = performance.now() + budget, last = Math.floor(this.run.rows / EVERY);
    while (this.sums.length <= last) {
      if (performance.now() > stop) return false;
      const i = this.sums.length, sum = this.sums[i - 1].slice();
      this.counts.push(this.counts[i - 1] + this.add(sum, (i - 1) * EVERY, i * EVERY));
      this.sums.push(sum);
    }
    return true;
  }
  // c_k over the rows 0 … row.
  at(row) {
    const to = row + 1, mark = Math.min(Math.floor(to / EVERY), this.sums.length - 1);
    if (to < this.upto || mark * EVERY > this.upto) {
      this.sum.set(this.sums[mark]);
      this.count = this.counts[mark];
      this.upto = mark * EVERY;
    }
    this.count += this.add(this.sum, this.upto, to);
    this.upto = to;
    return this.count ? this.sum.map(s => s / this.count) : this.sum.slice();
  }
  // φ² up to that row; NaN if nothing was covered.
  metric(row) {
    const { target, weights } = this.run.mission, c = this.at(row);
    let sum = 0;
    for (let k = 0; k < c.length; k++) sum += weights[k] * (c[k] - target[k]) ** 2;
    return this.count ? sum : NaN;
  }
  // Σ c_k f_k / mean(f_k²) on a grid, the north-west first.
  picture(c, width, height) {
    const { M, N } = this, key = width + 'x' + height;
    if (this.key !== key) {
      const table = (modes, size, flip) => Float32Array.from({ length: modes * size }, (_, i) => {
        const m = Math.floor(i / size), j = i % size, u = ((flip ? size - 1 - j : j) + 0.5) / size;
        return Math.cos(m * Math.PI * u) * (m ? 2 : 1);
      });
      Object.assign(this, { key, tx: table(M, width, false), ty: table(N, height, true),
        out: new Float32Array(width * height), columns: new Float32Array(M * height) });
    }
    const { tx, ty, out, columns } = this;
    out.fill(0);
    columns.fill(0);
    for (let m = 0; m < M; m++) for (let n = 0; n < N; n++) {
      const v = c[m * N + n];
      for (let j = 0; j < height; j++) columns[m * height + j] += v * ty[n * height + j];
    }
    for (let m = 0; m < M; m++) for (let j = 0; j < height; j++) {
      const v = columns[m * height + j];
      for (let i = 0, o = j * width; i < width; i++) out[o++] += v * tx[m * width + i];
    }
    return out;
  }
}
