// SPDX-License-Identifier: BSD-3-Clause
// Computes with zones: which agents are inside, how far they have to go, and how long a zone lasts.
// Places are in metres from the domain's corner.
import { inside, placing } from './drawn.js';
import { coordinate } from './places.js';
import { duration } from '../text.js';

export const MOST_CORNERS = 64;

const side = ([ax, ay], [bx, by], [cx, cy]) => Math.sign((bx - ax) * (cy - ay) - (by - ay) * (cx - ax));

function between([ax, ay], [bx, by], [cx, cy]) {
  return cx >= Math.min(ax, bx) && cx <= Math.max(ax, bx) && cy >= Math.min(ay, by) && cy <= Math.max(ay, by);
}

function touch(a, b, c, d) {
  const [s, t, u, v] = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
  if (s !== t && u !== v) return true;
  return [
    [s, a, b, c],
    [t, a, b, d],
    [u, c, d, a],
    [v, c, d, b],
  ].some(([turn, from, to, at]) => turn === 0 && between(from, to, at));
}

// Whether edges of a ring touch that are not neighbours.
export function crosses(ring) {
  const next = i => ring[(i + 1) % ring.length];
  for (let i = 0; i < ring.length; i++)
    for (let k = i + 2; k < ring.length; k++)
      if ((k + 1) % ring.length !== i && touch(ring[i], next(i), ring[k], next(k))) return true;
  return false;
}

// The part of an edge inside the domain, as shares of its length; null if none is. An edge on the domain's
// own edge is not inside: nothing can leave there.
function partInside([ax, ay], [bx, by], [lx, ly]) {
  const least = 1e-6 * Math.max(lx, ly);
  let from = 0,
    to = 1;
  for (const [a, d, l] of [
    [ax, bx - ax, lx],
    [ay, by - ay, ly],
  ]) {
    if (d === 0) {
      if (a <= least || a >= l - least) return null;
      continue;
    }
    const ends = [(least - a) / d, (l - least - a) / d].sort((p, q) => p - q);
    from = Math.max(from, ends[0]);
    to = Math.min(to, ends[1]);
  }
  return from < to ? [from, to] : null;
}

// How far it is from a place to the ring's nearest edge in the domain; Infinity if no edge is there.
function toNearestEdge(ring, size, [x, y]) {
  let least = Infinity;
  ring.forEach((from, i) => {
    const to = ring[(i + 1) % ring.length],
      part = partInside(from, to, size);
    if (!part) return;
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]],
      along = ((x - from[0]) * dx + (y - from[1]) * dy) / (dx * dx + dy * dy),
      share = Math.min(part[1], Math.max(part[0], along));
    least = Math.min(least, Math.hypot(from[0] + share * dx - x, from[1] + share * dy - y));
  });
  return least;
}

// The agents that are inside at a row, the one with the longest way out first: {id, metres}. A vehicle goes
// at least as far; walls, other zones and its own size make its way longer. An agent that keeps to an edge
// may seem to be inside, because the page's places are rounded: it does not count.
export function insideAt(run, row, corners, heights) {
  const found = [],
    { size_m: size } = run.mission,
    whole = run.inBox ? size[2] : 0,
    rounding = Math.max(...run.steps);
  for (const track of run.tracks) {
    const at = track.rowAt(row);
    if (at < 0 || !track.isMember(row)) continue;
    const place = [0, 1].map(axis => coordinate(track, axis, at));
    if (!inside([corners], ...place)) continue;
    let metres = toNearestEdge(corners, size, place);
    if (run.inBox) {
      const z = coordinate(track, 2, at),
        [low, high] = heights;
      if (z < low || z > high) continue;
      if (low > 0) metres = Math.min(metres, z - low);
      if (high < whole) metres = Math.min(metres, high - z);
    }
    if (metres > rounding) found.push({ id: track.id, metres });
  }
  return found.sort((a, b) => b.metres - a.metres);
}

const wholeSeconds = s => (s < 120 ? `${Math.ceil(s - 1e-6)} s` : duration(s));

// A closed zone at a row: whether agents still may leave it, how long that lasts or the zone itself, and how
// many agents are inside.
export function stateOfZone(run, { number, from, until, corners_m: corners, heights_m: heights }, row) {
  const tick = row * run.stride,
    leaving = tick < from,
    left = wholeSeconds(((leaving ? Math.min(from, until) : until) - tick) * run.mission.dt_s),
    count = insideAt(run, row, corners, heights ?? [0, Infinity]).length;
  const words = leaving ? `agents leave within ${left}` : `closed, ${left} left`;
  return {
    number,
    leaving,
    left,
    count,
    text: `zone ${number}: ${words}${count ? `, ${count} inside` : ''}`,
  };
}

// What the page sends: {corners_m, lasts_s} and in a box heights_m, in the scenario's coordinates.
export function zoneRequestOf({ corners, heights }, lasts_s, mission) {
  const { placed, height } = placing(mission),
    request = { corners_m: corners.map(placed), lasts_s };
  return heights ? { ...request, heights_m: heights.map(height) } : request;
}

// The same as the text of a zone's file.
export function zoneTextOf({ corners_m: corners, heights_m: heights }) {
  const lines = corners.map(([x, y]) => `vertices { x_m: ${x}  y_m: ${y} }\n`);
  if (heights) lines.push(`low_z_m: ${heights[0]}\nhigh_z_m: ${heights[1]}\n`);
  return lines.join('');
}
