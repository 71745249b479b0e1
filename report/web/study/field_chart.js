// SPDX-License-Identifier: BSD-3-Clause
// Paints a quantity with its intervals against one field; each value of a second field has a colour.
import { FONT, paintColumns, paintRows, rangeOf, scalesFor, segment } from '../axes.js';
import { QUANTITIES, isKnown } from './study.js';

const ROOM = { left: 58, right: 14, top: 10, bottom: 48 };
const WIDE = 20; // positive numbers this far apart are drawn on a logarithmic axis

// The field's axis: its numbers, or the places of its words.
function axisOf({ values }) {
  const numbers = values.map(Number),
    first = numbers[0],
    last = numbers[numbers.length - 1];
  const places = values.map((_, i) => i),
    named = { places, words: values, low: -0.5, high: values.length - 0.5, log: false };
  if (values.length < 2 || !numbers.every(isFinite)) return named;
  if (first > 0 && last >= WIDE * first) return { places: numbers, ...rangeOf(numbers, true) };
  if (values.length < 3 || last >= WIDE * Math.abs(numbers[1])) return { ...named, joined: true };
  const room = 0.05 * (last - first);
  return { places: numbers, low: first - room, high: last + room, log: false };
}

function names(g, s, words, colours) {
  g.font = `11px ${FONT}`;
  g.textAlign = 'center';
  g.textBaseline = 'top';
  g.fillStyle = colours.muted;
  const widest = Math.max(...words.map(word => g.measureText(word).width)),
    every = Math.ceil((widest + 8) / Math.abs(s.x(1) - s.x(0)));
  words.forEach((word, i) => {
    if (i % every === 0) g.fillText(word, s.x(i), s.bottom + 6);
  });
}

function key(g, up, colours, width) {
  let x = ROOM.left,
    y = 12;
  g.font = `11px ${FONT}`;
  g.textAlign = 'left';
  g.textBaseline = 'middle';
  const rows = [
    { text: up.name, colour: null },
    ...up.values.map((text, i) => ({ text, colour: colours.agent(i) })),
  ];
  for (const { text, colour } of rows) {
    const w = g.measureText(text).width + (colour ? 22 : 0);
    if (x > ROOM.left && x + w > width - ROOM.right) {
      x = ROOM.left;
      y += 16;
    }
    g.fillStyle = colour ?? colours.muted;
    if (colour) g.fillRect(x, y - 1.5, 16, 3);
    g.fillStyle = colour ? colours.ink : colours.muted;
    g.fillText(text, x + (colour ? 20 : 0), y);
    x += w + 14;
  }
  return y + 8;
}

export function paintFieldChart(g, cells, { across, up, quantity, best, hot, colours }, width, height) {
  const q = QUANTITIES[quantity],
    axis = axisOf(across),
    all = [],
    known = cells.filter(cell => isKnown(q.value(cell.point)) && isFinite(q.value(cell.point)));
  for (const { point } of known) all.push(q.value(point), ...(q.bounds(point) ?? []));
  const top = up ? key(g, up, colours, width) : 0,
    range = rangeOf(all, q.log),
    margin = (range.high - range.low || 1) * 0.06;
  const s = scalesFor(
    width,
    height,
    axis,
    q.log ? range : { low: range.low - margin, high: range.high + margin, log: false },
    { ...ROOM, top: ROOM.top + top },
  );
  paintRows(g, s, colours);
  if (axis.words) names(g, s, axis.words, colours);
  else paintColumns(g, s, colours);
  const count = up ? up.values.length : 1,
    aside = Math.min(6, 36 / count);
  for (let j = 0; j < count; j++) {
    const row = known.filter(cell => cell.j === j).sort((a, b) => a.i - b.i),
      colour = up ? colours.agent(j) : colours.accent;
    const x = cell => s.x(axis.places[cell.i]) + aside * (j - (count - 1) / 2);
    g.strokeStyle = g.fillStyle = colour;
    if (row.length > 1 && (!axis.words || axis.joined)) {
      g.globalAlpha = 0.7;
      g.lineWidth = 1.4;
      g.beginPath();
      row.forEach((cell, i) =>
        i ? g.lineTo(x(cell), s.y(q.value(cell.point))) : g.moveTo(x(cell), s.y(q.value(cell.point))),
      );
      g.stroke();
      g.globalAlpha = 1;
    }
    for (const cell of row) {
      const bounds = q.bounds(cell.point),
        strong = cell.list.includes(best) || cell.list.some(hot);
      g.lineWidth = 2.4;
      if (bounds) segment(g, x(cell), s.y(bounds[0]), x(cell), s.y(Math.min(bounds[1], s.up.high)));
      g.beginPath();
      g.arc(x(cell), s.y(q.value(cell.point)), strong ? 5.5 : 3.6, 0, 2 * Math.PI);
      g.fill();
      if (strong) {
        g.strokeStyle = colours.ink;
        g.lineWidth = 1.5;
        g.stroke();
        g.strokeStyle = colour;
      }
    }
  }
  g.fillStyle = colours.ink;
  g.font = `600 12px ${FONT}`;
  g.textAlign = 'center';
  g.textBaseline = 'alphabetic';
  g.fillText(across.name, (s.room.left + s.right) / 2, height - 8);
}
