// SPDX-License-Identifier: BSD-3-Clause
// Paints what a box has besides its WebGL picture: numbers on its axes, and lines from agents to the floor.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { axisName, ticksFor } from './box_axes.js';
import { FONT } from '../axes.js';
import { clamp } from '../text.js';

const MANY = 12;

// The edge along an axis that carries its numbers. It is part of the outline: the lowest on the screen, or
// the leftmost of the heights.
function edgeFor(view, axis) {
  const { size, forward } = view,
    [a, b] = [0, 1, 2].filter(other => other !== axis),
    far = [0, 1, 2].map(i => (forward[i] > 0 ? size[i] : 0));
  let best = null;
  for (const u of [0, size[a]])
    for (const v of [0, size[b]]) {
      if ((u === far[a]) === (v === far[b])) continue; // at the back or in front
      const at = [0, 0, 0];
      at[a] = u;
      at[b] = v;
      at[axis] = size[axis] / 2;
      const [x, y] = view.project(at),
        rank = axis === 2 ? -x : y;
      if (!best || rank > best.rank) best = { rank, at, x, y };
    }
  return best;
}

function paintAxis(g, run, view, axis, colours) {
  const { size } = view,
    edge = edgeFor(view, axis),
    labels = [];
  if (!edge) return;
  const on = share => view.project(edge.at.map((v, i) => (i === axis ? share * size[i] : v))),
    [x0, y0] = on(0),
    [x1, y1] = on(1);
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (length < 24) return; // seen end on
  const [mx, my] = view.project(size.map(l => l / 2)),
    side = Math.sign((x1 - x0) * (my - edge.y) - (y1 - y0) * (mx - edge.x)) || 1;
  const out = [(side * (y1 - y0)) / length, (-side * (x1 - x0)) / length];
  g.font = `11px ${FONT}`;
  g.textAlign = 'center';
  g.textBaseline = 'middle';
  g.strokeStyle = g.fillStyle = colours.muted;
  g.lineWidth = 1;
  const room = text => 9 + Math.abs(out[0]) * (g.measureText(text).width / 2) + Math.abs(out[1]) * 5;
  let widest = 0;
  for (const { at, text } of ticksFor(run, axis)) {
    const [x, y] = on(at / size[axis]),
      half = g.measureText(text).width / 2;
    g.beginPath();
    g.moveTo(x, y);
    g.lineTo(x + out[0] * 4, y + out[1] * 4);
    g.stroke();
    const px = x + out[0] * room(text),
      py = y + out[1] * room(text);
    if (labels.some(([ox, oy, oh]) => Math.abs(ox - px) < oh + half + 6 && Math.abs(oy - py) < 13)) continue;
    g.fillText(text, px, py);
    labels.push([px, py, half]);
    widest = Math.max(widest, half);
  }
  const name = axisName(view.size, axis),
    away = 20 + Math.abs(out[0]) * (2 * widest + g.measureText(name).width / 2) + Math.abs(out[1]) * 14;
  g.fillStyle = colours.ink;
  g.font = `600 11px ${FONT}`;
  const half = g.measureText(name).width / 2;
  g.fillText(
    name,
    clamp((x0 + x1) / 2 + out[0] * away, half + 4, view.width - half - 4),
    (y0 + y1) / 2 + out[1] * away,
  );
}

// A line from each agent down to the floor, so that its place can be read.
function paintFeet(g, run, view, { row, colours, focus }) {
  if (Math.abs(view.elevation) > 1.45) return; // from above it has no length
  g.lineWidth = 1;
  for (const track of run.tracks) {
    if (focus ? !focus(track.id) : run.tracks.length > MANY) continue;
    const at = track.rowAt(row);
    if (at < 0) continue;
    const place = view.placeAt(track, at),
      [x, y] = view.project(place),
      [fx, fy] = view.project([place[0], place[1], 0]);
    g.strokeStyle = g.fillStyle = colours.agent(track.id);
    g.globalAlpha = 0.55;
    g.setLineDash([2, 3]);
    g.beginPath();
    g.moveTo(x, y);
    g.lineTo(fx, fy);
    g.stroke();
    g.setLineDash([]);
    g.beginPath();
    g.arc(fx, fy, 2.2, 0, 2 * Math.PI);
    g.fill();
  }
  g.globalAlpha = 1;
}

export function paintSpaceMarks(g, run, view, state) {
  for (const axis of [0, 1, 2]) paintAxis(g, run, view, axis, state.colours);
  paintFeet(g, run, view, state);
}

// The nearest agent is drawn last.
export function farthestFirst(run, view, row) {
  const depth = new Map(
    run.tracks.map(track => {
      const at = track.rowAt(row);
      return [track, at < 0 ? 0 : view.at(track, at)[2]];
    }),
  );
  return [...run.tracks].sort((a, b) => depth.get(b) - depth.get(a));
}
