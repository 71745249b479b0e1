// SPDX-License-Identifier: BSD-3-Clause
// Draws each canvas of a run's page when what it shows has changed.
import { S, ask, inSpace, mapState, shown } from './state.js';
import { View } from '../map/view.js';
import { Space } from '../map/space.js';
import { SpaceView } from '../map/space_view.js';
import { TAILS, paintMarkers, paintTracks, rowsPerPiece, trailOf } from '../map/map.js';
import { paintShading } from '../map/ground.js';
import { paintDrawn } from '../map/drawn_layer.js';
import { paintChart, readingAt } from './chart.js';
import { buildStrip } from './timeline.js';
import { $, clamp, put } from '../text.js';

const SIDE = 508; // pixels that the table of agents needs
const LAYERS = ['shading', 'trails', 'markers', 'chart'];
const MOST_COUNT_MS = 40; // in a frame

const flat = new View(),
  turning = new SpaceView();
let space = null;
export let view = flat;
let scale = 1,
  shadingKey = '',
  drawnKey = '',
  trail = { key: '', row: -1, upto: 0 };

function context(id) {
  const g = $(id).getContext('2d');
  g.setTransform(scale, 0, 0, scale, 0, 0);
  return g;
}

// Where objects were missed is counted in slices, so that the page answers meanwhile. It shows the last
// picture until then.
function isCounted() {
  const { run, layer, t } = S;
  if (layer !== 'missed' || run.detection.build(run.rowAt(t), performance.now() + MOST_COUNT_MS)) return true;
  ask();
  return false;
}

function drawShading() {
  const row = S.run.rowAt(S.t),
    target = S.run.targetAt(row),
    zones = S.run.zonesAt(row).map(({ number, from }) => number + (row * S.run.stride < from ? 'c' : 'f')),
    key = [
      S.layer,
      S.layer === 'target' ? '' : row,
      target.id,
      ...zones,
      view.key,
      S.theme,
      S.run.id,
      S.view,
    ].join();
  if (key === shadingKey || !isCounted()) return;
  shadingKey = key;
  paintShading(context('shading'), shown(), view, mapState());
}

// The whole history grows on its canvas; a bounded trail is drawn anew.
function drawTrails() {
  const run = shown(),
    row = run.rowAt(S.t),
    key = [run.id, S.view, S.tail, view.key, S.theme, S.hover, ...S.pins].join();
  if (key === trail.key && row === trail.row) return;
  const g = context('trails'),
    state = mapState(),
    part = trailOf(run, state),
    whole = TAILS[S.tail] === Infinity;
  if (!whole || key !== trail.key || row < trail.upto) {
    g.clearRect(0, 0, view.width, view.height);
    trail.upto = 0;
  }
  if (whole) {
    part.from = trail.upto;
    part.to = row - (row % rowsPerPiece(run, view, true));
    trail.upto = part.to;
  }
  if (TAILS[S.tail] && part.to > part.from) paintTracks(g, run, view, part);
  trail.key = key;
  trail.row = row;
}

function drawSpace() {
  const key = [
    S.run.id,
    S.run.rowAt(S.t),
    S.layer,
    S.tail,
    S.slices,
    view.key,
    S.theme,
    S.hover,
    ...S.pins,
  ].join();
  if (key === shadingKey || !isCounted()) return;
  space.paint(S.run, view, mapState(), scale);
  shadingKey = key;
}

function drawMarkers() {
  const g = context('markers');
  g.clearRect(0, 0, view.width, view.height);
  paintMarkers(g, shown(), view, mapState());
}

// The new target or zone that is being drawn.
function drawDrawn() {
  const { drawing } = S;
  if (!drawing) return;
  const key = [drawing.version, drawing.open.length ? drawing.pointer : '', view.key, S.theme].join();
  if (key === drawnKey) return;
  drawnKey = key;
  const g = context('drawn');
  g.clearRect(0, 0, view.width, view.height);
  paintDrawn(g, S.run.size, view, drawing, S.colours);
}

function drawChart() {
  const canvas = $('chart'),
    g = context('chart');
  g.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  paintChart(g, S.run, S, canvas.clientWidth, canvas.clientHeight);
  put($('reading'), S.pointer >= 0 ? readingAt(S.run, S.quantity, S.pointer) : '');
}

export function drawPictures() {
  if (inSpace()) {
    drawSpace();
  } else {
    drawShading();
    drawTrails();
  }
  drawMarkers();
  drawDrawn();
  drawChart();
}

// Waits until the pictures are in the canvases.
export function readPixels() {
  for (const id of LAYERS) $(id).getContext('2d').getImageData(0, 0, 1, 1);
  if (inSpace()) space.read();
}

// Everything anew.
export function redraw() {
  shadingKey = drawnKey = trail.key = '';
  $('fit').hidden = view.whole;
  ask();
}

// Whether this browser can turn a box.
export function canTurn() {
  space ??= new Space($('space'));
  return space.works;
}

// The map's column follows the shape of what it shows.
export function layout() {
  if (!S.run) return;
  view = inSpace() ? turning : flat;
  const narrow = innerWidth <= 820,
    [lx, ly] = inSpace() ? [narrow ? 0.95 : 1.15, 1] : shown().size,
    main = document.querySelector('main');
  document.documentElement.style.setProperty('--aspect', clamp(lx / ly, 0.5, 4));
  main.classList.toggle('wide', lx / ly > 1.2);
  if (!narrow) {
    const wanted = clamp(((main.clientHeight - 42) * lx) / ly, 420, main.clientWidth * 0.68);
    main.style.setProperty(
      '--mapWidth',
      `${Math.round(Math.min(wanted, main.clientWidth - Math.min(SIDE, main.clientWidth / 2)))}px`,
    );
  }
  scale = Math.min(devicePixelRatio || 1, 2);
  view.resize($('stage').clientWidth, $('stage').clientHeight);
  for (const id of [...LAYERS, 'space', 'drawn']) {
    const canvas = $(id),
      width = Math.round(canvas.clientWidth * scale),
      height = Math.round(canvas.clientHeight * scale);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
  }
  view.place(shown().size);
  redraw();
  buildStrip();
}
