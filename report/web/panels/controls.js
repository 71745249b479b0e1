// SPDX-License-Identifier: BSD-3-Clause
// Connects buttons, keys and the chart's pointer with what the page shows.
import { S, SPEEDS, LAYERS, ask } from './state.js';
import { TAILS } from '../map/map.js';
import { QUANTITIES, scalesOf } from './chart.js';
import { faster, follow, jump, seek, setPlaying, step } from './timeline.js';
import { pin } from './team.js';
import { showDetails } from './details.js';
import { connectDialogs, openDialog, openDialogOf, placeMenu } from './dialogs.js';
import { savePng, saveSvg, saveVideo } from './save.js';
import { set, setTheme } from './legend.js';
import { fit, turn, zoom } from './map_pointer.js';
import { nextView, toggleSlice } from './space_controls.js';
import { view } from './screen.js';
import { $, isTyped } from '../text.js';
import { explainLabels, listWords } from './words.js';

const toggle = (dialog, open) => {
  if (!dialog.open) open();
};
const showHelp = () =>
  S.run &&
  toggle($('keys'), () => {
    listWords();
    openDialog($('keys'));
  });
const openDetails = () => S.run && toggle($('details'), showDetails);
const closeMenu = () => {
  $('saveMenu').hidden = true;
  $('saveButton').setAttribute('aria-expanded', 'false');
};

export function connectButtons() {
  explainLabels();
  for (const [value, { title }] of Object.entries(QUANTITIES)) $('quantity').append(new Option(title, value));
  for (const speed of SPEEDS)
    $('speed').append(new Option(`${speed}×`, speed, speed === S.speed, speed === S.speed));
  $('quantity').onchange = e => set('quantity', e.target.value);
  $('speed').onchange = e => {
    S.speed = Number(e.target.value);
  };
  $('play').onclick = () => setPlaying(!S.playing);
  $('back').onclick = () => step(-1);
  $('on').onclick = () => step(1);
  $('follow').onclick = follow;
  $('slider').oninput = e => seek(e.target.value * S.run.step);
  $('tail').oninput = e => set('tail', Number(e.target.value));
  $('layer').onclick = e => e.target.dataset.value && set('layer', e.target.dataset.value);
  $('axis').onclick = e => e.target.dataset.value && set('axis', e.target.dataset.value);
  $('guide').onclick = () => set('guide', !S.guide);
  for (const key of ['radio', 'course', 'distance']) {
    $(key).checked = S[key];
    $(key).onchange = e => set(key, e.target.checked);
  }
  $('theme').onclick = () => setTheme(S.theme === 'dark' ? 'light' : 'dark');
  $('help').onclick = showHelp;
  $('detailsButton').onclick = openDetails;
  $('showAll').onclick = () => pin(-1);
  $('fit').onclick = fit;
  $('saveButton').onclick = () => {
    placeMenu($('saveMenu'), $('saveButton'));
    $('saveMenu').hidden = !$('saveMenu').hidden;
    $('saveButton').setAttribute('aria-expanded', !$('saveMenu').hidden);
  };
  for (const [id, action] of [
    ['savePng', savePng],
    ['saveSvg', () => saveSvg(view)],
    ['saveVideo', saveVideo],
  ]) {
    $(id).onclick = () => {
      action();
      if (id !== 'saveVideo') closeMenu();
    };
  }
  addEventListener('pointerdown', e => {
    if (!e.target.closest('.menu')) closeMenu();
  });
  connectDialogs();
}

export function connectChart() {
  const chart = $('chart'),
    timeAt = e => scalesOf(S.run, S, chart.clientWidth, chart.clientHeight).at(e.offsetX);
  chart.onpointermove = e => {
    S.pointer = timeAt(e);
    if (e.buttons) seek(S.pointer);
    ask();
  };
  chart.onpointerleave = () => {
    S.pointer = -1;
    ask();
  };
  chart.onpointerdown = e => {
    chart.setPointerCapture(e.pointerId);
    seek(timeAt(e));
  };
}

const next = (list, value) => list[(list.indexOf(value) + 1) % list.length];
const TURN = Math.PI / 24;
const KEYS = {
  ' ': () => setPlaying(!S.playing),
  ArrowLeft: e => step(-1, e.shiftKey),
  ArrowRight: e => step(1, e.shiftKey),
  Home: () => seek(0),
  End: () => seek(S.run.end),
  '<': () => faster(-1),
  ',': () => faster(-1),
  '>': () => faster(1),
  '.': () => faster(1),
  '[': () => jump(-1),
  ']': () => jump(1),
  c: () => set('layer', next(LAYERS, S.layer)),
  t: () => set('tail', (S.tail + 1) % TAILS.length),
  d: () => $('theme').click(),
  s: savePng,
  i: openDetails,
  l: () => S.live && follow(),
  '+': () => zoom(1.4),
  '=': () => zoom(1.4),
  '-': () => zoom(1 / 1.4),
  0: fit,
  v: nextView,
  q: () => turn(-TURN, 0),
  e: () => turn(TURN, 0),
  r: () => turn(0, TURN),
  f: () => turn(0, -TURN),
  x: () => toggleSlice(0),
  y: () => toggleSlice(1),
  z: () => toggleSlice(2),
  Escape: () => {
    closeMenu();
    pin(-1);
  },
  '?': showHelp,
};

// Whether a dialog is open, to which all keys belong.
function closesDialog({ key }) {
  const dialog = openDialogOf();
  if (dialog && key === 'Escape') dialog.close();
  return Boolean(dialog);
}

export function connectKeys() {
  addEventListener('keydown', e => {
    if (
      !S.run ||
      e.ctrlKey ||
      e.metaKey ||
      e.altKey ||
      closesDialog(e) ||
      e.target.tagName === 'SELECT' ||
      isTyped(e.target)
    )
      return;
    const action = KEYS[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    const own =
      (e.key === ' ' && ['BUTTON', 'INPUT'].includes(e.target.tagName) && e.target.type !== 'range') ||
      (e.target.type === 'range' && e.target.id !== 'slider' && e.key.startsWith('Arrow'));
    if (!action || own) return;
    e.preventDefault();
    action(e);
  });
}
