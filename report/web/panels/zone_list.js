// SPDX-License-Identifier: BSD-3-Clause
// Lists the closed zones, reads aloud when one of them closes, is free, or ends, and cancels them.
import { S } from './state.js';
import { disarm, press } from './presses.js';
import { give, hasControl } from './requests.js';
import { copyCommand, offerCommand } from './command.js';
import { stateOfZone } from '../data/zones.js';
import { $, capital, element, put } from '../text.js';

let known = new Map(), // state of each zone, by number
  knownRun = null, // its number
  asked = null; // the number of the zone whose command is shown
const items = new Map(); // {item, words, button} of each zone in the list, by number

function wordsOf({ number, leaving, left, count }) {
  if (leaving) return `Zone ${number} is closed: agents leave it within ${left}.`;
  const inside = count ? `Agents inside: ${count}.` : 'No agent is inside.';
  return `Zone ${number} stays closed for ${left}. ${inside}`;
}

function announce(now) {
  const changed = now.filter(zone => known.get(zone.number)?.leaving !== zone.leaving).map(wordsOf),
    ended = [...known.keys()].filter(number => !now.some(zone => zone.number === number));
  const words = [...changed, ...ended.map(number => `Zone ${number} has ended.`)];
  if (words.length) put($('spoken'), words.join(' '));
}

// ---- cancelling ----

// With control the zone is cancelled; without, the command is shown.
function pressCancel(number, button) {
  if (hasControl()) {
    press(button, () => give('reopen', `cancel zone ${number}`, { amendment: number }));
    return;
  }
  asked = asked === number ? null : number;
  showCommand();
  if (asked !== null) $('cancelCommand').focus();
}

function showCommand() {
  if (hasControl() || !items.has(asked) || $('zones').classList.contains('hidden')) asked = null;
  for (const [number, { button }] of items) {
    if (hasControl()) button.removeAttribute('aria-expanded');
    else button.setAttribute('aria-expanded', number === asked);
  }
  $('cancelBox').hidden = asked === null;
  if (asked !== null)
    offerCommand($('cancelBox'), `ergocast amend --run-id ${S.facts.run} --cancel ${asked}`);
}

// ---- the list ----

function add(number) {
  const item = element('li'),
    words = element('span'),
    button = element('button', '', `Cancel zone ${number}`);
  button.dataset.label = button.textContent;
  button.title = 'The zone ends, and agents enter it again';
  button.onclick = () => pressCancel(number, button);
  item.append(words, ' ', button);
  $('zoneList').append(item);
  items.set(number, { item, words, button });
}

// The focus goes on to another zone, or to the button that draws one.
function remove(number) {
  const { item, button } = items.get(number),
    had = document.activeElement === button;
  if (button.classList.contains('armed')) disarm();
  item.remove();
  items.delete(number);
  if (had) ($('zoneList').querySelector('button:not([hidden])') ?? $('drawZone')).focus();
}

function list(now) {
  const possible = S.live && S.facts?.replay === false,
    newest = S.run.rowAt(S.run.end) * S.run.stride;
  for (const number of items.keys()) if (!now.some(zone => zone.number === number)) remove(number);
  for (const { number, text } of now) {
    if (!items.has(number)) add(number);
    const { words, button } = items.get(number);
    put(words, capital(text));
    button.hidden = !possible || S.run.zones.find(zone => zone.number === number).until <= newest;
  }
  $('zones').classList.toggle('hidden', !possible || !now.length);
  showCommand();
}

// Follows the zones at the chosen time.
export function followZones() {
  const row = S.run.rowAt(S.t),
    now = S.run.zonesAt(row).map(zone => stateOfZone(S.run, zone, row));
  if (S.facts && S.facts.run !== knownRun) {
    known = new Map();
    knownRun = S.facts.run;
  }
  if (S.live && S.following && S.run.isCurrent) {
    announce(now);
    known = new Map(now.map(zone => [zone.number, zone]));
  }
  list(now);
}

export function connectZones() {
  $('copyCancel').onclick = () => copyCommand($('cancelBox'));
}
