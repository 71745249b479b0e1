// SPDX-License-Identifier: BSD-3-Clause
// Paints the map over its ground: trails and markers.
// Each draws on a canvas, or on anything with the same methods (svg.js).
import { clamp } from '../text.js';
import { many, oval, paintAgents } from './markers.js';
import { axisName } from './box_axes.js';
import { paintFinds } from './finds_layer.js';
import { farthestFirst, paintSpaceMarks } from './space_marks.js';
import { paintZoneMarks } from './zones_layer.js';

export const TAILS = [0, 10, 30, 60, 120, 300, 600, Infinity]; // s

// Rows that a piece of a line spans: 1.6 pixels, of the history of many agents 4.
export function rowsPerPiece(run, view, plain) {
  if (!run.pace) {
    // metres per row, of the first agent
    const [track] = run.tracks,
      rows = track ? track.last - track.first : 0;
    const pace = rows > 0 ? track.distance(track.last) / rows : 0;
    if (rows > 200) run.pace = pace; // settled
    if (!pace) return 1;
    return clamp(Math.floor((plain && many(run) ? 4 : 1.6) / (view.scale * pace)), 1, 16);
  }
  return clamp(Math.floor((plain && many(run) ? 4 : 1.6) / (view.scale * run.pace)), 1, 16);
}

// Pieces begin at multiples of `stride`, so that a moving tail does not shimmer.
function line(g, view, { p }, from, to, stride) {
  let pen = false;
  g.beginPath();
  const visit = k => {
    const x = p[2 * k];
    if (x !== x) {
      pen = false;
      return;
    }
    if (pen) g.lineTo(view.px(x), view.py(p[2 * k + 1]));
    else g.moveTo(view.px(x), view.py(p[2 * k + 1]));
    pen = true;
  };
  visit(from);
  for (let k = from - (from % stride) + stride; k < to; k += stride) visit(k);
  visit(to);
  g.stroke();
}

// The tracks' rows from … to. `bands`: steps in which they fade; 1: all alike.
export function paintTracks(g, run, view, { from, to, bands, strength, colours, focus }) {
  const crowd = many(run),
    stride = rowsPerPiece(run, view, bands === 1);
  g.lineJoin = 'round';
  g.lineCap = 'butt';
  const paint = (track, hot) => {
    const faint = focus && !hot,
      width = hot ? 2.6 : crowd ? 1.3 : 2,
      begin = Math.max(from, track.first),
      end = Math.min(to, track.last);
    for (let b = 0; b < bands; b++) {
      const k0 = Math.max(begin, Math.round(from + ((to - from) * b) / bands)),
        k1 = Math.min(end, Math.round(from + ((to - from) * (b + 1)) / bands));
      const fade = bands === 1 ? 1 : 0.12 + 0.88 * ((b + 1) / bands) ** 1.5;
      if (k1 <= k0) continue;
      if (bands > 1 && (hot || (!focus && !crowd))) {
        // a casing lifts it off the shading
        g.strokeStyle = colours.panel;
        g.lineWidth = width + 2;
        g.globalAlpha = 0.5 * fade;
        line(g, view, track, k0, k1, stride);
      }
      g.strokeStyle = faint || (bands === 1 && crowd && !hot) ? colours.muted : colours.agent(track.id);
      g.lineWidth = width;
      g.globalAlpha = (faint ? 0.16 : strength) * fade;
      line(g, view, track, k0, k1, stride);
    }
  };
  if (focus) for (const track of run.tracks) if (!focus(track.id)) paint(track, false);
  for (const track of run.tracks) if (!focus || focus(track.id)) paint(track, Boolean(focus));
  g.globalAlpha = 1;
}

// The whole history is faint; a bounded tail fades.
export function trailOf(run, { row, tail, colours, focus }) {
  const seconds = TAILS[tail],
    crowd = many(run);
  if (seconds === Infinity)
    return { from: 0, to: row, bands: 1, strength: focus ? 0.8 : crowd ? 0.2 : 0.65, colours, focus };
  return {
    from: Math.max(0, row - Math.round(seconds / run.step)),
    to: row,
    bands: crowd ? 4 : 8,
    strength: 1,
    colours,
    focus,
  };
}

function paintScaleBar(g, run, view, colours) {
  const raw = 110 / view.scale,
    power = 10 ** Math.floor(Math.log10(raw)),
    metres = [5, 2, 1].find(m => m * power <= raw) * power;
  const width = metres * view.scale,
    x = Math.max(0, view.px(0)) + 18,
    y = Math.min(view.height, view.py(0)) - 22;
  g.fillStyle = colours.panel;
  g.globalAlpha = 0.7;
  g.fillRect(x - 8, y - 18, width + 16, 28);
  g.globalAlpha = 1;
  g.strokeStyle = g.fillStyle = colours.ink;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(x, y - 1);
  g.lineTo(x, y + 4);
  g.lineTo(x + width, y + 4);
  g.lineTo(x + width, y - 1);
  g.stroke();
  g.font = '600 11px system-ui, sans-serif';
  g.textAlign = 'center';
  g.textBaseline = 'alphabetic';
  g.fillText(
    metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m` : `${metres * 100} cm`,
    x + width / 2,
    y - 2,
  );
}

// What a view of a box has to the right and upwards.
function paintAxisNames(g, run, view, colours) {
  const [a, b] = run.axes.map(axis => axisName(run.mission.box_m, axis)),
    right = Math.min(view.width, view.px(run.size[0])) - 8,
    top = Math.max(0, view.py(run.size[1])) + 16;
  const left = Math.max(0, view.px(0)) + 8,
    bottom = Math.min(view.height, view.py(0)) - 10;
  g.fillStyle = colours.ink;
  g.font = '600 11px system-ui, sans-serif';
  g.textBaseline = 'alphabetic';
  for (const [text, x, y, align] of [
    [`${a} →`, right, bottom, 'right'],
    [`↑ ${b}`, left, top, 'left'],
  ]) {
    g.textAlign = align;
    g.fillText(text, x, y);
  }
}

function paintStarts(g, run, view, { colours, focus }) {
  g.lineWidth = 1.6;
  for (const track of run.tracks) {
    if (many(run) && !focus?.(track.id)) continue;
    const [x, y] = view.at(track, track.first);
    g.strokeStyle = colours.agent(track.id);
    g.beginPath();
    g.moveTo(x - 4, y - 4);
    g.lineTo(x + 4, y + 4);
    g.moveTo(x + 4, y - 4);
    g.lineTo(x - 4, y + 4);
    g.stroke();
  }
}

// Circles within which others hear an agent: of the chosen ones, or of all of a few.
function paintRadio(g, run, view, { row, colours, focus }) {
  const range = run.mission.radio_range_m;
  g.setLineDash([4, 4]);
  g.lineWidth = 1.2;
  for (const track of run.tracks) {
    if (focus ? !focus(track.id) : many(run)) continue;
    const at = track.rowAt(row);
    if (at < 0) continue;
    g.strokeStyle = colours.agent(track.id);
    g.globalAlpha = 0.6;
    g.beginPath();
    g.arc(...view.at(track, at).slice(0, 2), range * view.scaleAt(track, at), 0, 2 * Math.PI);
    g.stroke();
  }
  g.setLineDash([]);
  g.globalAlpha = 1;
}

// Dotted lines within which sensors find objects: of the chosen agents, or beside what was missed of all of a
// few.
function paintSensors(g, run, view, { row, colours, focus, layer }) {
  const radius = run.mission.sensor.radius_m;
  g.setLineDash([1.5, 3]);
  g.lineWidth = 1.6;
  for (const track of run.tracks) {
    if (focus ? !focus(track.id) : layer !== 'missed' || many(run)) continue;
    const at = track.rowAt(row);
    if (at < 0) continue;
    const reach = radius * view.scaleAt(track, at),
      [x, y] = view.at(track, at);
    g.strokeStyle = colours.agent(track.id);
    oval(
      g,
      x,
      y,
      view.stretchOf(run).map(factor => factor * reach),
    );
    g.stroke();
  }
  g.setLineDash([]);
}

export function paintMarkers(g, run, view, state) {
  const { row, tail, colours, focus, radio } = state;
  if (state.inSpace) paintSpaceMarks(g, run, view, state);
  else paintScaleBar(g, run, view, colours);
  if (run.inBox && !state.inSpace) paintAxisNames(g, run, view, colours);
  if (row > 0) paintStarts(g, run, view, state);
  if (!state.inSpace && TAILS[tail] === Infinity) {
    // the newest part over the whole
    paintTracks(g, run, view, {
      from: Math.max(0, row - Math.round(30 / run.step)),
      to: row,
      bands: many(run) ? 4 : 6,
      strength: 1,
      colours,
      focus,
    });
  }
  if (radio && run.mission.radio_range_m > 0) paintRadio(g, run, view, state);
  paintZoneMarks(g, run, view, state);
  paintSensors(g, run, view, state);
  if (!state.inSpace) paintFinds(g, run, view, state);
  paintAgents(g, run, view, state, state.inSpace ? farthestFirst(run, view, row) : run.tracks);
}
