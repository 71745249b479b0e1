// SPDX-License-Identifier: BSD-3-Clause
// The control "New target": a target is drawn on the map, compared with the present one, and sent or copied.
import { S, ask } from './state.js';
import { layout } from './screen.js';
import { complain, hasControl, mayTakeControl, press, say, send } from './control.js';
import { connectDrawnPointer, removeChosen } from './drawn_pointer.js';
import { MOST_BYTES, MOST_PARTS, comparison, gridOf, modesOf, requestOf, textOf } from '../data/drawn.js';
import { $, put, readable, share } from '../text.js';

const COMPARE_MS = 250; // wall time between comparisons while the team moves on

let sent = null, // how many targets the page knew when one was sent
  comparedAt = 0;

const whole = () => S.drawing.parts.length > 0 && S.drawing.grid !== null;
const request = () => requestOf(S.drawing.parts, S.drawing.uniform, S.run.mission);

function command(target) {
  return (
    `cat > target.textproto <<'END'\n${textOf(target)}END\n` +
    `ergocast amend --run-id ${S.facts.run} --target target.textproto`
  );
}

function compare() {
  const { run, drawing } = S;
  comparedAt = performance.now();
  if (!whole()) {
    const polygon = drawing.tool === 'polygon';
    put(
      $('drawnText'),
      drawing.open.length
        ? 'Click for each corner, and on the first one to close the polygon.'
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
    `φ² of what is covered by now: ${readable(against)} against this target, ${readable(present)} against ` +
      `the present one. ${share(Math.round(moved * 100) / 100)} of its mass is elsewhere than now.`,
  );
}

// Call after each change of the drawing.
function changed() {
  const { run, drawing } = S,
    [M, N] = run.mission.modes;
  drawing.full = drawing.parts.length >= MOST_PARTS;
  drawing.grid = drawing.parts.length
    ? gridOf(drawing.parts, drawing.uniform, run.size, run.mission.walls)
    : null;
  if (drawing.grid) drawing.mu = modesOf(drawing.grid, M, N);
  drawing.version++;
  for (const button of $('tool').children)
    button.setAttribute('aria-pressed', button.dataset.value === drawing.tool);
  put($('uniformText'), share(drawing.uniform));
  $('removeDrawn').disabled = !drawing.chosen && !drawing.open.length;
  compare();
  offer();
  ask();
}

// With control the target can be sent; without, the command is shown.
function offer() {
  const ready = whole(),
    may = hasControl();
  $('sendTarget').hidden = !may;
  $('sendTarget').disabled = !ready;
  $('commandBox').hidden = may || !ready;
  if (may || !ready) return;
  put(
    $('whyCommand'),
    mayTakeControl()
      ? 'Take control to send it. Or run this where the team’s key is:'
      : 'This page only shows. Run this where the team’s key is:',
  );
  put($('targetCommand'), command(request()));
}

function order() {
  const target = request();
  if (JSON.stringify(target).length > MOST_BYTES) {
    complain('New target: not sent: it has too many corners. Save it as a file and use ergocast amend.');
    return;
  }
  say('New target: sent');
  sent = S.run.targets.length;
  send('target', { target });
}

function open() {
  S.drawing = {
    tool: 'peak',
    uniform: 0.1,
    parts: [],
    chosen: null,
    open: [],
    pointer: null,
    grid: null,
    version: 0,
  };
  sent = null;
  $('uniform').value = 100 * S.drawing.uniform;
  show();
  changed();
  $('drawn').focus();
}

function close() {
  S.drawing = null;
  show();
}

function show() {
  const drawing = S.drawing !== null;
  for (const id of ['drawing', 'drawn']) $(id).hidden = !drawing;
  $('drawTarget').setAttribute('aria-pressed', drawing);
  layout();
}

// Follows the team: whether a target can be drawn, and what it would change by now.
export function followDrawing() {
  const { run } = S,
    possible = S.live && !run.inBox && S.facts?.replay === false;
  if ($('drawTarget').hidden === possible) $('drawTarget').hidden = !possible;
  if (!S.drawing) return;
  if (!possible || (sent !== null && run.targets.length > sent)) close();
  else if (performance.now() - comparedAt > COMPARE_MS) {
    compare();
    offer();
  }
}

async function copy() {
  try {
    await navigator.clipboard.writeText($('targetCommand').textContent);
    put($('copyTarget'), 'Copied');
  } catch {
    // Without https the browser has no clipboard: the text is selected instead.
    getSelection().selectAllChildren($('targetCommand'));
    put($('copyTarget'), 'Selected: press Ctrl-C');
  }
}

export function connectDrawing() {
  connectDrawnPointer(() => {
    put($('copyTarget'), 'Copy');
    changed();
  });
  $('drawTarget').onclick = () => (S.drawing ? close() : open());
  $('closeDrawing').onclick = close;
  $('removeDrawn').onclick = () => {
    removeChosen();
    changed();
  };
  $('tool').onclick = e => {
    if (!e.target.dataset.value) return;
    S.drawing.tool = e.target.dataset.value;
    S.drawing.open = [];
    changed();
  };
  $('uniform').oninput = e => {
    S.drawing.uniform = Number(e.target.value) / 100;
    changed();
  };
  $('sendTarget').dataset.label = 'Send';
  $('sendTarget').onclick = () => press($('sendTarget'), order);
  $('copyTarget').onclick = copy;
}
