// SPDX-License-Identifier: BSD-3-Clause
// Paints the agents on the map: bodies to scale, courses, and pins with their numbers.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { inkOn } from '../colours.js';
import { stateOf } from '../data/agent_state.js';
import { paintBlockLines, paintBlockSigns } from './blocks.js';
import { commandOf, courseOf, paintCommand, paintCourse, paintNose } from './course.js';

const MANY = 12; // more agents than these are drawn smaller
const REACH = 2; // from the tip of a pin to the middle of its head, in radii of the head
const MOST_THAT_LEAN = 128; // agents: each looks at all others
const GOLDEN_ANGLE = 2.4; // radians: no multiples of it are near each other
const LEAST_BODY = 0.75; // pixels: a smaller body is not drawn
const RING_FILL = 0.16; // opacity
const LEAST_RING = 4; // pixels: a smaller ring is not told from a body

export const many = run => run.tracks.length > MANY;

// How far a body reaches to the right and upwards, in pixels; 0 if the mission does not have it.
function bodyOf(run, view, track, at) {
  const radius = (run.mission.body_radius_m ?? 0) * view.scaleAt(track, at);
  return view.stretchOf(run).map(factor => factor * radius);
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
// `inside`: the number has room in the body, which needs no pin. `ringed`: only the distance that it
// keeps is drawn. `outline`: what the nose has to be outside of.
export function markersOf(run, view, { row, focus, distance }) {
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
      inside = least > r,
      ringed = distance && least >= LEAST_RING && (focus ? hot : !many(run)),
      outline = inside && ringed ? [r, r] : body;
    markers.push({ track, at, x, y, body, r, hot, inside, ringed, outline, rim: inside ? 0 : least });
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

export function oval(g, x, y, [rx, ry]) {
  g.beginPath();
  if (rx === ry) {
    g.arc(x, y, rx, 0, 2 * Math.PI);
    return;
  }
  for (let i = 0; i < 48; i++)
    g.lineTo(x + rx * Math.cos((i * Math.PI) / 24), y + ry * Math.sin((i * Math.PI) / 24));
  g.closePath();
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

// How an agent looks: {fill, rim, ink, late, away, blocked}.
function looksOf(run, { track }, { t, colours }) {
  const { kind, blocked } = stateOf(run, track, t),
    away = kind === 'silent' || kind === 'gone',
    own = colours.agent(track.id);
  const rim = kind === 'gone' ? colours.gone : colours.bad;
  return {
    fill: away ? colours.panel : own,
    rim: away ? rim : colours.panel,
    ink: away ? rim : inkOn(own),
    late: kind === 'late',
    away,
    blocked,
  };
}

// A disc; or a ring, through which the map is seen.
function paintBody(g, { x, y, body, ringed }, { fill, rim, away }, colours) {
  if (Math.min(...body) < LEAST_BODY) return;
  const strength = g.globalAlpha,
    lines = ringed ? [[colours.panel, 4]] : [];
  lines.push(ringed ? [away ? rim : fill, 1.8] : [rim, 1]);
  oval(g, x, y, body);
  g.fillStyle = fill;
  g.globalAlpha = ringed ? RING_FILL * strength : strength;
  g.fill();
  g.globalAlpha = strength;
  if (away) g.setLineDash([3, 2]);
  for (const [stroke, width] of lines) {
    g.strokeStyle = stroke;
    g.lineWidth = width;
    g.stroke();
  }
  g.setLineDash([]);
}

// The number's ground: a pin, or in a ring a disc.
function paintGround(g, marker, looks) {
  if (marker.inside) oval(g, marker.x, marker.y, marker.outline);
  else paintPin(g, marker);
  g.fillStyle = looks.fill;
  g.strokeStyle = looks.rim;
  g.lineWidth = 1.5;
  if (looks.away) g.setLineDash([3, 2]);
  g.fill();
  g.stroke();
  g.setLineDash([]);
}

function paintHead(g, marker, looks, course, colours) {
  const {
    head: [x, y],
    r,
    body,
    inside,
    ringed,
  } = marker;
  if (!inside || ringed) paintGround(g, marker, looks);
  if (looks.late) {
    oval(g, x, y, inside ? body.map(v => v + 4) : [r + 3.5, r + 3.5]);
    g.strokeStyle = colours.warn;
    g.lineWidth = 2;
    g.stroke();
  }
  if (course) paintNose(g, marker, course, looks.fill, colours);
  paintNumber(g, marker, looks.ink);
}

// Bodies first, so that no pin hides one; those in focus last.
export function paintAgents(g, run, view, state, tracks) {
  const { colours, focus } = state,
    place = new Map(tracks.map((track, i) => [track, i]));
  const markers = markersOf(run, view, state).sort(
    (a, b) => a.hot - b.hot || place.get(a.track) - place.get(b.track),
  );
  const looks = markers.map(marker => looksOf(run, marker, state)),
    courses = markers.map((marker, i) => (looks[i].away ? null : courseOf(run, view, marker)));
  const each = paint => {
    markers.forEach((marker, i) => {
      g.globalAlpha = focus && !marker.hot ? 0.35 : 1;
      paint(marker, i);
    });
    g.globalAlpha = 1;
  };
  const blocks = markers.flatMap((marker, i) => (looks[i].blocked ? [{ marker, ...looks[i].blocked }] : []));
  each((marker, i) => paintBody(g, marker, looks[i], colours));
  const commands = markers.map((marker, i) =>
    looks[i].away || (many(run) && !marker.hot) ? null : commandOf(run, view, marker, state),
  );
  if (state.course) each((marker, i) => commands[i] && paintCommand(g, marker, commands[i], colours));
  if (state.course)
    each((marker, i) => courses[i] && paintCourse(g, marker, courses[i], looks[i].fill, colours));
  paintBlockLines(g, markers, blocks, colours);
  each((marker, i) => paintHead(g, marker, looks[i], courses[i], colours));
  paintBlockSigns(g, blocks, colours);
}
