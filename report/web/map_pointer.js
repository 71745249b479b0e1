// SPDX-License-Identifier: BSD-3-Clause
// Pointer, wheel and fingers on the map: zoom, move, choose an agent, read a place.
import { S } from './state.js';
import { stateOf } from './run.js';
import { hover, pin } from './team.js';
import { redraw, view } from './screen.js';
import { $, put } from './text.js';

export function zoom(factor, px = view.width / 2, py = view.height / 2) {
  view.zoomAt(factor, px, py, S.run.size);
  redraw();
}
export function fit() {
  view.zoom = 1;
  view.place(S.run.size);
  redraw();
}

function nearest(x, y) {
  const row = S.run.rowAt(S.t);
  let best = -1, least = 18;
  for (const track of S.run.tracks) {
    const at = track.rowAt(row), d = at < 0 ? Infinity : Math.hypot(view.px(track.p[2 * at]) - x, view.py(track.p[2 * at + 1]) - y);
    if (d < least) { least = d; best = track.id; }
  }
  return best;
}

function showTip(x, y, agent) {
  const { run } = S, tip = $('tip'), [mx, my] = view.metres(x, y), [lx, ly] = run.size, inside = mx >= 0 && my >= 0 && mx <= lx && my <= ly;
  tip.hidden = !inside;
  if (!inside) return;
  if (agent >= 0) {
    const track = run.track(agent), row = run.rowAt(S.t), speed = run.speedAt(track, row), at = track.rowAt(row), [ox, oy] = run.mission.origin_m;
    put(tip, `agent ${agent}: ${stateOf(run, track, S.t).text}, at ${(track.p[2 * at] + ox).toFixed(0)}, ${(track.p[2 * at + 1] + oy).toFixed(0)} m${speed === null ? '' : `, ${speed.toFixed(1)} m/s`}`);
  } else {
    const { width, height, cells, full } = run.density, i = Math.min(width - 1, Math.floor((mx / lx) * width)), j = Math.min(height - 1, Math.floor((1 - my / ly) * height));
    put(tip, `${(mx + run.mission.origin_m[0]).toFixed(0)}, ${(my + run.mission.origin_m[1]).toFixed(0)} m · target ${((cells[j * width + i] / 255) * full).toFixed(2)}×`);
  }
  tip.style.left = `${Math.min(x + 14, view.width - tip.offsetWidth - 6)}px`;
  tip.style.top = `${y > view.height - 50 ? y - 34 : y + 14}px`;
}

export function connectMap() {
  const map = $('markers'), fingers = new Map();
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
    const was = fingers.get(e.pointerId), x = e.offsetX, y = e.offsetY;
    if (was) {
      const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
      if (other) {
        const distance = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
        zoom(distance([x, y]) / Math.max(1, distance(was)), other[0], other[1]);
      } else if (view.zoom > 1) {
        view.pan(x - was[0], y - was[1], S.run.size);
        redraw();
      }
      moved += Math.abs(x - was[0]) + Math.abs(y - was[1]);
      fingers.set(e.pointerId, [x, y]);
    }
    const agent = nearest(x, y);
    hover(agent);
    showTip(x, y, agent);
  };
  map.onpointerleave = () => { hover(-1); $('tip').hidden = true; };
  map.addEventListener('wheel', e => { e.preventDefault(); zoom(Math.exp(-e.deltaY * 0.0016), e.offsetX, e.offsetY); }, { passive: false });
}
