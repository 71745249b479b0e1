// SPDX-License-Identifier: BSD-3-Clause
// Handles pointer, wheel and fingers on the map: zoom, move, choose an agent, read a place.
import { S, inSpace, mapState, shown } from './state.js';
import { markersOf } from '../map/markers.js';
import { coordinate, nameOf } from '../data/places.js';
import { stateOf } from '../data/agent_state.js';
import { hover, pin } from './team.js';
import { redraw, view } from './screen.js';
import { missedText } from './found.js';
import { $, put } from '../text.js';

const PER_PIXEL = 0.008; // radians

export function zoom(factor, px = view.width / 2, py = view.height / 2) {
  view.zoomAt(factor, px, py, shown().size);
  redraw();
}
export function fit() {
  view.reset();
  view.place(shown().size);
  redraw();
}
// Turns the box by so many radians to the right and upwards.
export function turn(right, up) {
  if (!inSpace()) return;
  view.turn(right, up);
  redraw();
}

// The agent whose place, body or pin is nearest.
function nearest(x, y) {
  let best = -1,
    least = 18;
  for (const { track, x: px, y: py, head, body } of markersOf(shown(), view, mapState())) {
    const d = Math.min(
      Math.max(0, Math.hypot(px - x, py - y) - Math.min(...body)),
      Math.hypot(head[0] - x, head[1] - y),
    );
    if (d < least) {
      least = d;
      best = track.id;
    }
  }
  return best;
}

const placeText = place => `${place.map(v => v.toFixed(0)).join(', ')} m`;

function agentText(run, agent) {
  const track = run.track(agent),
    row = run.rowAt(S.t),
    speed = run.speedAt(track, row),
    at = track.rowAt(row);
  const place = run.mission.origin_m.map((origin, axis) => coordinate(track, axis, at) + origin);
  const motion = speed === null ? '' : `, ${speed.toFixed(1)} m/s`;
  return `agent ${agent}: ${stateOf(run, track, S.t).text}, at ${placeText(place)}${motion}`;
}

// The text for a place of the map; null outside of the domain, and in space, where a pixel is no place.
function groundText(run, x, y) {
  if (inSpace()) return null;
  const [mx, my] = view.metres(x, y),
    [lx, ly] = run.size,
    row = S.run.rowAt(S.t),
    { width, height, cells, full } = run.targetAt(row).density;
  if (!(mx >= 0 && my >= 0 && mx <= lx && my <= ly)) return null;
  const i = Math.min(width - 1, Math.floor((mx / lx) * width)),
    j = Math.min(height - 1, Math.floor((1 - my / ly) * height));
  const place = [mx, my].map((v, k) => v / run.stretch[k] + run.mission.origin_m[k]),
    names = run.inBox ? `${run.axes.map(nameOf).join(', ')}: ` : '';
  const target = `${names}${placeText(place)} · target ${((cells[j * width + i] / 255) * full).toFixed(2)}×`;
  return S.layer === 'missed' ? target + missedText(run, row, mx, my) : target;
}

function showTip(x, y, agent) {
  const tip = $('tip'),
    text = agent >= 0 ? agentText(S.run, agent) : groundText(shown(), x, y);
  tip.hidden = text === null;
  if (tip.hidden) return;
  put(tip, text);
  tip.style.left = `${Math.min(x + 14, view.width - tip.offsetWidth - 6)}px`;
  tip.style.top = `${y > view.height - 50 ? y - 34 : y + 14}px`;
}

export function connectMap() {
  const map = $('markers'),
    fingers = new Map();
  let moved = 0;
  map.onpointerdown = e => {
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
    map.setPointerCapture(e.pointerId);
    moved = 0;
  };
  map.onpointerup = map.onpointercancel = e => {
    fingers.delete(e.pointerId);
    if (e.type === 'pointerup' && moved < 4 && S.hover >= 0) pin(S.hover);
  };
  map.onpointermove = e => {
    const was = fingers.get(e.pointerId),
      x = e.offsetX,
      y = e.offsetY;
    if (was) {
      const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
      if (other) {
        const distance = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
        zoom(distance([x, y]) / Math.max(1, distance(was)), other[0], other[1]);
      } else if (inSpace() && !e.shiftKey) {
        turn((x - was[0]) * PER_PIXEL, (y - was[1]) * PER_PIXEL);
      } else if (inSpace() || view.zoom > 1) {
        view.pan(x - was[0], y - was[1], shown().size);
        redraw();
      }
      moved += Math.abs(x - was[0]) + Math.abs(y - was[1]);
      fingers.set(e.pointerId, [x, y]);
    }
    const agent = nearest(x, y);
    hover(agent);
    showTip(x, y, agent);
  };
  map.onpointerleave = () => {
    hover(-1);
    $('tip').hidden = true;
  };
  map.addEventListener(
    'wheel',
    e => {
      e.preventDefault();
      zoom(Math.exp(-e.deltaY * 0.0016), e.offsetX, e.offsetY);
    },
    { passive: false },
  );
}
