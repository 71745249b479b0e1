// SPDX-License-Identifier: BSD-3-Clause
// Opens the layer on which a new target or a new zone is drawn, and sends or copies what is drawn there.
import { S, ask } from './state.js';
import { layout } from './screen.js';
import { isObeyed } from './control.js';
import { complain } from './control_text.js';
import { press } from './presses.js';
import { give, hasControl } from './requests.js';
import { copyCommand, offerCommand } from './command.js';
import { connectDrawnPointer, removeChosen } from './drawn_pointer.js';
import { showView } from './space_controls.js';
import { connectTarget, targetDrawing } from './target_drawing.js';
import { connectZone, zoneDrawing } from './zone_drawing.js';
import { MOST_BYTES } from '../data/drawn.js';
import { $, put } from '../text.js';

const KINDS = { target: targetDrawing, zone: zoneDrawing };
const DESCRIBE_MS = 250; // wall time between descriptions while the team moves on

let sent = null, // {number, newest}: the request, and the newest that the page knew when it was sent
  describedAt = 0,
  viewBefore = null; // of a box

const kind = () => KINDS[S.drawing.kind];

// With control the drawing can be sent; without, the command is shown.
function offer() {
  const ready = kind().isReady(),
    may = hasControl();
  $('sendDrawn').hidden = !may;
  $('sendDrawn').disabled = !ready;
  $('commandBox').hidden = may || !ready;
  if (!may && ready) offerCommand($('commandBox'), kind().command());
}

function describe() {
  describedAt = performance.now();
  kind().describe();
  offer();
}

// The heights of the chosen part, in the scenario's coordinates; an input that has the focus stays as typed.
function showHeights() {
  const { chosen } = S.drawing,
    write = (input, z) => {
      if (document.activeElement !== input) input.value = +(z + S.run.mission.origin_m[2]).toFixed(3);
    };
  $('heights').hidden = !S.run.inBox || !chosen;
  if ($('heights').hidden) return;
  const peak = chosen.kind === 'peak';
  $('upTo').hidden = peak;
  $('lowZ').setAttribute('aria-label', peak ? 'Height of the peak' : 'Lower height');
  write($('lowZ'), peak ? chosen.z : chosen.heights[0]);
  if (!peak) write($('highZ'), chosen.heights[1]);
}

// Call after each change of the drawing.
function changed() {
  const { drawing } = S;
  drawing.full = drawing.parts.length >= kind().most;
  drawing.version++;
  kind().changed();
  $('removeDrawn').disabled = !drawing.chosen && !drawing.open.length;
  showHeights();
  describe();
  ask();
}

function order() {
  const [act, content] = kind().order();
  if (JSON.stringify(content).length > MOST_BYTES) {
    complain(`${kind().name}: not sent: too many corners. Save it as a file and use ergocast amend.`);
    return;
  }
  sent = { newest: kind().newest(), number: give(act, kind().name, content) };
}

function open(name) {
  if (S.drawing) close();
  S.drawing = {
    kind: name,
    parts: [],
    chosen: null,
    corner: -1,
    open: [],
    pointer: null,
    grid: null,
    version: 0,
  };
  Object.assign(S.drawing, kind().begin());
  sent = null;
  if (S.run.inBox) {
    viewBefore = S.view;
    showView('xy');
  }
  put($('drawnWays'), '');
  $('drawing').setAttribute('aria-label', kind().name);
  $('drawn').setAttribute('aria-label', kind().label);
  show();
  changed();
  $('drawn').focus();
}

// The focus goes back to the button that opened the layer, unless it is elsewhere by now.
function close() {
  const { button } = kind(),
    within = $('drawing').contains(document.activeElement) || document.activeElement === $('drawn');
  S.drawing = null;
  show();
  if (S.run.inBox && viewBefore && S.view === 'xy') showView(viewBefore);
  viewBefore = null;
  if (within) $(button).focus();
}

function show() {
  const drawing = S.drawing !== null;
  $('drawing').hidden = !drawing;
  for (const [name, { button, tools }] of Object.entries(KINDS)) {
    $(tools).hidden = S.drawing?.kind !== name;
    $(button).setAttribute('aria-pressed', S.drawing?.kind === name);
  }
  showLayer();
  layout();
}

// What is drawn is seen from above.
function showLayer() {
  const hidden = !S.drawing || (S.run.inBox && S.view !== 'xy');
  if ($('drawn').hidden !== hidden) $('drawn').hidden = hidden;
}

// Follows the team: whether something can be drawn, and what it would change by now.
export function followDrawing() {
  const possible = S.live && S.facts?.replay === false;
  for (const { button } of Object.values(KINDS))
    if ($(button).hidden === possible) $(button).hidden = !possible;
  if (!S.drawing) return;
  showLayer();
  if (!possible || (sent && isObeyed(sent.number) && kind().newest() > sent.newest)) close();
  else if (performance.now() - describedAt > DESCRIBE_MS) describe();
}

function connectHeights() {
  const set = i => e => {
    const { chosen } = S.drawing,
      z = e.target.value === '' ? NaN : Number(e.target.value) - S.run.mission.origin_m[2];
    if (chosen.kind === 'peak') chosen.z = z;
    else chosen.heights[i] = z;
    changed();
  };
  $('lowZ').oninput = set(0);
  $('highZ').oninput = set(1);
}

export function connectDrawing() {
  connectDrawnPointer(changed);
  connectTarget(changed);
  connectZone(changed);
  connectHeights();
  for (const [name, { button }] of Object.entries(KINDS))
    $(button).onclick = () => (S.drawing?.kind === name ? close() : open(name));
  $('closeDrawing').onclick = close;
  $('removeDrawn').onclick = () => {
    removeChosen();
    changed();
  };
  $('sendDrawn').dataset.label = 'Send';
  $('sendDrawn').onclick = () => press($('sendDrawn'), order);
  $('copyDrawn').onclick = () => copyCommand($('commandBox'));
}
