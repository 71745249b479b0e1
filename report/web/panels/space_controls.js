// SPDX-License-Identifier: BSD-3-Clause
// Offers the views of a box, and one slider for each slice.
import { S, ask, inSpace } from './state.js';
import { showLegend } from './legend.js';
import { nameOf } from '../data/places.js';
import { canTurn, layout } from './screen.js';
import { rangeOf } from '../data/slices.js';
import { $, element, put } from '../text.js';

const VIEWS = ['turn', 'xy', 'xz', 'yz'];
const NO_SPACE =
  'This browser offers no WebGL 2, so the box cannot be turned; xy, xz and yz show it along its axes.';

let begun = false; // whether a box was shown before
let controls = []; // of each axis: {box, slider, text}
let last = [0.5, 0.5, 0.5]; // where a slice was when it was taken away

export function connectSpace() {
  $('view').onclick = e => e.target.dataset.value && showView(e.target.dataset.value);
  controls = [0, 1, 2].map(axis => {
    const label = element('label'),
      box = element('input'),
      slider = element('input'),
      text = element('output');
    Object.assign(box, { type: 'checkbox', onchange: () => toggleSlice(axis) });
    Object.assign(slider, {
      type: 'range',
      min: 0,
      max: 1,
      step: 0.005,
      oninput: () => moveSlice(axis, Number(slider.value)),
    });
    slider.setAttribute('aria-label', `Slice across ${nameOf(axis)}`);
    label.append(box, nameOf(axis));
    label.title = `A slice across ${nameOf(axis)} (${nameOf(axis).toUpperCase()})`;
    $('slices').append(label, slider, text);
    return { box, slider, text };
  });
  $('space').addEventListener('webglcontextlost', () => showView('xy'));
}

function showSlices() {
  $('slices').hidden = !inSpace();
  if (!S.run.inBox) return;
  const { origin_m: origin, size_m: size } = S.run.mission;
  controls.forEach(({ box, slider, text }, axis) => {
    const share = S.slices[axis];
    box.checked = share !== null;
    slider.value = share ?? last[axis];
    slider.disabled = share === null;
    put(text, share === null ? 'off' : `${+(origin[axis] + share * size[axis]).toPrecision(4)} m`);
  });
}

export function moveSlice(axis, share) {
  S.slices[axis] = share;
  showSlices();
  ask();
}

export function toggleSlice(axis) {
  if (!inSpace()) return;
  if (S.slices[axis] !== null) last = last.with(axis, S.slices[axis]);
  moveSlice(axis, S.slices[axis] === null ? last[axis] : null);
}

export function showView(name) {
  if (!S.run.inBox || !VIEWS.includes(name)) return;
  const can = canTurn();
  S.view = name === 'turn' && !can ? 'xy' : name;
  $('view').children[0].disabled = !can;
  put($('noSpace'), NO_SPACE);
  $('noSpace').hidden = can;
  $('space').hidden = !inSpace();
  for (const id of ['shading', 'trails']) $(id).hidden = inSpace();
  for (const button of $('view').children)
    button.setAttribute('aria-pressed', button.dataset.value === S.view);
  showSlices();
  showLegend();
  layout();
}

export function nextView() {
  if (S.run.inBox)
    showView(VIEWS[(VIEWS.indexOf(S.view) + (S.view === 'yz' && !canTurn() ? 2 : 1)) % VIEWS.length]);
}

// Before a run is shown: slices through the densest place of its target.
export function beginSpace(run) {
  $('view').hidden = !run.inBox;
  document.body.classList.toggle('box', run.inBox);
  if (!run.inBox) {
    S.view = 'xy';
    return;
  }
  if (!begun) S.slices = [...(last = rangeOf(run, run.targetAt(0)).densest)];
  showView(begun ? S.view : 'turn');
  begun = true;
}
