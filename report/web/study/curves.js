// SPDX-License-Identifier: BSD-3-Clause
// Paints what the chosen points of a study do over time: φ² with its bands, or the share that escaped.
import { FONT, paintColumns, paintRows, rangeOf, scalesFor } from '../axes.js';
import { HUES } from '../colours.js';
import { readable, share } from '../text.js';

const phi = {
  of: point => (point.over_time ?? []).map(([t, v, low, high]) => ({ t, v, low, high })),
  log: true,
};
const escapes = {
  of: point => (point.escapes?.shares ?? []).map(([t, v]) => ({ t, v })),
  log: false,
};
const kindOf = curve => (curve === 'escapes' ? escapes : phi);

export function curveScales(points, curve, width, height) {
  const { of, log } = kindOf(curve),
    all = points.flatMap(of).filter(p => p.t > 0),
    times = all.map(p => p.t);
  const up = log
    ? rangeOf(
        all.flatMap(p => [p.v, p.low, p.high]),
        true,
      )
    : { low: 0, high: 1.03, log: false };
  const low = Math.min(...times, 1),
    high = Math.max(...times, low * 10);
  return scalesFor(width, height, { low, high, log: true }, up);
}

function band(g, s, list) {
  g.beginPath();
  list.forEach((p, i) => (i ? g.lineTo(s.x(p.t), s.y(p.low)) : g.moveTo(s.x(p.t), s.y(p.low))));
  for (let i = list.length - 1; i >= 0; i--) g.lineTo(s.x(list[i].t), s.y(list[i].high));
  g.closePath();
  g.fill();
}

function steps(g, s, list) {
  list.forEach((p, i) => {
    if (i) {
      g.lineTo(s.x(p.t), s.y(list[i - 1].v));
      g.lineTo(s.x(p.t), s.y(p.v));
    } else g.moveTo(s.x(p.t), s.y(p.v));
  });
}

// `colourOf` a point; `pointer`: the time under it, or −1.
export function paintCurves(g, points, { curve, colours, colourOf, hover, pointer }, width, height) {
  const s = curveScales(points, curve, width, height),
    { of, log } = kindOf(curve);
  paintRows(g, s, colours);
  paintColumns(g, s, colours, ' s');
  const strength = point => (hover < 0 || hover === point.index ? 1 : 0.25);
  for (const point of points) {
    const list = of(point).filter(p => p.t > 0);
    if (!log || list.length < 2) continue;
    g.fillStyle = colourOf(point);
    g.globalAlpha = (points.length > 4 ? 0.12 : 0.2) * strength(point);
    band(g, s, list);
  }
  for (const point of points) {
    const list = of(point).filter(p => p.t > 0);
    g.strokeStyle = g.fillStyle = colourOf(point);
    g.globalAlpha = strength(point);
    g.lineWidth = hover === point.index ? 2.8 : 1.8;
    g.lineJoin = 'round';
    g.setLineDash(points.indexOf(point) < HUES.light.length ? [] : [6, 3]);
    g.beginPath();
    if (log) list.forEach((p, i) => (i ? g.lineTo(s.x(p.t), s.y(p.v)) : g.moveTo(s.x(p.t), s.y(p.v))));
    else steps(g, s, list);
    g.stroke();
  }
  g.globalAlpha = 1;
  g.setLineDash([]);
  if (pointer <= 0) return;
  g.strokeStyle = colours.muted;
  g.lineWidth = 1;
  g.setLineDash([3, 3]);
  g.beginPath();
  g.moveTo(s.x(pointer), s.room.top);
  g.lineTo(s.x(pointer), s.bottom);
  g.stroke();
  g.setLineDash([]);
  g.font = `11px ${FONT}`;
}

// What a point has at a time.
export function curveReading(point, curve, t) {
  const list = kindOf(curve).of(point),
    at = list.findLast(p => p.t <= t * (1 + 1e-9));
  if (!at) return '–';
  return curve === 'escapes' ? share(at.v) : `${readable(at.v)} at ${readable(at.t)} s`;
}
