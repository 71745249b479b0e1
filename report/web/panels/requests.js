// SPDX-License-Identifier: BSD-3-Clause
// Sends the operator's requests to the server, and finds out what the server has answered to each.
import { S } from './state.js';
import { complain, notice, say } from './control_text.js';
import { $, capital } from '../text.js';

const SEND_MS = 5000,
  ANSWER_MS = 6000; // time for the server to show an order or why it is refused

// The address has, after #, the token that permits orders. Only this page's memory keeps it: not the
// address bar, the history or a cookie.
const token = takeToken();
export const me = { id: crypto.getRandomValues(new Uint32Array(1))[0] || 1, number: 0, mine: false };
let over = false;
const shownRefusals = new Set(), // numbers
  // {act, label, content, more, copies, timer, notice} of requests without an answer, by number. The next
  // press repeats such a request under its number, so it is obeyed once.
  unanswered = new Map(),
  // Numbers of requests without an answer whose drawing was changed and sent again: at most one of them all
  // is obeyed.
  replaced = new Set();

function takeToken() {
  const wishes = new URLSearchParams(location.hash.slice(1)),
    found = wishes.get('control');
  if (found === null) return null;
  wishes.delete('control');
  const rest = wishes.toString();
  history.replaceState(null, '', location.pathname + location.search + (rest ? `#${rest}` : ''));
  return found;
}

// A header holds ASCII only.
const ascii = text =>
  text.replace(/[%\u007f-\uffff]/g, c => `\\u${c.charCodeAt(0).toString(16).padStart(4, '0')}`);

// The server takes 48 bytes of a name.
function fitting(name) {
  const letters = [...name];
  while (new TextEncoder().encode(letters.join('')).length > 48) letters.pop();
  return letters.join('');
}

// Whether this page may give orders now, and whether it may take control.
export const hasControl = () => me.mine;
export const mayOrder = token !== null;
export const mayTakeControl = () => token !== null && !over && !$('control').hidden;

export const requestOf = (act, more = {}) => ({
  operator: me.id,
  name: fitting($('operatorName').value.trim()),
  number: act === 'here' ? Math.max(1, me.number) : ++me.number, // a sign overtakes no order
  tick: S.facts?.state?.world_tick ?? 0,
  act,
  ...more,
});

export const post = request =>
  fetch('control', {
    method: 'POST',
    headers: { 'X-Ergocast-Token': token, 'X-Ergocast-Request': ascii(JSON.stringify(request)) },
    cache: 'no-store',
    signal: AbortSignal.timeout(SEND_MS),
  });

// The first number of an earlier state of a drawing that has no answer.
function earlierOf(act) {
  const earlier = [...unanswered].filter(([, one]) => one.act === act).map(([number]) => number);
  for (const number of earlier) {
    clearTimeout(unanswered.get(number).timer);
    replaced.add(number);
  }
  return earlier.length ? { instead_of: Math.min(...earlier) } : {};
}

// Sends a request; `more` has what only this act needs. Returns its number.
export function send(act, label, more = {}) {
  const content = JSON.stringify([act, more]),
    [before, same] = [...unanswered].find(([n, one]) => one.content === content && !replaced.has(n)) ?? [],
    whole = same?.more ?? { ...more, ...(isDrawn(act) ? earlierOf(act) : {}) },
    request = requestOf(act, whole),
    number = (request.number = before ?? request.number);
  forget(number);
  notice('');
  const timer = setTimeout(() => missAnswer(number), ANSWER_MS);
  unanswered.set(number, { act, label, content, more: whole, copies: (same?.copies ?? 0) + 1, timer });
  post(request).then(
    async answer => {
      if (answer.status !== 202) fail(number, (await answer.text()).trim());
    },
    () => missAnswer(number),
  );
  return number;
}

function forget(number) {
  clearTimeout(unanswered.get(number)?.timer);
  unanswered.delete(number);
}

const isDrawn = act => act === 'target' || act === 'zone';
const isOrder = ({ act }) => act !== 'take' && act !== 'release';

// The server has not accepted a copy of a request.
function fail(number, why) {
  const one = unanswered.get(number);
  if (!one) return;
  if (--one.copies > 0) return missAnswer(number);
  forget(number);
  if (replaced.has(number)) return;
  if (isOrder(one)) say(`${one.label}: not sent`);
  complain(`${one.label}: not sent: ${why}`);
}

// The request may have been lost, or may still arrive.
function missAnswer(number) {
  const one = unanswered.get(number);
  if (!one || replaced.has(number)) return;
  clearTimeout(one.timer);
  if (isOrder(one)) say(`${one.label}: not answered`);
  one.notice = `${one.label}: not answered. Press again: it is obeyed once.`;
  complain(one.notice);
}

// The server has answered: the notice about this order goes.
function settle(number) {
  if ($('controlNotice').textContent === unanswered.get(number).notice) notice('');
  forget(number);
}

// Notes which requests the server has answered. It obeys none after a later one.
export function noteAnswers({ operator, acts, refused }) {
  const answered = acts
    .filter(act => act.operator === me.id && act.what !== 'stop now')
    .map(act => act.number);
  const newest = Math.max(0, ...answered);
  for (const [number, { act, label }] of unanswered) {
    const isHolder = operator?.id === me.id;
    if (answered.includes(number) || act === (isHolder ? 'take' : 'release')) settle(number);
    else if (number < newest && !refused.some(one => one.operator === me.id && one.number === number)) {
      settle(number);
      if (!replaced.has(number))
        complain(`${label}: not obeyed, because a later order came first. Press again.`);
    }
  }
  for (const { operator: id, number, what, text } of refused) {
    if (id !== me.id || shownRefusals.has(number)) continue;
    shownRefusals.add(number);
    const one = unanswered.get(number);
    if (one) settle(number);
    if (replaced.has(number)) continue;
    if (one && isOrder(one)) say(`${capital(what)}: refused`);
    complain(`${capital(what)}: refused: ${text}`);
  }
}

const UNSEEN = 'The server does not receive this browser: without a sign for 10 s you lose control.';

// A sign that the browser is still there. It is no order, so no screen reader reads it.
export async function sendHere() {
  const received = await post(requestOf('here')).then(
    answer => answer.status === 202,
    () => false,
  );
  const shown = $('controlNotice').textContent;
  if (received && shown === UNSEEN) notice('');
  else if (!received && me.mine && !shown) notice(UNSEEN);
}

// Sends an order, which is shown as sent until the server shows it. Returns its number.
export function give(act, label, more = {}) {
  say(`${capital(label)}: sent`);
  return send(act, capital(label), more);
}

// Whether any order has no answer yet.
export const isAnyOrderOpen = () => [...unanswered.values()].some(isOrder);
export const isOver = () => over;

// The mission has ended. Returns the labels of the orders that have no answer.
export function endRequests() {
  const waited = [...unanswered]
    .filter(([number, one]) => isOrder(one) && !replaced.has(number))
    .map(([, { label }]) => label);
  over = true;
  me.mine = false;
  for (const number of [...unanswered.keys()]) forget(number);
  return waited;
}
