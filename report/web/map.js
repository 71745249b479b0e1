// SPDX-License-Identifier: BSD-3-Clause
// The map, in three layers: shading, trails, markers. Each draws on a canvas, or on anything with
// the same methods (svg.js).
import { inkOn } from './colours.js';
import { clamp } from './text.js';
import { stateOf } from './run.js';

export const TAILS = [0, 10, 30, 60, 120, 300, 600, Infinity];  // s
const MANY = 12;              // more agents than these are drawn smaller
const CONTOUR = 64;           // of 255: the target's outline over the other shadings

// Where the domain lies on the canvas: the whole, or a part of it.
export class View {
  constructor() { Object.assign(this, { zoom: 1, x: 0, y: 0, width: 1, height: 1 }); }
  resize(width, height) { Object.assign(this, { width, height }); }
  place([lx, ly]) {
    const margin = this.zoom > 1 ? 0 : 12;
    this.fit = Math.min((this.width - 2 * margin) / lx, (this.height - 2 * margin) / ly);
    if (this.zoom === 1) { this.x = lx / 2; this.y = ly / 2; }
    this.scale = this.fit * this.zoom;              // pixels per metre
    this.left = this.width / 2 - this.x * this.scale;
    this.bottom = this.height / 2 + this.y * this.scale;
  }
  px(x) { return this.left + x * this.scale; }
  py(y) { return this.bottom - y * this.scale; }
  metres(px, py) { return [(px - this.left) / this.scale, (this.bottom - py) / this.scale]; }
  zoomAt(factor, px, py, size) {
    const [x, y] = this.metres(px, py);
    this.zoom = clamp(this.zoom * factor, 1, 40);
    const scale = this.fit * this.zoom;
    this.x = clamp(x + (this.width / 2 - px) / scale, 0, size[0]);
    this.y = clamp(y - (this.height / 2 - py) / scale, 0, size[1]);
    this.place(size);
  }
  pan(dx, dy, size) {
    this.x = clamp(this.x - dx / this.scale, 0, size[0]);
    this.y = clamp(this.y + dy / this.scale, 0, size[1]);
    this.place(size);
  }
  get key() { return [this.zoom, this.x, this.y, this.width, this.height].join(); }
}

// Pieces of the line on which the target is CONTOUR, in metres: marching squares.
function contour({ width, height, cells }, [lx, ly]) {
  const step = Math.max(1, width >> 7), pieces = [];
  for (let j = 0; j + step < height; j += step) for (let i = 0; i + step < width; i += step) {
    const corners = [[i, j], [i + step, j], [i + step, j + step], [i, j + step]];
    const values = corners.map(([a, b]) => cells[b * width + a]), cut = [];
    for (let e = 0; e < 4; e++) {
      const a = values[e], b = values[(e + 1) % 4];
      if (a < CONTOUR === b < CONTOUR) continue;
      const share = (CONTOUR - a) / (b - a), p = corners[e], q = corners[(e + 1) % 4];
      cut.push(((p[0] + (q[0] - p[0]) * share + 0.5) / width) * lx, (1 - (p[1] + (q[1] - p[1]) * share + 0.5) / height) * ly);
    }
    for (let c = 0; c + 3 < cut.length; c += 4) pieces.push(cut.slice(c, c + 4));
  }
  return pieces;
}

// Rectangles in metres of the cells where the target is 0, unless that is most of the domain.
function nowhere({ width, height, cells }, [lx, ly]) {
  const rectangles = [];
  let zeros = 0;
  for (let j = 0; j < height; j++) for (let i = 0; i < width; i++) {
    if (cells[j * width + i]) continue;
    const from = i;
    while (i < width && !cells[j * width + i]) i++;
    zeros += i - from;
    rectangles.push([(from / width) * lx, (1 - (j + 1) / height) * ly, ((i - from) / width) * lx, ly / height]);
  }
  return zeros < 0.6 * width * height ? rectangles : [];
}

// The shading as a picture: target, achieved or difference.
export function shading(run, layer, row, colours) {
  const { density, size, coverage, mission } = run, achieved = layer !== 'target';
  const width = achieved ? Math.max(24, Math.round(size[0] >= size[1] ? 128 : (128 * size[0]) / size[1])) : density.width;
  const height = achieved ? Math.max(24, Math.round(size[0] >= size[1] ? (128 * size[1]) / size[0] : 128)) : density.height;
  const image = new ImageData(width, height), pixels = new Uint32Array(image.data.buffer);
  if (achieved) {
    const c = coverage.at(row), difference = layer === 'difference';
    const table = difference ? colours.difference : colours.amount, zero = difference ? 127.5 : 0;
    const values = coverage.picture(difference ? c.map((v, k) => v - mission.target[k]) : c, width, height);
    for (let i = 0; i < pixels.length; i++) pixels[i] = table[clamp(zero + (255 * values[i]) / density.full, 0, 255) | 0];
  } else {
    for (let i = 0; i < pixels.length; i++) pixels[i] = colours.amount[density.cells[i]];
  }
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
}

function hatch(g, rectangles, view, colours) {
  if (!rectangles.length) return;
  g.save();
  g.beginPath();
  for (const [x, y, w, h] of rectangles) g.rect(view.px(x), view.py(y + h), w * view.scale, h * view.scale + 0.5);
  g.clip();
  g.strokeStyle = colours.bad;
  g.globalAlpha = colours.theme === 'dark' ? 0.16 : 0.22;
  g.lineWidth = 1;
  g.beginPath();
  for (let x = -view.height; x < view.width; x += 7) { g.moveTo(x, view.height); g.lineTo(x + view.height, 0); }
  g.stroke();
  g.restore();
}

export function paintShading(g, run, view, { layer, row, colours }) {
  const [lx, ly] = run.size;
  run.outline ??= contour(run.density, run.size);
  run.nowhere ??= nowhere(run.density, run.size);
  g.fillStyle = colours.bg;
  g.fillRect(0, 0, view.width, view.height);
  g.imageSmoothingEnabled = true;
  g.imageSmoothingQuality = 'high';
  g.drawImage(shading(run, layer, row, colours), view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
  hatch(g, run.nowhere, view, colours);
  g.strokeStyle = colours.muted;
  g.lineWidth = 1;
  g.globalAlpha = 0.6;
  g.strokeRect(view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
  if (layer !== 'target') {
    g.strokeStyle = colours.ink;
    g.globalAlpha = 0.38;
    g.beginPath();
    for (const [a, b, c, d] of run.outline) { g.moveTo(view.px(a), view.py(b)); g.lineTo(view.px(c), view.py(d)); }
    g.stroke();
  }
  g.globalAlpha = 1;
}

const many = run => run.tracks.length > MANY;

// Rows that a piece of a line spans: 1.6 pixels, of the history of many agents 4.
export function rowsPerPiece(run, view, plain) {
  if (!run.pace) {                          // metres per row, of the first agent
    const [track] = run.tracks, rows = track ? track.last - track.first : 0;
    const pace = rows > 0 ? track.distance(track.last) / rows : 0;
    if (rows > 200) run.pace = pace;        // settled
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
    if (x !== x) { pen = false; return; }
    if (pen) g.lineTo(view.px(x), view.py(p[2 * k + 1])); else g.moveTo(view.px(x), view.py(p[2 * k + 1]));
    pen = true;
  };
  visit(from);
  for (let k = from - (from % stride) + stride; k < to; k += stride) visit(k);
  visit(to);
  g.stroke();
}

// The tracks' rows from … to. `bands`: steps in which they fade; 1: all alike.
export function paintTracks(g, run, view, { from, to, bands, strength, colours, focus }) {
  const crowd = many(run), stride = rowsPerPiece(run, view, bands === 1);
  g.lineJoin = 'round';
  g.lineCap = 'butt';
  const paint = (track, hot) => {
    const faint = focus && !hot, width = hot ? 2.6 : crowd ? 1.3 : 2, begin = Math.max(from, track.first), end = Math.min(to, track.last);
    for (let b = 0; b < bands; b++) {
      const k0 = Math.max(begin, Math.round(from + ((to - from) * b) / bands)), k1 = Math.min(end, Math.round(from + ((to - from) * (b + 1)) / bands));
      const fade = bands === 1 ? 1 : 0.12 + 0.88 * ((b + 1) / bands) ** 1.5;
      if (k1 <= k0) continue;
      if (bands > 1 && (hot || (!focus && !crowd))) {   // a casing lifts it off the shading
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
  const seconds = TAILS[tail], crowd = many(run);
  if (seconds === Infinity) return { from: 0, to: row, bands: 1, strength: focus ? 0.7 : crowd ? 0.16 : 0.4, colours, focus };
  return { from: Math.max(0, row - Math.round(seconds / run.step)), to: row, bands: crowd ? 4 : 8, strength: 1, colours, focus };
}

function paintScaleBar(g, run, view, colours) {
  const raw = 110 / view.scale, power = 10 ** Math.floor(Math.log10(raw)), metres = [5, 2, 1].find(m => m * power <= raw) * power;
  const width = metres * view.scale, x = Math.max(0, view.px(0)) + 18, y = Math.min(view.height, view.py(0)) - 22;
  g.fillStyle = colours.panel;
  g.globalAlpha = 0.7;
  g.fillRect(x - 8, y - 18, width + 16, 28);
  g.globalAlpha = 1;
  g.strokeStyle = g.fillStyle = colours.ink;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(x, y - 1); g.lineTo(x, y + 4); g.lineTo(x + width, y + 4); g.lineTo(x + width, y - 1);
  g.stroke();
  g.font = '600 11px system-ui, sans-serif';
  g.textAlign = 'center';
  g.textBaseline = 'alphabetic';
  g.fillText(metres >= 1000 ? `${metres / 1000} km` : metres >= 1 ? `${metres} m` : `${metres * 100} cm`, x + width / 2, y - 2);
}

function paintStarts(g, run, view, { colours, focus }) {
  g.lineWidth = 1.6;
  for (const track of run.tracks) {
    if (many(run) && !focus?.(track.id)) continue;
    const x = view.px(track.p[2 * track.first]), y = view.py(track.p[2 * track.first + 1]);
    g.strokeStyle = colours.agent(track.id);
    g.beginPath();
    g.moveTo(x - 4, y - 4); g.lineTo(x + 4, y + 4); g.moveTo(x + 4, y - 4); g.lineTo(x - 4, y + 4);
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
    g.arc(view.px(track.p[2 * at]), view.py(track.p[2 * at + 1]), range * view.scale, 0, 2 * Math.PI);
    g.stroke();
  }
  g.setLineDash([]);
  g.globalAlpha = 1;
}

function paintMarker(g, run, view, track, { row, t, colours, focus }) {
  const at = track.rowAt(row);
  if (at < 0) return;
  const hot = focus?.(track.id), crowd = many(run), small = view.width < 500;
  const radius = (crowd ? (small ? 6.5 : 8) : 10.5) * (hot ? 1.25 : 1), x = view.px(track.p[2 * at]), y = view.py(track.p[2 * at + 1]);
  const { kind } = stateOf(run, track, t), away = kind === 'silent' || kind === 'gone';
  const back = Math.max(track.first, at - Math.max(1, Math.round(1 / run.step))), ahead = Math.min(track.last, at + 1);
  const heading = Math.atan2(track.p[2 * back + 1] - track.p[2 * ahead + 1], track.p[2 * ahead] - track.p[2 * back]);
  const moves = track.p[2 * ahead] !== track.p[2 * back] || track.p[2 * ahead + 1] !== track.p[2 * back + 1];
  const fill = away ? colours.panel : colours.agent(track.id), rim = kind === 'gone' ? colours.gone : colours.bad;
  g.globalAlpha = focus && !hot ? 0.35 : 1;
  g.fillStyle = fill;
  g.strokeStyle = away ? rim : colours.panel;
  g.lineWidth = 1.5;
  if (away) g.setLineDash([3, 2]);
  g.beginPath();
  if (away || !moves || heading !== heading) {
    g.arc(x, y, radius, 0, 2 * Math.PI);
  } else {                                              // a drop whose tip shows where it goes
    g.arc(x, y, radius, heading + 0.62, heading - 0.62 + 2 * Math.PI);
    g.lineTo(x + Math.cos(heading) * radius * 1.65, y + Math.sin(heading) * radius * 1.65);
    g.closePath();
  }
  g.fill();
  g.stroke();
  g.setLineDash([]);
  if (kind === 'late') {
    g.strokeStyle = colours.warn;
    g.lineWidth = 2;
    g.beginPath();
    g.arc(x, y, radius + 4, 0, 2 * Math.PI);
    g.stroke();
  }
  g.fillStyle = away ? rim : inkOn(fill);
  g.font = `700 ${(crowd ? (small ? 8 : 9.5) : 11.5) * (hot ? 1.25 : 1)}px system-ui, sans-serif`;
  g.textAlign = 'center';
  g.textBaseline = 'middle';
  g.fillText(String(track.id), x, y + 0.5);
}

export function paintMarkers(g, run, view, state) {
  const { row, tail, colours, focus, radio } = state;
  paintScaleBar(g, run, view, colours);
  if (row > 0) paintStarts(g, run, view, state);
  if (TAILS[tail] === Infinity) {                       // the newest part over the whole
    paintTracks(g, run, view, { from: Math.max(0, row - Math.round(30 / run.step)), to: row, bands: many(run) ? 4 : 6, strength: 1, colours, focus });
  }
  if (radio && run.mission.radio_range_m > 0) paintRadio(g, run, view, state);
  for (const track of run.tracks) if (!focus?.(track.id)) paintMarker(g, run, view, track, state);
  for (const track of run.tracks) if (focus?.(track.id)) paintMarker(g, run, view, track, state);
  g.globalAlpha = 1;
}
