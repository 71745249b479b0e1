// SPDX-License-Identifier: BSD-3-Clause
// Paints the ground of the map: shading, the target's outline, where nobody is wanted, walls, and zones.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { paintZones } from './zones_layer.js';
import { clamp } from '../text.js';

const CONTOUR = 64; // of 255: the target's outline over the other shadings
const LEVELS = [64, 128, 192]; // of its own: what is under trails can be read from its lines

// Pieces of the line on which `value` of a cell is `level`, in metres: marching squares.
function contour({ width, height }, [lx, ly], step, value, level) {
  const pieces = [];
  for (let j = 0; j + step < height; j += step)
    for (let i = 0; i + step < width; i += step) {
      const corners = [
        [i, j],
        [i + step, j],
        [i + step, j + step],
        [i, j + step],
      ];
      const values = corners.map(([a, b]) => value(b * width + a)),
        cut = [];
      for (let e = 0; e < 4; e++) {
        const a = values[e],
          b = values[(e + 1) % 4];
        if (a < level === b < level) continue;
        const share = (level - a) / (b - a),
          p = corners[e],
          q = corners[(e + 1) % 4];
        cut.push(
          ((p[0] + (q[0] - p[0]) * share + 0.5) / width) * lx,
          (1 - (p[1] + (q[1] - p[1]) * share + 0.5) / height) * ly,
        );
      }
      for (let c = 0; c + 3 < cut.length; c += 4) pieces.push(cut.slice(c, c + 4));
    }
  return pieces;
}

const outlineOf = (density, size, level) =>
  contour(density, size, Math.max(1, density.width >> 7), k => density.cells[k], level);

// Where the target is 0, unless that is most of the domain: rectangles of cells, and their outline.
function nowhereOf(density, [lx, ly]) {
  const { width, height, cells } = density,
    rectangles = [];
  let zeros = 0;
  for (let j = 0; j < height; j++)
    for (let i = 0; i < width; i++) {
      if (cells[j * width + i]) continue;
      const from = i;
      while (i < width && !cells[j * width + i]) i++;
      zeros += i - from;
      rectangles.push([
        (from / width) * lx,
        (1 - (j + 1) / height) * ly,
        ((i - from) / width) * lx,
        ly / height,
      ]);
    }
  if (zeros >= 0.6 * width * height) return { rectangles: [], outline: [] };
  return { rectangles, outline: contour(density, [lx, ly], 1, k => (cells[k] ? 1 : 0), 0.5) };
}

function canvasOf(image) {
  const canvas = document.createElement('canvas');
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext('2d').putImageData(image, 0, 0);
  return canvas;
}

// What may have been missed, on the scale of the target.
function missedShading(run, row, colours) {
  const { width, height, values } = run.missed(row),
    { full } = run.targetAt(row).density,
    image = new ImageData(width, height),
    pixels = new Uint32Array(image.data.buffer);
  values.forEach((v, i) => {
    pixels[i] = colours.amount[clamp((255 * v) / full, 0, 255) | 0];
  });
  return canvasOf(image);
}

// The shading as a picture.
function shading(run, layer, row, colours) {
  if (layer === 'missed') return missedShading(run, row, colours);
  const { density } = run.targetAt(row),
    { size } = run,
    achieved = layer !== 'target';
  const width = achieved
    ? Math.max(24, Math.round(size[0] >= size[1] ? 128 : (128 * size[0]) / size[1]))
    : density.width;
  const height = achieved
    ? Math.max(24, Math.round(size[0] >= size[1] ? (128 * size[1]) / size[0] : 128))
    : density.height;
  const image = new ImageData(width, height),
    pixels = new Uint32Array(image.data.buffer);
  if (achieved) {
    const difference = layer === 'difference',
      table = difference ? colours.difference : colours.amount,
      zero = difference ? 127.5 : 0;
    const values = run.picture(layer, row, width, height);
    for (let i = 0; i < pixels.length; i++)
      pixels[i] = table[clamp(zero + (255 * values[i]) / density.full, 0, 255) | 0];
  } else {
    for (let i = 0; i < pixels.length; i++) pixels[i] = colours.amount[density.cells[i]];
  }
  return canvasOf(image);
}

function hatch(g, rectangles, view, colours) {
  if (!rectangles.length) return;
  g.save();
  g.beginPath();
  for (const [x, y, w, h] of rectangles)
    g.rect(view.px(x), view.py(y + h), w * view.scale, h * view.scale + 0.5);
  g.clip();
  g.strokeStyle = colours.bad;
  g.globalAlpha = colours.theme === 'dark' ? 0.16 : 0.22;
  g.lineWidth = 1;
  g.beginPath();
  for (let x = -view.height; x < view.width; x += 7) {
    g.moveTo(x, view.height);
    g.lineTo(x + view.height, 0);
  }
  g.stroke();
  g.restore();
}

function stroke(g, view, pieces) {
  g.beginPath();
  for (const [a, b, c, d] of pieces) {
    g.moveTo(view.px(a), view.py(b));
    g.lineTo(view.px(c), view.py(d));
  }
  g.stroke();
}

// A place is solid if an odd number of rings are around it.
function paintWalls(g, run, view, colours) {
  const [lx, ly] = run.size,
    rings = run.mission.walls ?? [];
  if (!rings.length) return;
  g.save();
  g.beginPath();
  g.rect(view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
  g.clip();
  g.beginPath();
  for (const ring of rings) {
    ring.forEach(([x, y], i) => {
      if (i) g.lineTo(view.px(x), view.py(y));
      else g.moveTo(view.px(x), view.py(y));
    });
    g.closePath();
  }
  g.fillStyle = colours.muted;
  g.strokeStyle = colours.ink;
  g.lineWidth = 1.2;
  g.fill('evenodd');
  g.stroke();
  g.restore();
}

// Open squares where agents are to be at the end.
function paintStations(g, run, view, colours) {
  const half = 12,
    [a, b] = run.axes;
  g.save();
  for (const [colour, width] of [
    [colours.bg, 4],
    [colours.ink, 1.6],
  ]) {
    g.strokeStyle = colour;
    g.lineWidth = width;
    for (const { at_m: at } of run.mission.stations ?? [])
      g.strokeRect(
        view.px(run.stretch[0] * at[a]) - half,
        view.py(run.stretch[1] * at[b]) - half,
        2 * half,
        2 * half,
      );
  }
  g.restore();
}

export function paintShading(g, run, view, { layer, row, colours }) {
  const { size } = run,
    [lx, ly] = size,
    target = run.targetAt(row),
    { density } = target;
  target.outline ??= outlineOf(density, size, CONTOUR);
  target.levels ??= LEVELS.map(level => outlineOf(density, size, level));
  target.nowhere ??= nowhereOf(density, size);
  g.fillStyle = colours.bg;
  g.fillRect(0, 0, view.width, view.height);
  g.imageSmoothingEnabled = true;
  g.imageSmoothingQuality = 'high';
  g.drawImage(shading(run, layer, row, colours), view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
  hatch(g, target.nowhere.rectangles, view, colours);
  g.strokeStyle = colours.bad;
  g.lineWidth = 1.4;
  g.globalAlpha = 0.75;
  stroke(g, view, target.nowhere.outline);
  g.strokeStyle = colours.muted;
  g.lineWidth = 1;
  g.globalAlpha = 0.6;
  g.strokeRect(view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
  g.strokeStyle = colours.ink;
  g.globalAlpha = layer === 'target' ? 0.2 : 0.38;
  for (const pieces of layer === 'target' ? target.levels : [target.outline]) stroke(g, view, pieces);
  g.globalAlpha = 1;
  paintWalls(g, run, view, colours);
  paintZones(g, run, view, row, colours);
  paintStations(g, run, view, colours);
}
