// SPDX-License-Identifier: BSD-3-Clause
// Paints closed zones: their ground on the map, prisms in space, and how long each of them lasts.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { FONT } from '../axes.js';
import { clamp } from '../text.js';
import { stateOfZone } from '../data/zones.js';

const DASHES = [6, 4]; // until all have left

function heightsOf(run, { heights_m: heights = [0, Infinity] }) {
  const top = (run.mission.box_m ?? run.mission.size_m)[2];
  return heights.map(z => clamp(z, 0, top));
}

// The outline of a zone, as a run in a plane is seen.
function ringOf(run, zone) {
  const [a, b] = run.axes,
    { corners_m: corners } = zone;
  if (b === 1) return corners;
  const along = corners.map(corner => corner[a]),
    [low, high] = heightsOf(run, zone).map(z => z * run.stretch[1]),
    [first, last] = [Math.min(...along), Math.max(...along)];
  return [
    [first, low],
    [last, low],
    [last, high],
    [first, high],
  ];
}

function trace(g, places) {
  places.forEach(([x, y], i) => (i ? g.lineTo(x, y) : g.moveTo(x, y)));
  g.closePath();
}

function begin(g, colours, leaving) {
  g.save();
  g.fillStyle = g.strokeStyle = colours.bad;
  g.lineWidth = 1.8;
  if (leaving) g.setLineDash?.(DASHES);
}

const leaves = (run, { from }, row) => row * run.stride < from;

// On the ground of the map: bodies leave a zone, with a dashed outline, until it is free.
export function paintZones(g, run, view, row, colours) {
  const [lx, ly] = run.size;
  for (const zone of run.zonesAt(row)) {
    begin(g, colours, leaves(run, zone, row));
    g.beginPath();
    g.rect(view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
    g.clip();
    g.beginPath();
    trace(
      g,
      ringOf(run, zone).map(([x, y]) => [view.px(x), view.py(y)]),
    );
    g.globalAlpha = 0.22;
    g.fill();
    g.globalAlpha = 1;
    g.stroke();
    g.restore();
  }
}

function paintPrism(g, run, view, zone) {
  const corners = zone.corners_m,
    [floor, top] = heightsOf(run, zone).map(z => corners.map(([x, y]) => view.project([x, y, z])));
  g.globalAlpha = 0.12;
  for (const ring of [floor, top]) {
    g.beginPath();
    trace(g, ring);
    g.fill();
  }
  g.globalAlpha = 1;
  for (const ring of [floor, top]) {
    g.beginPath();
    trace(g, ring);
    g.stroke();
  }
  g.globalAlpha = 0.5;
  g.beginPath();
  corners.forEach((_, i) => {
    g.moveTo(...floor[i].slice(0, 2));
    g.lineTo(...top[i].slice(0, 2));
  });
  g.stroke();
  return top;
}

function middleOf(places) {
  const span = axis => places.map(place => place[axis]),
    middle = list => (Math.min(...list) + Math.max(...list)) / 2;
  return [middle(span(0)), middle(span(1))];
}

function paintWords(g, text, [x, y], view, colours) {
  g.save();
  g.font = `600 11px ${FONT}`;
  g.textAlign = 'center';
  g.textBaseline = 'middle';
  const half = g.measureText(text).width / 2 + 5,
    cx = clamp(x, half + 2, view.width - half - 2),
    cy = clamp(y, 12, view.height - 12);
  g.globalAlpha = 0.88;
  g.fillStyle = colours.panel;
  g.fillRect(cx - half, cy - 9, 2 * half, 18);
  g.globalAlpha = 1;
  g.fillStyle = colours.bad;
  g.fillText(text, cx, cy + 0.5);
  g.restore();
}

// The words of each zone, and in space the zone itself.
export function paintZoneMarks(g, run, view, { row, colours, inSpace }) {
  for (const zone of run.zonesAt(row)) {
    let places;
    if (inSpace) {
      begin(g, colours, leaves(run, zone, row));
      places = paintPrism(g, run, view, zone);
      g.restore();
    } else {
      const [lx, ly] = run.size;
      places = ringOf(run, zone).map(([x, y]) => [view.px(clamp(x, 0, lx)), view.py(clamp(y, 0, ly))]);
    }
    paintWords(g, stateOfZone(run.whole ?? run, zone, row).text, middleOf(places), view, colours);
  }
}
