// SPDX-License-Identifier: BSD-3-Clause
// Holds a study as its page shows it: points, questions and choices, without any drawing.
import { readable, seconds, share } from '../text.js';

const estimate = key => ({
  value: point => point[key]?.[0],
  bounds: point => (point[key] ? [point[key][1], point[key][2]] : undefined),
});
const plain = of => ({ value: of, bounds: () => undefined });
const escaped = key => point => point.escapes?.[key];

// What can be asked of a point. `better`: −1 less is better, 1 more, 0 neither.
export const QUANTITIES = {
  metric: {
    title: 'φ² in cosines at the end',
    means: 'How far coverage is from the target at the last tick: median of the seeds, and its 95 % interval',
    log: true,
    better: -1,
    text: readable,
    ...estimate('metric'),
  },
  ratio: {
    title: 'φ² in cosines against the first',
    means: 'φ² over that of the first point with the same seed: geometric mean, and its 95 % interval',
    log: true,
    better: -1,
    text: readable,
    ...estimate('ratio'),
  },
  found: {
    title: 'Chance to have found an object',
    means: 'How likely an object in the target has been found at the end: median, and its 95 % interval',
    log: false,
    better: 1,
    text: share,
    ...estimate('found'),
  },
  halfFound: {
    title: 'Half found after',
    means:
      'The time after which an object has been found with a probability of ½: median, and its 95 % interval',
    log: false,
    better: -1,
    text: seconds,
    ...estimate('half_found_s'),
  },
  slope: {
    title: 'Slope of φ² in cosines',
    means: 'The power of t that fits φ² over the last tenfold of time; −1 falls like 1/t',
    log: false,
    better: -1,
    text: readable,
    ...plain(point => point.slope),
  },
  within15: {
    title: 'Escaped within 15 s',
    means: 'Share of the agents on a line of symmetry that have left it 15 s after the start',
    log: false,
    better: 1,
    text: share,
    ...plain(escaped('within_15_s')),
  },
  within60: {
    title: 'Escaped within 60 s',
    means: 'Share of the agents on a line of symmetry that have left it 60 s after the start',
    log: false,
    better: 1,
    text: share,
    ...plain(escaped('within_60_s')),
  },
  median: {
    title: 'Median of the escapes',
    means: 'When half of the agents on a line of symmetry have left it',
    log: false,
    better: -1,
    text: seconds,
    ...plain(escaped('median_s')),
  },
  late: {
    title: '99th percentile of the escapes',
    means: 'When 99 % of the agents on a line of symmetry have left it',
    log: false,
    better: -1,
    text: seconds,
    ...plain(escaped('late_s')),
  },
  offset: {
    title: 'Mean ‖x − centre‖²',
    means: 'Squared distance of agents from the point to which the contraction pulls them',
    unit: 'm²',
    log: false,
    better: 0,
    text: readable,
    ...plain(point => point.offset2_mean_m2),
  },
  farthest: {
    title: 'Greatest ‖x − centre‖²',
    means: 'The same where it was greatest',
    unit: 'm²',
    log: false,
    better: 0,
    text: readable,
    ...plain(point => point.offset2_max_m2),
  },
  edge: {
    title: 'Time at the edge',
    means: 'Share of all agents’ ticks closer to an edge than 0.1 % of the shorter side',
    log: false,
    better: 0,
    text: share,
    ...plain(point => point.edge_share),
  },
  speed: {
    title: 'Mean speed',
    means: 'The mean of all agents over all ticks',
    unit: 'm/s',
    log: false,
    better: 0,
    text: readable,
    ...plain(point => point.speed_mean_mps),
  },
  messages: {
    title: 'Contributions per run',
    means: 'Broadcasts of coverage that all agents sent in a mission',
    log: false,
    better: 0,
    text: readable,
    ...plain(point => point.messages),
  },
};
export const isKnown = v => typeof v === 'number' && !Number.isNaN(v);

// Words by the order in which they were given, numbers ascending.
function valuesOf(points, of) {
  const values = [...new Set(points.map(of))];
  return values.every(v => v.trim() !== '' && isFinite(v)) ? values.sort((a, b) => a - b) : values;
}

export class Study {
  // `data` as studies/study_page.cc writes it.
  constructor(data) {
    Object.assign(this, data);
    this.points.forEach((point, index) =>
      Object.assign(point, { index, all: [point.scenario, ...point.values] }),
    );
    for (const { escapes, half_found_s: half = [] } of this.points) {
      for (const key of ['median_s', 'late_s']) if (escapes?.[key] === 'never') escapes[key] = Infinity;
      half.forEach((v, i) => {
        if (v === 'never') half[i] = Infinity;
      });
    }
    // What tells the points apart; the scenario is number 0.
    this.dimensions = ['scenario', ...data.fields].map((name, number) => ({
      name,
      number,
      values: valuesOf(this.points, p => p.all[number]),
    }));
    this.varied = this.dimensions.filter(d => d.values.length > 1);
    this.quantities = Object.entries(QUANTITIES)
      .filter(([, q]) => this.points.some(p => isKnown(q.value(p))))
      .map(([key]) => key);
    this.runs = this.points.reduce((sum, p) => sum + p.runs, 0);
  }
  nameOf(point) {
    const own = this.varied.length ? this.varied : this.dimensions.slice(0, 1);
    return own
      .map(({ name, number }) => (number ? `${name} = ${point.all[number]}` : point.scenario))
      .join(', ');
  }
  // Points that have all chosen values, and every word in their names.
  chosen({ filters, words }) {
    const parts = words.toLowerCase().split(/\s+/).filter(Boolean);
    return this.points.filter(
      point =>
        [...filters].every(([number, value]) => point.all[number] === value) &&
        (!parts.length ||
          parts.every(part => this.nameOf(point).toLowerCase().replaceAll(' = ', '=').includes(part))),
    );
  }
  // Null if more is neither better nor worse, and if all wait for ever.
  best(points, key) {
    const { value, better } = QUANTITIES[key];
    let best = null;
    for (const point of points)
      if (Number.isFinite(value(point)) && (!best || better * value(point) > better * value(best)))
        best = point;
    return better ? best : null;
  }
  // Those whose intervals overlap with that of the best.
  near(points, key, best) {
    const { bounds } = QUANTITIES[key],
      range = best && bounds(best);
    if (!range) return [];
    return points.filter(
      p => p !== best && bounds(p) && bounds(p)[0] <= range[1] && bounds(p)[1] >= range[0],
    );
  }
}

export function sorted(points, { by, down }) {
  const rank = point =>
    by.number !== undefined
      ? by.values.indexOf(point.all[by.number])
      : by.key === 'runs'
        ? point.runs
        : QUANTITIES[by.key].value(point);
  const unknown = v => (isKnown(v) ? 0 : 1);
  return [...points].sort((a, b) => {
    const u = rank(a),
      v = rank(b);
    return unknown(u) - unknown(v) || (down ? v - u : u - v) || a.index - b.index;
  });
}

// The best of the points of each cell of a grid; without a second field there is one row.
export function cellsOf(study, points, key, across, up) {
  const cells = new Map(),
    place = point =>
      [across, up].map(field => (field ? field.values.indexOf(point.all[field.number]) : 0)).join();
  for (const point of points) {
    const at = place(point);
    if (!cells.has(at)) cells.set(at, []);
    cells.get(at).push(point);
  }
  return [...cells].map(([at, list]) => {
    const [i, j] = at.split(',').map(Number);
    return { i, j, list, point: study.best(list, key) ?? list[0] };
  });
}

// "1.31 [1.2, 1.54] ·10⁻³", or the value alone.
export function intervalText(point, key) {
  const { value, bounds, text, log } = QUANTITIES[key],
    v = value(point),
    range = bounds(point);
  if (!isKnown(v)) return '–';
  if (!range || (v === Infinity && range[0] === v)) return text(v);
  if (!log || !(v > 0) || v >= 0.01) return `${text(v)} [${text(range[0])}, ${text(range[1])}]`;
  const exponent = Math.floor(Math.log10(v)),
    part = x => readable(x / 10 ** exponent);
  const power = text(10 ** exponent).replace(/^[\d.]+/, '\u202f');
  return `${part(v)} [${part(range[0])}, ${part(range[1])}]${power}`;
}
