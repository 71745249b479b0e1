// SPDX-License-Identifier: BSD-3-Clause
// Estimates from an agent's places how it moves.

const WINDOW_S = 1; // a point's single steps are noise
const ENOUGH = 16; // steps in which places are rounded: so far has to be from place to place
const COURSES_S = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600];
const TURN = ['UNICYCLE', 'FIXED_WING']; // they have a heading, also while they stand
const SHARE = 0.1; // of the domain's longest side: the course at full speed

// "POINT", or the vehicle of the agent's planned kind.
function vehicleOf(run, id) {
  const { vehicles } = run.mission;
  return vehicles ? (vehicles.find(kind => (id -= kind.count) < 0) ?? vehicles[0]).vehicle : 'POINT';
}

// For how many seconds the map draws courses.
export function courseSeconds({ mission }) {
  const wanted = (SHARE * Math.max(...(mission.box_m ?? mission.size_m))) / (mission.u_max_mps || 1),
    off = s => Math.abs(Math.log(s / wanted));
  return COURSES_S.reduce((best, s) => (off(s) < off(best) ? s : best));
}

const difference = (track, from, to, seconds) =>
  [track.p[2 * to] - track.p[2 * from], track.p[2 * to + 1] - track.p[2 * from + 1]]
    .concat(track.z ? [track.z[to] - track.z[from]] : [])
    .map(d => d / seconds);

// Rows between two places that are far enough apart to tell a direction, at most a window.
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

// Metres per second over the rows before this one; null: it stands, or nothing is known. A vehicle
// that cannot change its velocity at once is followed around its curve, to the row itself.
export function velocityAt(run, id, row) {
  const track = run.byId.get(id),
    window = Math.max(1, Math.round(WINDOW_S / run.step)),
    most = Math.min(window, row - track.first);
  if (most < 1 || !track.has(row) || run.heldAt(row)) return null;
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

// The unit vector along which the agent looks: that of its vehicle, or that of its velocity; null for a
// point that stands.
export function directionAt(run, id, row, velocity) {
  const { h } = run.byId.get(id);
  if (h && TURN.includes(vehicleOf(run, id)) && h[row] === h[row]) {
    const angle = (2 * Math.PI * h[row]) / 256;
    return [Math.cos(angle), Math.sin(angle)];
  }
  const speed = velocity ? Math.hypot(...velocity) : 0;
  return speed > 0 ? velocity.map(v => v / speed) : null;
}
