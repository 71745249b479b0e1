// SPDX-License-Identifier: BSD-3-Clause
// Paints where agents have found objects, and contacts: a sign each, and a label where no other one is.
import { chance, clamp, readable } from '../text.js';

const RADIUS = 7,
  LINE = 14, // from one row of labels to the next
  ROWS = [0, 1, -1, 2, -2, 3, -3];

const overlap = (a, b) => a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h;

// The boxes of labels with the widths `widths` beside `places`, each of which is kept free, too: to the right
// or to the left, in the row that is nearest, on a picture of width `right`. If all are taken, it is beside
// its place.
export function labelBoxes(places, widths, right = Infinity) {
  const taken = places.map(([x, y]) => ({ x: x - RADIUS, y: y - RADIUS, w: 2 * RADIUS, h: 2 * RADIUS }));
  return places.map(([x, y], i) => {
    const w = widths[i],
      tries = ROWS.flatMap(row =>
        [x + RADIUS + 4, x - RADIUS - 4 - w].map(left => ({
          x: left,
          y: y + row * LINE - LINE / 2,
          w,
          h: LINE,
        })),
      );
    const seen = tries.filter(one => one.x >= 0 && one.x + w <= right),
      box = seen.find(one => !taken.some(other => overlap(one, other))) ?? seen[0] ?? tries[0];
    taken.push(box);
    return box;
  });
}

export const labelOf = ({ object, t_s: t }) => `${object}: ${readable(t)} s`;

// Corners of the signs, from their place.
const DIAMOND = [
    [0, -RADIUS],
    [RADIUS, 0],
    [0, RADIUS],
    [-RADIUS, 0],
  ],
  TRIANGLE = [
    [0, -RADIUS - 2],
    [RADIUS + 1, RADIUS - 2],
    [-RADIUS - 1, RADIUS - 2],
  ];

function placeOf(run, view, { x_m: x, y_m: y }) {
  const [left, bottom] = run.mission.origin_m;
  return [view.px(run.stretch[0] * (x - left)), view.py(run.stretch[1] * (y - bottom))];
}

// The finds up to a row.
function findsAt(run, view, row) {
  return run.finds
    .filter(({ tick }) => tick <= row * run.stride)
    .map(find => ({
      at: placeOf(run, view, find),
      corners: DIAMOND,
      label: labelOf(find),
      filled: true,
      strength: 1,
    }));
}

// The contacts from their newest report on, the likeliest first. What the page knows of them is the newest
// list, so that an earlier row has no others.
function contactsAt(run, view, row) {
  const now = row * run.step + run.mission.dt_s / 2;
  return run.contacts
    .filter(one => isFinite(one.x_m) && isFinite(one.y_m) && one.t_s <= now)
    .map(contact => ({
      at: placeOf(run, view, contact),
      corners: TRIANGLE,
      label: chance(contact.probability),
      filled: Boolean(contact.confirmed),
      strength: 0.4 + 0.6 * Math.sqrt(clamp(Number(contact.probability) || 0, 0, 1)),
    }));
}

// Finds and contacts of a row: {at: place on the map, corners, label, filled, strength}. Unlikely contacts
// are faint.
export const signsAt = (run, view, row) => [...findsAt(run, view, row), ...contactsAt(run, view, row)];

function paintSign(g, { at: [right, down], corners, filled }, colours) {
  g.beginPath();
  for (const [dx, dy] of corners) g.lineTo(right + dx, down + dy);
  g.closePath();
  g.strokeStyle = colours.panel;
  g.lineWidth = filled ? 3 : 5;
  g.stroke();
  g.fillStyle = filled ? colours.ink : colours.panel;
  g.fill();
  if (filled) return;
  g.strokeStyle = colours.ink;
  g.lineWidth = 2;
  g.stroke();
}

// Finds are painted last, over the contacts that were confirmed there.
export function paintFinds(g, run, view, { row, colours }) {
  const shown = signsAt(run, view, row);
  g.font = '600 11px system-ui, sans-serif';
  g.textAlign = 'left';
  g.textBaseline = 'middle';
  g.lineJoin = 'round';
  const boxes = labelBoxes(
    shown.map(({ at }) => at),
    shown.map(({ label }) => g.measureText(label).width),
    view.width,
  );
  shown.reverse();
  boxes.reverse();
  shown.forEach((sign, i) => {
    const { x, y, w, h } = boxes[i];
    g.fillStyle = colours.panel;
    g.globalAlpha = 0.7 * sign.strength;
    g.fillRect(x - 2, y, w + 4, h);
    g.globalAlpha = sign.strength;
    paintSign(g, sign, colours);
    g.fillStyle = colours.ink;
    g.fillText(sign.label, x, y + h / 2);
  });
  g.globalAlpha = 1;
}
