// SPDX-License-Identifier: BSD-3-Clause
// Estimates an agent's velocity and direction from its recorded places.

const WINDOW_S = 1; // single steps of a point are mostly noise
const ENOUGH = 16; // least distance between two places that give a direction, in rounding steps
const COURSES_S = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600];
const TURN = ['UNICYCLE', 'FIXED_WING']; // vehicles with a heading, even at standstill
const SHARE = 0.1; // length of a course at full speed, in the domain's longest side

// The vehicle of the agent's kind; "POINT" if the mission has no other vehicles.
export function vehicleOf(run, id) {
  const { vehicles } = run.mission;
  return vehicles ? (vehicles.find(kind => (id -= kind.count) < 0) ?? vehicles[0]).vehicle : 'POINT';
}

// How many seconds ahead the map draws courses.
export function courseSeconds({ mission }) {
  const wanted = (SHARE * Math.max(...(mission.box_m ?? mission.size_m))) / (mission.u_max_mps || 1),
    off = s => Math.abs(Math.log(s / wanted));
  return COURSES_S.reduce((best, s) => (off(s) < off(best) ? s : best));
}

const difference = (track, from, to, seconds) =>
  [track.p[2 * to] - track.p[2 * from], track.p[2 * to + 1] - track.p[2 * from + 1]]
    .concat(track.z ? [track.z[to] - track.z[from]] : [])
    .map(d => d / seconds);

// The number of rows back to a place that is far enough away to give a direction; at most `most`.
function spanOf(run, track, row, most) {
  let n = 1;
  while (
    n < most &&
    track.has(row - n - 1) &&
    difference(track, row - n, row, 1).every((d, axis) => Math.abs(d) < ENOUGH * run.steps[axis])
  )
    n++;
  return n;
}

// The velocity in m/s; null: the agent stands, or nothing is known. For a point it is the mean over
// the rows before this one. Other vehicles change their velocity gradually, so theirs is estimated at
// the row itself.
export function velocityAt(run, id, row) {
  const track = run.byId.get(id),
    window = Math.max(1, Math.round(WINDOW_S / run.step)),
    most = Math.min(window, row - track.first);
  if (most < 1 || !track.has(row) || run.standsAt(id, row)) return null;
  if (run.heldAt(row) && !run.movesInPause(id, row)) return null;
  const smooth = vehicleOf(run, id) !== 'POINT',
    n = smooth ? spanOf(run, track, row, most) : most,
    seconds = n * run.step;
  if (!track.has(row - n)) return null;
  const now = difference(track, row - n, row, seconds);
  if (now.every((v, axis) => Math.abs(v) * seconds < 1.5 * run.steps[axis])) return null;
  if (!smooth) return now;
  if (track.has(row + n)) return difference(track, row - n, row + n, 2 * seconds);
  if (!track.has(row - 2 * n)) return now;
  const before = difference(track, row - 2 * n, row - n, seconds);
  return now.map((v, axis) => v + (v - before[axis]) / 2);
}

// The unit vector of the agent's heading or, if its vehicle has none, of its velocity. Null if it
// has neither.
export function directionAt(run, id, row, velocity) {
  const { h } = run.byId.get(id);
  if (h && TURN.includes(vehicleOf(run, id)) && h[row] === h[row]) {
    const angle = (2 * Math.PI * h[row]) / 256;
    return [Math.cos(angle), Math.sin(angle)];
  }
  const speed = velocity ? Math.hypot(...velocity) : 0;
  return speed > 0 ? velocity.map(v => v / speed) : null;
}
