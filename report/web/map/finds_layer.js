// SPDX-License-Identifier: BSD-3-Clause
// Paints where agents have found objects: a diamond each, and a label where no other one is.
import { readable } from '../text.js';

const RADIUS = 7,
  LINE = 14, // from one row of labels to the next
  ROWS = [0, 1, -1, 2, -2, 3, -3];

const overlap = (a, b) => a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h;

// The boxes of labels with the widths `widths` beside `places`, each of which is kept free, too: to the right
// or to the left, in the row that is nearest. If all are taken, it is beside its place.
export function labelBoxes(places, widths) {
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
    const box = tries.find(one => !taken.some(other => overlap(one, other))) ?? tries[0];
    taken.push(box);
    return box;
  });
}

export const labelOf = ({ object, t_s: t }) => `${object}: ${readable(t)} s`;

// Those that were found by a row, and where they are on the map.
export function findsAt(run, view, row) {
  const [left, bottom] = run.mission.origin_m,
    finds = run.finds.filter(({ tick }) => tick <= row * run.stride);
  return finds.map(find => ({
    find,
    at: [view.px(run.stretch[0] * (find.x_m - left)), view.py(run.stretch[1] * (find.y_m - bottom))],
  }));
}

export function paintFinds(g, run, view, { row, colours }) {
  const shown = findsAt(run, view, row);
  g.font = '600 11px system-ui, sans-serif';
  g.textAlign = 'left';
  g.textBaseline = 'middle';
  g.lineJoin = 'round';
  const boxes = labelBoxes(
    shown.map(({ at }) => at),
    shown.map(({ find }) => g.measureText(labelOf(find)).width),
  );
  shown.forEach(({ find, at: [right, down] }, i) => {
    const { x, y, w, h } = boxes[i];
    g.fillStyle = colours.panel;
    g.globalAlpha = 0.7;
    g.fillRect(x - 2, y, w + 4, h);
    g.globalAlpha = 1;
    g.beginPath();
    for (const [dx, dy] of [
      [0, -RADIUS],
      [RADIUS, 0],
      [0, RADIUS],
      [-RADIUS, 0],
    ])
      g.lineTo(right + dx, down + dy);
    g.closePath();
    g.fillStyle = colours.ink;
    g.strokeStyle = colours.panel;
    g.lineWidth = 3;
    g.stroke();
    g.fill();
    g.fillText(labelOf(find), x, y + h / 2);
  });
}
