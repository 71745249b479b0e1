// SPDX-License-Identifier: BSD-3-Clause
// Paints a quantity over two fields, one cell for each pair of values.
import { inkOn, mix } from '../colours.js';
import { FONT } from '../axes.js';
import { QUANTITIES, isKnown } from './study.js';

const ROOM = { right: 12, top: 10, bottom: 44 };

function layout(across, up, width, height, g) {
  g.font = `11px ${FONT}`;
  const widest = Math.max(...up.values.map(v => g.measureText(v).width), 20),
    left = Math.min(widest + 34, width * 0.4);
  return {
    left,
    w: (width - left - ROOM.right) / across.values.length,
    h: (height - ROOM.top - ROOM.bottom) / up.values.length,
  };
}

// The cell under a pixel.
export function cellAt(g, cells, { across, up }, width, height, x, y) {
  const { left, w, h } = layout(across, up, width, height, g);
  const i = Math.floor((x - left) / w),
    j = up.values.length - 1 - Math.floor((y - ROOM.top) / h);
  return cells.find(cell => cell.i === i && cell.j === j);
}

// The middle of a cell, in pixels.
export function middleOf(g, { i, j }, { across, up }, width, height) {
  const { left, w, h } = layout(across, up, width, height, g);
  return [left + (i + 0.5) * w, height - ROOM.bottom - (j + 0.5) * h];
}

// As many labels as have room.
function labels(g, across, up, { left, w, h }, width, height, colours) {
  g.fillStyle = colours.muted;
  g.font = `11px ${FONT}`;
  g.textAlign = 'center';
  g.textBaseline = 'top';
  const bottom = height - ROOM.bottom,
    widest = Math.max(...across.values.map(v => g.measureText(v).width)),
    every = Math.ceil((widest + 8) / w);
  across.values.forEach((value, i) => {
    if (i % every === 0) g.fillText(value, left + (i + 0.5) * w, bottom + 6);
  });
  g.textBaseline = 'middle';
  g.textAlign = 'right';
  const each = Math.ceil(13 / h);
  up.values.forEach((value, j) => {
    if (j % each === 0) g.fillText(value, left - 8, bottom - (j + 0.5) * h, left - 24);
  });
  g.fillStyle = colours.ink;
  g.font = `600 12px ${FONT}`;
  g.textAlign = 'center';
  g.textBaseline = 'alphabetic';
  g.fillText(across.name, (left + width - ROOM.right) / 2, height - 8);
  g.save();
  g.translate(12, (ROOM.top + bottom) / 2);
  g.rotate(-Math.PI / 2);
  g.fillText(up.name, 0, 0);
  g.restore();
}

export function paintHeatMap(g, cells, { across, up, quantity, best, near, hot, colours }, width, height) {
  const q = QUANTITIES[quantity],
    place = layout(across, up, width, height, g),
    { left, w, h } = place,
    bottom = height - ROOM.bottom;
  const scale = q.log ? Math.log : v => v,
    values = cells
      .map(c => q.value(c.point))
      .filter(v => isKnown(v) && isFinite(v) && (!q.log || v > 0))
      .map(scale);
  const low = Math.min(...values),
    high = Math.max(...values);
  labels(g, across, up, place, width, height, colours);
  g.lineJoin = 'miter';
  for (const { i, j, list, point } of cells) {
    const v = q.value(point),
      x = left + i * w,
      y = bottom - (j + 1) * h,
      known = isKnown(v),
      u = high > low && isFinite(scale(v)) ? (scale(v) - low) / (high - low) : 0.5;
    // The better, the stronger.
    const fill = known ? mix(colours.heat, q.better < 0 ? 1 - u : u) : colours.soft,
      ink = known ? inkOn(fill) : colours.muted;
    g.fillStyle = fill;
    g.fillRect(x + 0.75, y + 0.75, w - 1.5, h - 1.5);
    g.fillStyle = ink;
    g.font = `${point === best ? '700' : '400'} 12px ${FONT}`;
    g.textAlign = 'center';
    g.textBaseline = 'middle';
    const text = known ? q.text(v) : '–',
      bounds = q.bounds(point);
    if (h > 16 && g.measureText(text).width < w - 6)
      g.fillText(text, x + w / 2, y + h / 2 - (bounds && h > 40 ? 8 : 0));
    if (bounds && h > 40) {
      g.font = `10.5px ${FONT}`;
      const range = `${q.text(bounds[0])} – ${q.text(bounds[1])}`;
      if (g.measureText(range).width < w - 6) g.fillText(range, x + w / 2, y + h / 2 + 9);
    }
    if (near.includes(point) && w > 14 && h > 14) {
      // not distinguished from the best
      g.beginPath();
      g.arc(x + 8, y + 8, 3, 0, 2 * Math.PI);
      g.fill();
    }
    if (list.includes(best) || list.some(hot)) {
      g.strokeStyle = list.includes(best) ? colours.ink : colours.muted;
      g.lineWidth = 2.5;
      g.strokeRect(x + 2, y + 2, w - 4, h - 4);
    }
  }
}
