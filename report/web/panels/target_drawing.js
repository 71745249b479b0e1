// SPDX-License-Identifier: BSD-3-Clause
// The control "New target": a target is drawn on the map and compared with the present one.
import { S } from './state.js';
import {
  MOST_PARTS,
  comparison,
  gridOf,
  isSound,
  modesOf,
  requestOf,
  seenFromAbove,
  textOf,
} from '../data/drawn.js';
import { $, put, readable, share } from '../text.js';

const isReady = () => S.drawing.parts.length > 0 && S.drawing.grid !== null;
const unsound = () => S.drawing.parts.find(part => !isSound(part));
const request = () => requestOf(S.drawing.parts, S.drawing.uniform, S.run.mission);

function describe() {
  const { run, drawing } = S;
  if (!isReady()) {
    const polygon = drawing.tool === 'polygon';
    put(
      $('drawnText'),
      drawing.open.length
        ? 'Click for each corner, and on the first one to close the polygon.'
        : unsound()
          ? 'A peak needs a height. The lower height of a polygon must be below its upper one.'
          : drawing.parts.length
            ? 'No part of this target is where agents can be.'
            : polygon
              ? 'Click where the polygon’s corners are.'
              : 'Press where the peak is, and drag to its spread.',
    );
    return;
  }
  const { against, present, moved } = comparison(run, run.rowAt(S.t), drawing.mu);
  put(
    $('drawnText'),
    `φ² of the coverage so far: ${readable(against)} against this target, ${readable(present)} against ` +
      `the present one. ${share(Math.round(moved * 100) / 100)} of the mass is elsewhere ` +
      'than in the present target.',
  );
}

function changed() {
  const { run, drawing } = S;
  const grid =
    drawing.parts.length && !unsound()
      ? gridOf(drawing.parts, drawing.uniform, run.size, run.mission.walls)
      : null;
  drawing.grid = grid && seenFromAbove(grid);
  if (grid) drawing.mu = modesOf(grid, run.mission.modes);
  for (const button of $('tool').children)
    button.setAttribute('aria-pressed', button.dataset.value === drawing.tool);
  put($('uniformText'), share(drawing.uniform));
}

export const targetDrawing = {
  name: 'New target',
  button: 'drawTarget',
  tools: 'targetTools',
  most: MOST_PARTS,
  label:
    'The new target. Enter adds a peak or a square, or closes a polygon, arrows move the chosen part, ' +
    'plus and minus change its size, C chooses a corner for the arrows, Delete removes it',
  begin() {
    $('uniform').value = 10;
    return { tool: 'peak', uniform: 0.1 };
  },
  changed,
  isReady,
  describe,
  order: () => ['target', { target: request() }],
  command: () =>
    `cat > target.textproto <<'END'\n${textOf(request())}END\n` +
    `ergocast amend --run-id ${S.facts.run} --target target.textproto`,
  newest: () => Math.max(-1, ...S.run.targets.map(target => target.number ?? -1)),
};

export function connectTarget(again) {
  $('tool').onclick = e => {
    if (!e.target.dataset.value) return;
    S.drawing.tool = e.target.dataset.value;
    S.drawing.open = [];
    again();
  };
  $('uniform').oninput = e => {
    S.drawing.uniform = Number(e.target.value) / 100;
    again();
  };
}
