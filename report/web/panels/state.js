// SPDX-License-Identifier: BSD-3-Clause
// Holds what the page of a run shows now. Code that changes it asks for a frame.
import { TAILS } from '../map/map.js';
import { projected } from '../data/projection.js';

export const SPEEDS = [0.5, 1, 2, 5, 10, 20, 50, 100];
export const LAYERS = ['target', 'achieved', 'difference', 'missed'];

export const S = {
  run: null,
  t: 0, // mission time that is shown
  live: false, // whether the mission still grows
  facts: null, // of a running team: what live.js knows of it
  following: false, // whether t is the newest time
  playing: false,
  speed: 20,
  tail: 3,
  layer: 'target',
  view: 'xy', // of a box: 'turn', or the axes of a projection
  slices: [null, null, null], // of the view that turns, across x, y and z: shares of the box, null for none
  axis: 'log',
  quantity: 'phi',
  guide: true,
  radio: true,
  course: true,
  distance: true,
  hover: -1, // the agent under the pointer
  pins: new Set(), // agents that were chosen
  pointer: -1, // time under the pointer in the chart
  drawing: null, // the new target or zone that is being drawn (drawing.js)
  theme: 'light',
  colours: null,
};

// Which agents are in focus; null: all alike.
export const focusOf = () => (S.hover >= 0 || S.pins.size ? id => id === S.hover || S.pins.has(id) : null);

// What the map shows: the run, or in a box the run as it is seen along an axis.
export const inSpace = () => S.run.inBox && S.view === 'turn';
export const shown = () => (S.run.inBox && !inSpace() ? projected(S.run, S.view) : S.run);

// The part of it that map.js needs.
export const mapState = () => ({
  row: S.run.rowAt(S.t),
  t: S.t,
  tail: S.tail,
  layer: S.layer,
  radio: S.radio,
  course: S.course,
  distance: S.distance,
  colours: S.colours,
  focus: focusOf(),
  inSpace: inSpace(),
  slices: S.slices,
  // What each agent commands now, by its number; of a time before, it is not known.
  commands: (S.live && S.following && S.facts?.state?.commands_mps) || null,
});

export const startTail = run => (run.tracks.length > 12 ? TAILS.indexOf(60) : TAILS.length - 1);

let paint = null,
  asked = false;
export function onFrame(callback) {
  paint = callback;
}
export function ask() {
  if (asked || !paint) return;
  asked = true;
  requestAnimationFrame(now => {
    asked = false;
    paint(now);
  });
}
