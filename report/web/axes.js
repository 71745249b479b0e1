// SPDX-License-Identifier: BSD-3-Clause
// Computes the scales and ticks of a plot, and paints its grid.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { readable, superscript } from './text.js';

export const ROOM = { left: 50, right: 12, top: 8, bottom: 30 };
export const FONT = 'system-ui, sans-serif';

// A range around these values, {low, high, log}; `log` leaves out what is not positive.
export function rangeOf(values, log) {
  let low = Infinity,
    high = -Infinity;
  for (const v of values)
    if (isFinite(v) && (!log || v > 0)) {
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
  if (!(low <= high)) [low, high] = log ? [0.1, 1] : [0, 1];
  if (!log) return { low, high, log };
  const margin = Math.log10(high / low) < 0.14 ? 0.23 : 0.08;
  return { low: low / 10 ** margin, high: high * 10 ** margin, log };
}

// Scales of a plot of two ranges on a canvas of that size.
export function scalesFor(width, height, across, up, room = ROOM) {
  const w = width - room.left - room.right,
    h = height - room.top - room.bottom;
  const share = ({ low, high, log }, v) =>
    log ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low);
  return {
    width,
    height,
    across,
    up,
    room,
    right: width - room.right,
    bottom: height - room.bottom,
    x: v => room.left + w * share(across, v),
    y: v => room.top + h * (1 - share(up, v)),
    // What is under a pixel, within the axis.
    at: px => {
      const u = Math.min(1, Math.max(0, (px - room.left) / w));
      return across.log
        ? across.low * (across.high / across.low) ** u
        : across.low + u * (across.high - across.low);
    },
  };
}

// {at, text, rank} of an axis; rank 2 is labelled first, 0 never. At least two have labels.
export function ticksOf({ low, high, log }) {
  if (!log) {
    const raw = (high - low) / 6,
      power = 10 ** Math.floor(Math.log10(raw)),
      step = [1, 2, 5, 10].find(m => m * power >= raw * 0.999) * power,
      ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high * (1 + 1e-9); i++)
      ticks.push({ at: i * step, text: String(+(i * step).toPrecision(6)), rank: 2 });
    return ticks;
  }
  const ticks = [],
    decades = Math.log10(high / low);
  for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++)
    for (let m = 1; m < 10; m++) {
      const at = m * 10 ** e;
      if (at < low * 0.999 || at > high * 1.001) continue;
      const plain =
        e >= -2 && e < 5
          ? String(+at.toPrecision(3))
          : m === 1
            ? `10${superscript(e)}`
            : `${m}·10${superscript(e)}`;
      ticks.push({
        at,
        text: plain,
        rank: m === 1 ? 2 : m === 2 || m === 5 ? (decades < 3.5 ? 1 : 0) : decades < 0.7 ? 0.5 : 0,
      });
    }
  if (ticks.filter(tick => tick.rank > 0).length > 1) return ticks;
  return ticksOf({ low, high, log: false }).map(tick => ({ ...tick, text: readable(tick.at) }));
}

export function segment(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

const byRank = range => ticksOf(range).sort((a, b) => b.rank - a.rank);

function gridLine(g, colours, rank, ...line) {
  g.strokeStyle = colours.line;
  g.globalAlpha = rank === 2 ? 1 : 0.45;
  segment(g, ...line);
  g.globalAlpha = 1;
  g.fillStyle = colours.muted;
}

export function paintRows(g, s, colours) {
  const labels = [];
  g.font = `11px ${FONT}`;
  g.lineWidth = 1;
  g.textAlign = 'right';
  g.textBaseline = 'middle';
  for (const { at, text, rank } of byRank(s.up)) {
    const y = s.y(at);
    if (y < s.room.top - 0.5 || y > s.bottom + 0.5) continue;
    gridLine(g, colours, rank, s.room.left, y, s.right, y);
    if (rank && labels.every(other => Math.abs(other - y) > 13)) {
      g.fillText(text, s.room.left - 6, y);
      labels.push(y);
    }
  }
}

// `unit` follows the labels of highest rank.
export function paintColumns(g, s, colours, unit = '') {
  const labels = [];
  g.font = `11px ${FONT}`;
  g.lineWidth = 1;
  g.textAlign = 'center';
  g.textBaseline = 'top';
  for (const { at, text, rank } of byRank(s.across)) {
    const x = s.x(at),
      label = rank === 2 ? text + unit : text,
      half = g.measureText(label).width / 2,
      middle = Math.min(x, s.width - 1 - half);
    gridLine(g, colours, rank, x, s.room.top, x, s.bottom);
    if (rank && labels.every(([other, h]) => Math.abs(other - middle) > h + half + 6)) {
      g.fillText(label, middle, s.bottom + 5);
      labels.push([middle, half]);
    }
  }
}
