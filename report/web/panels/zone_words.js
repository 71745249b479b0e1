// SPDX-License-Identifier: BSD-3-Clause
// Lists the closed zones for a screen reader, and reads aloud when one of them closes, is free, or ends.
import { S } from './state.js';
import { stateOfZone } from '../data/zones.js';
import { $, capital, element, put } from '../text.js';

let known = new Map(), // state of each zone, by number
  knownRun = null; // its number

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

// Follows the zones at the chosen time.
export function followZones() {
  const row = S.run.rowAt(S.t),
    now = S.run.zonesAt(row).map(zone => stateOfZone(S.run, zone, row)),
    list = $('zoneList');
  if (S.facts && S.facts.run !== knownRun) {
    known = new Map();
    knownRun = S.facts.run;
  }
  if (S.live && S.following && S.run.isCurrent) {
    announce(now);
    known = new Map(now.map(zone => [zone.number, zone]));
  }
  while (list.childElementCount > now.length) list.lastChild.remove();
  while (list.childElementCount < now.length) list.append(element('li'));
  now.forEach((zone, i) => put(list.children[i], capital(zone.text)));
}
