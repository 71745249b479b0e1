// SPDX-License-Identifier: BSD-3-Clause
// Paints the agents on the map: bodies to scale, and pins with their numbers.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { inkOn } from '../colours.js';
import { stateOf } from '../data/run.js';

const MANY = 12; // more agents than these are drawn smaller
const REACH = 2; // from the tip of a pin to the middle of its head, in radii of the head
const MOST_THAT_LEAN = 128; // agents: each looks at all others
const GOLDEN_ANGLE = 2.4; // radians: no multiples of it are near each other
const LEAST_BODY = 0.75; // pixels: a smaller body is not drawn

export const many = run => run.tracks.length > MANY;

// How far a body reaches to the right and upwards, in pixels; 0 if the mission does not have it.
function bodyOf(run, view, track, at) {
  const radius = (run.mission.body_radius_m ?? 0) * view.scaleAt(track, at);
  return run.stretch.map(factor => factor * radius);
}

// Where the pin's head is from its tip, [right, down] of length 1: above it, but neighbours lean
// apart, and away from the edges of the picture.
function leanOf({ x, y, r, track }, markers, view) {
  const near = 4 * r,
    edge = at => Math.max(0, 1 - at / near);
  let right = 3 * (edge(x) - edge(view.width - x)),
    down = 3 * (edge(y) - edge(view.height - y)) - 1;
  if (markers.length <= MOST_THAT_LEAN)
    for (const other of markers) {
      const dx = x - other.x,
        dy = y - other.y,
        apart = Math.hypot(dx, dy),
        push = 1.5 * (1 - apart / near);
      if (other.track === track || push <= 0) continue;
      const own = GOLDEN_ANGLE * track.id; // at one place each takes a direction of its own
      right += apart > 0.5 ? (push * dx) / apart : push * Math.cos(own);
      down += apart > 0.5 ? (push * dy) / apart : push * Math.sin(own);
    }
  const length = Math.hypot(right, down);
  return length > 1e-6 ? [right / length, down / length] : [0, -1];
}

// The markers of a row: {track, at: its row, x, y: its place, body, r: of the head, head, tip, hot}.
// `inside`: the number has room in the body, which needs no pin.
export function markersOf(run, view, { row, focus }) {
  const small = view.width < 500,
    size = many(run) ? (small ? 6 : 7) : small ? 8.5 : 9.5,
    markers = [];
  for (const track of run.tracks) {
    const at = track.rowAt(row);
    if (at < 0) continue;
    const [x, y] = view.at(track, at),
      hot = Boolean(focus?.(track.id)),
      r = size * (hot ? 1.25 : 1) * view.nearness(track, at);
    const body = bodyOf(run, view, track, at),
      least = Math.min(...body),
      inside = least > r;
    markers.push({ track, at, x, y, body, r, hot, inside, rim: inside ? 0 : least });
  }
  for (const marker of markers) {
    const { x, y, r, rim, inside } = marker,
      [right, down] = inside ? [0, 0] : leanOf(marker, markers, view),
      far = rim + REACH * r;
    Object.assign(marker, {
      tip: [x + right * rim, y + down * rim],
      head: [x + right * far, y + down * far],
    });
  }
  return markers;
}

function oval(g, x, y, [rx, ry]) {
  g.beginPath();
  if (rx === ry) {
    g.arc(x, y, rx, 0, 2 * Math.PI);
    return;
  }
  for (let i = 0; i < 48; i++)
    g.lineTo(x + rx * Math.cos((i * Math.PI) / 24), y + ry * Math.sin((i * Math.PI) / 24));
  g.closePath();
}

// Where an agent goes, in radians; null if it stands.
function headingOf(run, view, { track, at }) {
  const back = Math.max(track.first, at - Math.max(1, Math.round(1 / run.step))),
    ahead = Math.min(track.last, at + 1);
  const [x0, y0] = view.at(track, back),
    [x1, y1] = view.at(track, ahead),
    heading = Math.atan2(y1 - y0, x1 - x0);
  return (x0 !== x1 || y0 !== y1) && heading === heading ? heading : null;
}

function paintArrow(g, { x, y, r, body }, heading, colour, colours) {
  const from = Math.hypot(body[0] * Math.cos(heading), body[1] * Math.sin(heading)) + 2.5,
    long = 0.95 * r,
    wide = 0.45 * r;
  const at = (along, aside) => [
    x + Math.cos(heading) * along - Math.sin(heading) * aside,
    y + Math.sin(heading) * along + Math.cos(heading) * aside,
  ];
  g.beginPath();
  g.moveTo(...at(from + long, 0));
  g.lineTo(...at(from, wide));
  g.lineTo(...at(from + 0.25 * long, 0));
  g.lineTo(...at(from, -wide));
  g.closePath();
  g.fillStyle = colour;
  g.strokeStyle = colours.panel;
  g.lineWidth = 2;
  g.stroke();
  g.fill();
}

function paintPin(g, { head: [x, y], tip, r }) {
  const down = Math.atan2(tip[1] - y, tip[0] - x),
    half = Math.acos(1 / REACH);
  g.beginPath();
  g.arc(x, y, r, down + half, down - half + 2 * Math.PI);
  g.lineTo(...tip);
  g.closePath();
}

function paintNumber(g, { head: [x, y], track, r }, colour) {
  g.fillStyle = colour;
  g.font = `700 ${1.14 * r}px system-ui, sans-serif`;
  g.textAlign = 'center';
  g.textBaseline = 'middle';
  g.fillText(String(track.id), x, y + 0.5);
}

// How an agent looks: {fill, rim, ink, late, away}.
function looksOf(run, { track }, { t, colours }) {
  const { kind } = stateOf(run, track, t),
    away = kind === 'silent' || kind === 'gone',
    own = colours.agent(track.id);
  const rim = kind === 'gone' ? colours.gone : colours.bad;
  return {
    fill: away ? colours.panel : own,
    rim: away ? rim : colours.panel,
    ink: away ? rim : inkOn(own),
    late: kind === 'late',
    away,
  };
}

function paintBody(g, { x, y, body }, { fill, rim, away }) {
  if (Math.min(...body) < LEAST_BODY) return;
  oval(g, x, y, body);
  g.fillStyle = fill;
  g.strokeStyle = rim;
  g.lineWidth = 1;
  if (away) g.setLineDash([3, 2]);
  g.fill();
  g.stroke();
  g.setLineDash([]);
}

function paintHead(g, run, view, marker, looks, colours) {
  const heading = looks.away ? null : headingOf(run, view, marker),
    {
      head: [x, y],
      r,
      body,
      inside,
    } = marker;
  if (!inside) {
    paintPin(g, marker);
    g.fillStyle = looks.fill;
    g.strokeStyle = looks.rim;
    g.lineWidth = 1.5;
    if (looks.away) g.setLineDash([3, 2]);
    g.fill();
    g.stroke();
    g.setLineDash([]);
  }
  if (looks.late) {
    oval(g, x, y, inside ? body.map(v => v + 4) : [r + 3.5, r + 3.5]);
    g.strokeStyle = colours.warn;
    g.lineWidth = 2;
    g.stroke();
  }
  if (heading !== null) paintArrow(g, marker, heading, looks.fill, colours);
  paintNumber(g, marker, looks.ink);
}

// Bodies first, so that no pin hides one; those in focus last.
export function paintAgents(g, run, view, state, tracks) {
  const { colours, focus } = state,
    place = new Map(tracks.map((track, i) => [track, i]));
  const markers = markersOf(run, view, state).sort(
    (a, b) => a.hot - b.hot || place.get(a.track) - place.get(b.track),
  );
  const looks = markers.map(marker => looksOf(run, marker, state));
  for (const paint of [
    (marker, i) => paintBody(g, marker, looks[i]),
    (marker, i) => paintHead(g, run, view, marker, looks[i], colours),
  ]) {
    markers.forEach((marker, i) => {
      g.globalAlpha = focus && !marker.hot ? 0.35 : 1;
      paint(marker, i);
    });
  }
  g.globalAlpha = 1;
}
