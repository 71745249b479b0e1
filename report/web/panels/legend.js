// SPDX-License-Identifier: BSD-3-Clause
// Shows which shading, trail, axis, quantity and theme are chosen, and what their colours mean.
import { themeColours } from '../colours.js';
import { S, ask, inSpace, shown } from './state.js';
import { TAILS } from '../map/map.js';
import { rangeOf } from '../data/slices.js';
import { colourTeam } from './team.js';
import { redraw } from './screen.js';
import { $, put } from '../text.js';
import { meaningOf } from './words.js';

let written = -1; // the target for which the legend was written

// The end of the scale: it is that of the target that holds.
function fullAt(row) {
  return inSpace() ? rangeOf(S.run, S.run.targetAt(row)).full : shown().targetAt(row).density.full;
}

// Says which target holds, if it is no more the plan's.
function noteTarget({ number, from, known }) {
  const t = number === null ? 0 : S.run.counted(from * S.run.mission.dt_s);
  put(
    $('targetText'),
    `amendment ${number}: target since t = ${+t.toFixed(1)} s${known ? '' : ', not received'}`,
  );
  $('targetText').hidden = number === null;
}

// Follows the target that holds at the chosen time.
export function followTarget() {
  const { id } = S.run.targetAt(S.run.rowAt(S.t));
  if (id !== written) showLegend();
}

export function showLegend() {
  const difference = S.layer === 'difference',
    row = S.run?.rowAt(S.t) ?? 0,
    full = S.run ? fullAt(row) : 2,
    times = v => `${v.toFixed(v < 10 ? 1 : 0)}×`;
  const [low, high] = {
    difference: [`too little −${times(full / 2)}`, `+${times(full / 2)} too much`],
    missed: ['unlikely', 'may still be here'],
  }[S.layer] ?? ['0', `≥ ${times(full)} average`];
  put($('scaleLow'), low);
  put($('scaleHigh'), high);
  $('scale').title = meaningOf('MAP', S.layer === 'missed' ? 'Missed' : 'scale');
  if (S.run) {
    const target = S.run.targetAt(row);
    written = target.id;
    noteTarget(target);
  }
  const ramp = $('ramp'),
    g = ramp.getContext('2d'),
    image = g.createImageData(ramp.width, 1),
    pixels = new Uint32Array(image.data.buffer);
  const table = S.colours[difference ? 'difference' : 'amount'];
  pixels.forEach((_, i) => {
    pixels[i] = table[Math.floor((i / (pixels.length - 1)) * 255)];
  });
  g.putImageData(image, 0, 0);
  for (const [id, value] of [
    ['layer', S.layer],
    ['axis', S.axis],
  ]) {
    for (const button of $(id).children) button.setAttribute('aria-pressed', button.dataset.value === value);
  }
  $('guide').setAttribute('aria-pressed', S.guide);
  $('guide').hidden = S.quantity !== 'phi';
  $('quantity').value = S.quantity;
  $('quantity').title = meaningOf(
    'CHART',
    {
      phi: 'Ergodic metric φ²',
      found: 'Chance to have found an object [%]',
      spread: 'Disagreement on φ²',
      age: 'Oldest update',
      rate: 'Messages per second',
    }[S.quantity],
  );
  const seconds = TAILS[S.tail];
  put($('tailText'), seconds === Infinity ? 'all' : seconds ? `${seconds} s` : 'off');
  $('tail').value = S.tail;
}

export function set(key, value) {
  S[key] = value;
  showLegend();
  ask();
}

export function setTheme(theme) {
  document.documentElement.dataset.theme = S.theme = theme;
  S.colours = themeColours(theme);
  colourTeam();
  showLegend();
  redraw();
}
