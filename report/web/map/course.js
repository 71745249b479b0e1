// SPDX-License-Identifier: BSD-3-Clause
// Paints an agent's direction, and its course: the line to the place that it reaches in the next seconds.
// It draws on a canvas, or on anything with the same methods (svg.js).
import { courseSeconds, directionAt, velocityAt } from '../data/motion.js';

const HEAD = 5; // pixels
const GAP = 2.5; // pixels between an agent and its nose, the arrowhead that shows its direction
const LEAST = 0.01; // pixels: a shorter course is seen end on, and has no direction

// {heading: radians on the screen, end: the place at the course's end, long: pixels to that place}; null
// if the agent has no direction.
export function courseOf(run, view, { track, at, x, y }) {
  const velocity = velocityAt(run, track.id, at),
    direction = directionAt(run, track.id, at, velocity);
  if (!direction) return null;
  // A vehicle with a heading moves along it.
  const speed = velocity ? Math.hypot(...velocity) : 0,
    seconds = courseSeconds(run),
    end = view.later(run, track, at, direction, speed * seconds),
    ahead = speed > 0 ? end : view.later(run, track, at, direction, 1);
  if (Math.hypot(ahead[0] - x, ahead[1] - y) < LEAST) return null;
  return { heading: Math.atan2(ahead[1] - y, ahead[0] - x), end, long: Math.hypot(end[0] - x, end[1] - y) };
}

// The place to which what the agent commands would lead in the time of a course; null if it commands to
// stand, or its command is not known.
export function commandOf(run, view, { track, at, x, y }, { commands, inSpace }) {
  const all = commands?.[track.id],
    seen = inSpace ? all : all && run.axes.map((axis, i) => all[axis] * run.stretch[i]),
    speed = seen ? Math.hypot(...seen) : 0;
  if (!(speed > 0)) return null;
  const direction = seen.map(v => v / speed),
    end = view.later(run, track, at, direction, speed * courseSeconds(run)),
    long = Math.hypot(end[0] - x, end[1] - y);
  return long < LEAST ? null : { heading: Math.atan2(end[1] - y, end[0] - x), end, long };
}

// Paints a dashed line with an open head, wider than a course, which may lie on it.
export function paintCommand(g, marker, command, colours) {
  const at = placeOn(marker, command),
    { long } = command;
  if (long < 2 * HEAD) return;
  const head = () => {
    g.moveTo(...at(long - 1.6 * HEAD, HEAD));
    g.lineTo(...at(long, 0));
    g.lineTo(...at(long - 1.6 * HEAD, -HEAD));
  };
  g.lineJoin = 'round';
  for (const [stroke, width] of [
    [colours.panel, 4],
    [colours.ink, 1.6],
  ]) {
    g.strokeStyle = stroke;
    g.lineWidth = width;
    g.setLineDash([5, 4]);
    g.beginPath();
    g.moveTo(...at(0, 0));
    g.lineTo(...at(long, 0));
    g.stroke();
    g.setLineDash([]);
    g.beginPath();
    head();
    g.stroke();
  }
}

// Where the nose begins and ends on the course, in pixels from the agent's place.
function noseOf({ r, outline }, { heading }) {
  const from = Math.hypot(outline[0] * Math.cos(heading), outline[1] * Math.sin(heading)) + GAP;
  return [from, from + 0.95 * r];
}

const placeOn =
  ({ x, y }, { heading }) =>
  (along, aside) => [
    x + Math.cos(heading) * along - Math.sin(heading) * aside,
    y + Math.sin(heading) * along + Math.cos(heading) * aside,
  ];

export function paintNose(g, marker, course, colour, colours) {
  const [from, to] = noseOf(marker, course),
    at = placeOn(marker, course),
    wide = 0.45 * marker.r;
  g.beginPath();
  g.moveTo(...at(to, 0));
  g.lineTo(...at(from, wide));
  g.lineTo(...at(from + 0.25 * (to - from), 0));
  g.lineTo(...at(from, -wide));
  g.closePath();
  g.fillStyle = colour;
  g.strokeStyle = colours.panel;
  g.lineWidth = 2;
  g.stroke();
  g.fill();
}

// Paints the line from the nose to the course's end. A course that ends near the nose gets no line.
export function paintCourse(g, marker, course, colour, colours) {
  const [, from] = noseOf(marker, course),
    at = placeOn(marker, course),
    { long } = course;
  if (long < from + HEAD) return;
  g.lineJoin = 'round';
  for (const [stroke, width] of [
    [colours.panel, 3.6],
    [colour, 1.4],
  ]) {
    g.strokeStyle = stroke;
    g.lineWidth = width;
    g.beginPath();
    g.moveTo(...at(from, 0));
    g.lineTo(...at(long, 0));
    g.moveTo(...at(long - HEAD, 0.6 * HEAD));
    g.lineTo(...at(long, 0));
    g.lineTo(...at(long - HEAD, -0.6 * HEAD));
    g.stroke();
  }
}
