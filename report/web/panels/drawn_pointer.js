// SPDX-License-Identifier: BSD-3-Clause
// Handles pointer and keys on the layer where a new target or zone is drawn.
import { S } from './state.js';
import { view } from './screen.js';
import { zoom } from './map_pointer.js';
import { inside } from '../data/drawn.js';
import { $, clamp } from '../text.js';

const NEAR = 9, // pixels
  NEAR_FINGER = 22;
const SMALL = 0.05; // the spread of a new peak, as a share of the shorter side
const SQUARE = 0.1; // half the side of a new square, the same
let grip = null; // {part, move(x, y)}: what the pointer moves

const near = e => (e.pointerType === 'touch' ? NEAR_FINGER : NEAR);
const apart = ([x, y], e) => Math.hypot(view.px(x) - e.offsetX, view.py(y) - e.offsetY);

function placeOf(e) {
  const [x, y] = view.metres(e.offsetX, e.offsetY),
    [lx, ly] = S.run.size;
  return [clamp(x, 0, lx), clamp(y, 0, ly)];
}

const shorter = () => Math.min(S.run.size[0], S.run.size[1]);
const within = ([x, y]) => [clamp(x, 0, S.run.size[0]), clamp(y, 0, S.run.size[1])];

// Moves a part, so that a peak's centre and all corners stay in the domain.
function shift(part, dx, dy) {
  const places = part.kind === 'peak' ? [part.at] : part.corners,
    least = axis => Math.min(...places.map(place => place[axis])),
    most = axis => Math.max(...places.map(place => place[axis])),
    by = [dx, dy].map((d, axis) => clamp(d, -least(axis), S.run.size[axis] - most(axis)));
  const moved = place => place.map((v, axis) => v + by[axis]);
  if (part.kind === 'peak') part.at = moved(part.at);
  else part.corners = part.corners.map(moved);
}

const leastSpread = () => 0.005 * shorter();

const spreading = part => ({
  part,
  move: place => {
    part.spread = Math.max(leastSpread(), Math.hypot(place[0] - part.at[0], place[1] - part.at[1]));
  },
});

function moving(part, from) {
  let last = from;
  return {
    part,
    move: place => {
      shift(part, place[0] - last[0], place[1] - last[1]);
      last = place;
    },
  };
}

const cornering = (part, i) => ({ part, move: place => part.corners.splice(i, 1, within(place)) });

function choose(part) {
  S.drawing.chosen = part;
  S.drawing.corner = -1;
}

// What is under the pointer: the handles of the chosen part come first.
function gripAt(e) {
  const { parts, chosen } = S.drawing,
    place = placeOf(e);
  if (chosen?.kind === 'peak') {
    const off = Math.hypot(place[0] - chosen.at[0], place[1] - chosen.at[1]);
    if (apart(chosen.at, e) <= near(e)) return moving(chosen, place);
    if (Math.abs(off - chosen.spread) * view.scale <= near(e)) return spreading(chosen);
  }
  const corner = chosen?.kind === 'polygon' ? chosen.corners.findIndex(at => apart(at, e) <= near(e)) : -1;
  if (corner >= 0) return cornering(chosen, corner);
  const part = parts.findLast(one =>
    one.kind === 'peak'
      ? apart(one.at, e) <= Math.max(near(e), Math.min(24, one.spread * view.scale))
      : inside([one.corners], ...place),
  );
  return part ? moving(part, place) : null;
}

// In a box a new peak is at half the height.
function addPeak(at) {
  const peak = { kind: 'peak', at, spread: SMALL * shorter() };
  if (S.run.inBox) peak.z = S.run.size[2] / 2;
  S.drawing.parts.push(peak);
  choose(peak);
  return peak;
}

// In a box a new polygon has the whole height.
function addPolygon(corners) {
  const polygon = { kind: 'polygon', corners };
  if (S.run.inBox) polygon.heights = [0, S.run.size[2]];
  S.drawing.parts.push(polygon);
  choose(polygon);
}

// A part in the domain's middle, for those who use keys.
function addInTheMiddle() {
  const [x, y] = [S.run.size[0] / 2, S.run.size[1] / 2],
    half = SQUARE * shorter();
  if (S.drawing.tool === 'peak') addPeak([x, y]);
  else
    addPolygon([
      [x - half, y - half],
      [x + half, y - half],
      [x + half, y + half],
      [x - half, y + half],
    ]);
}

function closePolygon() {
  const { drawing } = S;
  if (drawing.open.length < 3) return;
  addPolygon(drawing.open);
  drawing.open = [];
}

export function removeChosen() {
  const { drawing } = S;
  if (drawing.open.length) {
    drawing.open = [];
    return;
  }
  drawing.parts = drawing.parts.filter(part => part !== drawing.chosen);
  choose(drawing.parts[drawing.parts.length - 1] ?? null);
}

// A press begins or closes a polygon, takes hold of a part, or makes a new one.
function press(e) {
  const { drawing } = S;
  if (drawing.open.length) {
    if (drawing.open.length > 2 && apart(drawing.open[0], e) <= near(e)) closePolygon();
    else drawing.open.push(placeOf(e));
    return;
  }
  grip = gripAt(e);
  if (grip) choose(grip.part);
  else if (drawing.full) return;
  else if (drawing.tool === 'polygon') drawing.open = [placeOf(e)];
  else grip = { ...spreading(addPeak(placeOf(e))), from: [e.offsetX, e.offsetY] };
}

function drag(e) {
  const { drawing } = S;
  drawing.pointer = placeOf(e);
  if (!grip) return drawing.open.length > 0;
  // A click without a drag leaves a new peak as it is.
  if (grip.from && Math.hypot(e.offsetX - grip.from[0], e.offsetY - grip.from[1]) < 4) return false;
  grip.from = null;
  grip.move(drawing.pointer);
  return true;
}

const STEP = 0.01; // of the domain
const by = (x, y) => () => {
  const { chosen, corner } = S.drawing,
    [dx, dy] = [x * S.run.size[0], y * S.run.size[1]];
  if (!chosen) return;
  if (corner >= 0)
    chosen.corners[corner] = within([chosen.corners[corner][0] + dx, chosen.corners[corner][1] + dy]);
  else shift(chosen, dx, dy);
};
const widen = factor => () => {
  const { chosen } = S.drawing;
  if (chosen?.kind === 'peak') chosen.spread = Math.max(leastSpread(), chosen.spread * factor);
  else if (chosen) {
    const [mx, my] = [0, 1].map(
      axis => chosen.corners.reduce((sum, corner) => sum + corner[axis], 0) / chosen.corners.length,
    );
    chosen.corners = chosen.corners.map(([x, y]) => within([mx + factor * (x - mx), my + factor * (y - my)]));
  }
};
// The next corner of the chosen polygon; after the last one the arrows move all of it again.
function nextCorner() {
  const { drawing } = S,
    count = drawing.chosen?.corners?.length ?? 0;
  drawing.corner = drawing.corner + 1 < count ? drawing.corner + 1 : -1;
}
const KEYS = {
  ArrowLeft: by(-STEP, 0),
  ArrowRight: by(STEP, 0),
  ArrowUp: by(0, STEP),
  ArrowDown: by(0, -STEP),
  '+': widen(1.1),
  '=': widen(1.1),
  '-': widen(1 / 1.1),
  Delete: removeChosen,
  Backspace: removeChosen,
  Enter: () => {
    if (S.drawing.open.length) closePolygon();
    else if (!S.drawing.full) addInTheMiddle();
  },
  c: nextCorner,
  Escape: () => {
    S.drawing.open = [];
    choose(null);
  },
};

export function connectDrawnPointer(changed) {
  const layer = $('drawn');
  layer.onpointerdown = e => {
    layer.setPointerCapture(e.pointerId);
    press(e);
    changed();
  };
  layer.onpointermove = e => {
    if (drag(e)) changed();
    layer.style.cursor = !S.drawing.open.length && gripAt(e) ? 'move' : 'crosshair';
  };
  layer.onpointerup = layer.onpointercancel = () => {
    grip = null;
  };
  layer.ondblclick = () => {
    // The second press has added a corner at the place of the first one.
    S.drawing.open.pop();
    closePolygon();
    changed();
  };
  layer.onkeydown = e => {
    const action = KEYS[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    if (!action || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault();
    e.stopPropagation();
    action();
    changed();
  };
  layer.addEventListener(
    'wheel',
    e => {
      e.preventDefault();
      zoom(Math.exp(-e.deltaY * 0.0016), e.offsetX, e.offsetY);
    },
    { passive: false },
  );
}
