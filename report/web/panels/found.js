// SPDX-License-Identifier: BSD-3-Clause
// Puts into words what the team has found, and what it may have missed.
import { chance, readable } from '../text.js';

// How many of the hidden objects the team has found by a row; nothing: the mission has none.
export function findsText(run, row = Infinity) {
  const { objects } = run.mission;
  if (!(objects > 0)) return undefined;
  const found = run.finds.filter(({ tick }) => tick <= row * run.stride);
  const wrong = run.wrong > 0 ? `, and ${run.wrong} confirmed where none is` : '';
  return `${found.length} of ${objects}${wrong}`;
}

// At the end, by a summary, which may say anything.
export function foundBy(summary) {
  const probability = summary?.detection?.probability;
  return typeof probability === 'number' ? chance(probability) : undefined;
}

// Those of a running team at the newest time: [label, text] of each figure that is known.
export function foundFacts(run) {
  const probability = run.foundAt(run.end);
  if (!isFinite(probability)) return [];
  const [half, fourFifths] = run.foundCurve.detection.times;
  return [
    ['chance to have found an object', chance(probability)],
    ...(half === null ? [] : [['50 % chance after [s]', readable(half)]]),
    ...(fourFifths === null ? [] : [['80 % chance after [s]', readable(fourFifths)]]),
  ];
}

// How much was missed at a place of the map; nothing where the map is a view of a box, and as long as looks
// are counted.
export function missedText(run, row, x, y) {
  const { detection } = run;
  return run.inBox || !detection.build(row, 0) ? '' : ` · missed ${chance(detection.missedAt(row, x, y))}`;
}
