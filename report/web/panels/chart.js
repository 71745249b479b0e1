// SPDX-License-Identifier: BSD-3-Clause
// Paints the chart of a run: one quantity over time.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { paintColumns, paintRows, rangeOf, scalesFor, segment } from '../axes.js';
import { chance, readable } from '../text.js';
import { indexAt } from '../data/run.js';

// Messages per second of mission time, between rows ten apart: single rows would be a comb.
function ratePerSecond({ t, received }) {
  return t.map((at, i) => {
    const j = Math.max(0, i - 10);
    return i === j ? NaN : Math.max(0, received[i] - received[j]) / (at - t[j]);
  });
}

export const QUANTITIES = {
  phi: { title: 'Ergodic metric φ²', log: true, of: m => m.phi, text: readable },
  found: {
    title: 'Chance to have found an object [%]',
    log: false,
    most: 100,
    of: m => m.found.map(p => 100 * p),
    text: v => chance(v / 100),
  },
  spread: { title: 'Disagreement on φ²', log: true, of: m => m.spread, text: readable },
  age: { title: 'Oldest update', log: false, of: m => m.age, text: v => `${readable(v)} s` },
  rate: { title: 'Messages per second', log: false, of: ratePerSecond, text: v => `${readable(v)} /s` },
};

const OF_TARGET = ['phi', 'found']; // they compare with the target that holds

// The scales of a chart of that size.
export function scalesOf(run, { quantity, axis }, width, height) {
  const { t } = run.metrics,
    { of, log, most } = QUANTITIES[quantity],
    values = of(run.metrics),
    logT = axis === 'log';
  const end = Math.max(t[t.length - 1] ?? 1, run.step * 2),
    begin = logT ? Math.min(t.find(at => at > 0) ?? 1, end / 2) : 0;
  const up = rangeOf(
    values.filter((_, i) => t[i] >= begin * 0.999),
    log,
  );
  if (!log) Object.assign(up, { low: 0, high: most ?? (up.high > 0 ? up.high * 1.08 : 1) });
  const s = scalesFor(width, height, { low: begin, high: end, log: logT }, up),
    { x } = s;
  return Object.assign(s, { values, begin, end, x: at => x(Math.max(at, begin)) });
}

// 1/t, to hold φ² against.
function paintGuide(g, s, run, colours) {
  const { t } = run.metrics,
    from = s.end / 5;
  let level = 0;
  s.values.forEach((v, i) => {
    if (t[i] >= from && v * t[i] > level) level = v * t[i];
  });
  if (!level || !(s.end > 4 * s.begin)) return;
  level *= 1.35 / from;
  let pen = false;
  g.strokeStyle = g.fillStyle = colours.muted;
  g.globalAlpha = 0.7;
  g.lineWidth = 1;
  g.setLineDash([4, 4]);
  g.beginPath();
  for (let i = 0; i <= 40; i++) {
    const at = from * 5 ** (i / 40),
      y = s.y((level * from) / at);
    if (y < s.room.top) continue;
    if (pen) g.lineTo(s.x(at), y);
    else g.moveTo(s.x(at), y);
    pen = true;
  }
  g.stroke();
  g.setLineDash([]);
  g.globalAlpha = 1;
  g.textAlign = 'left';
  g.textBaseline = 'bottom';
  g.fillText('∝ 1/t', s.x(from * 1.9) + 4, s.y(level / 1.9) - 2);
}

function curve(g, s, t, from, to) {
  let pen = false,
    last = -9;
  g.beginPath();
  for (let i = from; i <= to; i++) {
    const v = s.values[i],
      x = s.x(t[i]);
    if (!isFinite(v) || (s.up.log && !(v > 0)) || t[i] < s.begin * 0.999) {
      pen = false;
      continue;
    }
    if (pen && x - last < 0.4 && i < to) continue;
    if (pen) g.lineTo(x, s.y(v));
    else g.moveTo(x, s.y(v));
    pen = true;
    last = x;
  }
  g.stroke();
}

// Vertical lines where another target begins.
function paintTargets(g, s, run, colours) {
  g.strokeStyle = colours.accent;
  g.lineWidth = 1;
  g.globalAlpha = 0.8;
  g.setLineDash([6, 3]);
  for (const { kind, t } of run.marks)
    if (kind === 'target' && t >= s.begin && t <= s.end) segment(g, s.x(t), s.room.top, s.x(t), s.bottom);
  g.setLineDash([]);
  g.globalAlpha = 1;
}

// `t` is the time of the page, `pointer` that under the pointer or −1.
export function paintChart(g, run, { t: now, quantity, axis, colours, guide, pointer }, width, height) {
  const s = scalesOf(run, { quantity, axis }, width, height),
    { t } = run.metrics,
    { bottom, right, room } = s;
  paintRows(g, s, colours);
  paintColumns(g, s, colours, ' s');
  if (quantity === 'phi' && guide) paintGuide(g, s, run, colours);
  if (OF_TARGET.includes(quantity)) paintTargets(g, s, run, colours);
  const goal = run.mission.goal;
  if (quantity === 'phi' && goal > s.up.low && goal < s.up.high) {
    g.strokeStyle = colours.ok;
    g.setLineDash([2, 3]);
    segment(g, room.left, s.y(goal), right, s.y(goal));
    g.setLineDash([]);
    g.fillStyle = colours.ok;
    g.textAlign = 'right';
    g.textBaseline = 'bottom';
    g.fillText('goal', right - 2, s.y(goal) - 2);
  }
  const i = indexAt(t, now);
  g.lineWidth = 2;
  g.lineJoin = 'round';
  g.strokeStyle = colours.accent;
  g.globalAlpha = 0.28;
  curve(g, s, t, Math.max(0, i), t.length - 1);
  g.globalAlpha = 1;
  curve(g, s, t, 0, i);
  for (const incident of run.marks) {
    g.fillStyle =
      colours[
        { silent: 'bad', gone: 'gone', late: 'warn', paused: 'muted', target: 'accent' }[incident.kind] ??
          'ok'
      ];
    g.fillRect(s.x(incident.t) - 1, bottom - 6, 2, 6);
  }
  const cursor = (at, colour, dashed) => {
    const k = indexAt(t, at),
      v = s.values[k],
      x = s.x(at);
    g.strokeStyle = g.fillStyle = colour;
    g.lineWidth = 1;
    g.setLineDash(dashed ? [3, 3] : []);
    segment(g, x, room.top, x, bottom);
    g.setLineDash([]);
    if (!isFinite(v) || (s.up.log && !(v > 0))) return;
    g.beginPath();
    g.arc(x, s.y(v), 4.5, 0, 2 * Math.PI);
    g.fillStyle = dashed ? colour : colours.accent;
    g.strokeStyle = colours.panel;
    g.fill();
    g.stroke();
  };
  if (t.length) cursor(Math.min(now, s.end), colours.ink, false);
  if (t.length && pointer >= 0) cursor(pointer, colours.muted, true);
}

// What the pointer is at, in words.
export function readingAt(run, quantity, t) {
  const v = QUANTITIES[quantity].of(run.metrics)[indexAt(run.metrics.t, t)];
  return `t ${t.toFixed(1)} s · ${isFinite(v) ? QUANTITIES[quantity].text(v) : '–'}`;
}
