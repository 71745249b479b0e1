// SPDX-License-Identifier: BSD-3-Clause
// A quantity over time. Draws on a canvas, or on anything with the same methods (svg.js).
import { readable, superscript } from './text.js';
import { indexAt } from './run.js';

// Messages per second of mission time, between rows ten apart: single rows would be a comb.
function ratePerSecond({ t, received }) {
  return t.map((at, i) => {
    const j = Math.max(0, i - 10);
    return i === j ? NaN : Math.max(0, received[i] - received[j]) / (at - t[j]);
  });
}

export const QUANTITIES = {
  phi: { title: 'Ergodic metric φ²', log: true, of: m => m.phi, text: readable },
  spread: { title: 'Spread of own φ²', log: true, of: m => m.spread, text: readable },
  age: { title: 'Oldest knowledge', log: false, of: m => m.age, text: v => `${readable(v)} s` },
  rate: { title: 'Messages each s', log: false, of: ratePerSecond, text: v => `${readable(v)} /s` },
};

const ROOM = { left: 50, right: 12, top: 8, bottom: 30 };

// The scales of a chart of that size.
export function scalesOf(run, { quantity, axis }, width, height) {
  const { t } = run.metrics, { of, log: logY } = QUANTITIES[quantity], values = of(run.metrics), logT = axis === 'log';
  const end = Math.max(t[t.length - 1] ?? 1, run.step * 2), begin = logT ? Math.min(t.find(at => at > 0) ?? 1, end / 2) : 0;
  let low = Infinity, high = -Infinity;
  values.forEach((v, i) => { if (isFinite(v) && (!logY || v > 0) && t[i] >= begin * 0.999) { low = Math.min(low, v); high = Math.max(high, v); } });
  if (!(low <= high)) [low, high] = logY ? [0.1, 1] : [0, 1];
  if (logY) { low = Math.log10(low) - 0.08; high = Math.log10(high) + 0.08; if (high - low < 0.3) { low -= 0.15; high += 0.15; } }
  else { low = 0; high = high > 0 ? high * 1.08 : 1; }
  const w = width - ROOM.left - ROOM.right, h = height - ROOM.top - ROOM.bottom;
  return { width, height, begin, end, low, high, logT, logY, values,
    x: at => ROOM.left + w * (logT ? Math.log(Math.max(at, begin) / begin) / Math.log(end / begin) : at / end),
    y: v => ROOM.top + h * (1 - ((logY ? Math.log10(v) : v) - low) / (high - low)),
    t: px => { const u = Math.min(1, Math.max(0, (px - ROOM.left) / w)); return logT ? begin * (end / begin) ** u : u * end; } };
}

// {at, text, rank} of an axis; rank 2 is labelled first, 0 never. At least two have labels.
export function ticksOf(low, high, log) {
  if (!log) {
    const raw = (high - low) / 6, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].find(m => m * power >= raw * 0.999) * power, ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-9); i++) ticks.push({ at: i * step, text: String(+(i * step).toPrecision(6)), rank: 2 });
    return ticks;
  }
  const ticks = [], decades = Math.log10(high / low);
  for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++) for (let m = 1; m < 10; m++) {
    const at = m * 10 ** e;
    if (at < low * 0.999 || at > high * 1.001) continue;
    const plain = e >= 0 && e < 5 ? String(at) : m === 1 ? `10${superscript(e)}` : `${m}·10${superscript(e)}`;
    ticks.push({ at, text: plain, rank: m === 1 ? 2 : m === 2 || m === 5 ? (decades < 3.5 ? 1 : 0) : decades < 0.7 ? 0.5 : 0 });
  }
  if (ticks.filter(tick => tick.rank > 0).length > 1) return ticks;
  return ticksOf(low, high, false).map(tick => ({ ...tick, text: readable(tick.at) }));
}

function segment(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

function paintGrid(g, s, colours) {
  const right = s.width - ROOM.right, bottom = s.height - ROOM.bottom;
  g.font = '11px system-ui, sans-serif';
  g.lineWidth = 1;
  g.textAlign = 'right';
  g.textBaseline = 'middle';
  const rows = [];
  for (const { at, text, rank } of ticksOf(s.logY ? 10 ** s.low : s.low, s.logY ? 10 ** s.high : s.high, s.logY).sort((a, b) => b.rank - a.rank)) {
    const y = s.y(at);
    if (y < ROOM.top - 0.5 || y > bottom + 0.5) continue;
    g.strokeStyle = colours.line;
    g.globalAlpha = rank === 2 ? 1 : 0.45;
    segment(g, ROOM.left, y, right, y);
    g.globalAlpha = 1;
    g.fillStyle = colours.muted;
    if (rank && rows.every(other => Math.abs(other - y) > 13)) { g.fillText(text, ROOM.left - 6, y); rows.push(y); }
  }
  g.textAlign = 'center';
  g.textBaseline = 'top';
  const columns = [];
  for (const { at, text, rank } of ticksOf(s.begin, s.end, s.logT).sort((a, b) => b.rank - a.rank)) {
    const x = s.x(at), label = rank === 2 ? `${text} s` : text, half = g.measureText(label).width / 2, middle = Math.min(x, s.width - 1 - half);
    g.strokeStyle = colours.line;
    g.globalAlpha = rank === 2 ? 1 : 0.45;
    segment(g, x, ROOM.top, x, bottom);
    g.globalAlpha = 1;
    g.fillStyle = colours.muted;
    if (rank && columns.every(([other, h]) => Math.abs(other - middle) > h + half + 6)) { g.fillText(label, middle, bottom + 5); columns.push([middle, half]); }
  }
}

// 1/t, to hold φ² against.
function paintGuide(g, s, run, colours) {
  const { t } = run.metrics, from = s.end / 5;
  let level = 0;
  s.values.forEach((v, i) => { if (t[i] >= from && v * t[i] > level) level = v * t[i]; });
  if (!level || !(s.end > 4 * s.begin)) return;
  level *= 1.35 / from;
  let pen = false;
  g.strokeStyle = g.fillStyle = colours.muted;
  g.globalAlpha = 0.7;
  g.lineWidth = 1;
  g.setLineDash([4, 4]);
  g.beginPath();
  for (let i = 0; i <= 40; i++) {
    const at = from * 5 ** (i / 40), y = s.y((level * from) / at);
    if (y < ROOM.top) continue;
    if (pen) g.lineTo(s.x(at), y); else g.moveTo(s.x(at), y);
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
  let pen = false, last = -9;
  g.beginPath();
  for (let i = from; i <= to; i++) {
    const v = s.values[i], x = s.x(t[i]);
    if (!isFinite(v) || (s.logY && !(v > 0)) || t[i] < s.begin * 0.999) { pen = false; continue; }
    if (pen && x - last < 0.4 && i < to) continue;
    if (pen) g.lineTo(x, s.y(v)); else g.moveTo(x, s.y(v));
    pen = true;
    last = x;
  }
  g.stroke();
}

// `t` is the time of the page, `pointer` that under the pointer or −1.
export function paintChart(g, run, { t: now, quantity, axis, colours, guide, pointer }, width, height) {
  const s = scalesOf(run, { quantity, axis }, width, height), { t } = run.metrics, bottom = height - ROOM.bottom;
  paintGrid(g, s, colours);
  if (quantity === 'phi' && guide) paintGuide(g, s, run, colours);
  const goal = run.mission.goal;
  if (quantity === 'phi' && goal > 10 ** s.low && goal < 10 ** s.high) {
    g.strokeStyle = colours.ok;
    g.setLineDash([2, 3]);
    segment(g, ROOM.left, s.y(goal), width - ROOM.right, s.y(goal));
    g.setLineDash([]);
    g.fillStyle = colours.ok;
    g.textAlign = 'right';
    g.textBaseline = 'bottom';
    g.fillText('goal', width - ROOM.right - 2, s.y(goal) - 2);
  }
  const i = indexAt(t, now);
  g.lineWidth = 2;
  g.lineJoin = 'round';
  g.strokeStyle = colours.accent;
  g.globalAlpha = 0.28;
  curve(g, s, t, Math.max(0, i), t.length - 1);
  g.globalAlpha = 1;
  curve(g, s, t, 0, i);
  for (const incident of run.incidents) {
    g.fillStyle = colours[{ silent: 'bad', gone: 'gone', late: 'warn' }[incident.kind] ?? 'ok'];
    g.fillRect(s.x(incident.t) - 1, bottom - 6, 2, 6);
  }
  const cursor = (at, colour, dashed) => {
    const k = indexAt(t, at), v = s.values[k], x = s.x(at);
    g.strokeStyle = g.fillStyle = colour;
    g.lineWidth = 1;
    g.setLineDash(dashed ? [3, 3] : []);
    segment(g, x, ROOM.top, x, bottom);
    g.setLineDash([]);
    if (!isFinite(v) || (s.logY && !(v > 0))) return;
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
