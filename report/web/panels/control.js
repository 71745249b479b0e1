// SPDX-License-Identifier: BSD-3-Clause
// Lets an operator give orders to a running team, and shows what the team reports about them.
import { S } from './state.js';
import { $, capital, element, isTyped, put } from '../text.js';

const CONFIRM_MS = 3000, // time for the second press
  HERE_MS = 3000, // an operator whose browser is silent for 10 s loses control
  SEND_MS = 5000,
  ANSWER_MS = 6000, // time for the server to show an order or why it is refused
  STOP_MS = 700, // between repeats of Stop now
  MOST_STOPS = 4; // requests at once; a browser has six connections to a server

const WORDS = {
  take: 'Take control',
  release: 'Give back',
  'stop-now': 'Stop now',
  target: 'New target',
};
const wordsOf = act => WORDS[act] ?? capital(act);

// The address has, after #, the token that permits orders. Only this page's memory keeps it: not the
// address bar, the history or a cookie.
const token = takeToken();
const me = { id: crypto.getRandomValues(new Uint32Array(1))[0] || 1, number: 0, mine: false };
let armed = null, // {button, name, order, timer}: the button that waits for its second press
  stopping = null, // {request, tries, waiting, timer}: Stop now, until the team's answer is seen
  last = { acts: [] }, // the state that came last
  hiddenNotice = '', // the one that SILENT has replaced
  over = false,
  chosenByPin;
const spokenActs = new Set(), // operator, number, act and state of each that was spoken
  shownRefusals = new Set(), // numbers
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

// ---- what is shown and spoken ----

// The newest order.
function say(text) {
  put($('controlText'), text);
  $('controlText').classList.remove('bad');
}
const speak = text => put($('controlSpoken'), text);

// What has gone wrong stays until the operator's next request.
function notice(text) {
  put($('controlNotice'), text);
  $('controlNotice').hidden = !text;
}

export function complain(text) {
  notice(text);
  speak(text);
}

// ---- requests ----

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
export const mayTakeControl = () => token !== null && !over && !$('control').hidden;

const requestOf = (act, more = {}) => ({
  operator: me.id,
  name: fitting($('operatorName').value.trim()),
  number: act === 'here' ? Math.max(1, me.number) : ++me.number, // a sign overtakes no order
  tick: S.facts?.state?.world_tick ?? 0,
  act,
  ...more,
});

const post = request =>
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
function send(act, label, more = {}) {
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

// The server has answered: what the page has said meanwhile about the order goes.
function settle(number) {
  if ($('controlNotice').textContent === unanswered.get(number).notice) notice('');
  forget(number);
}

// Notes which requests the server has answered. It obeys none after a later one.
function noteAnswers({ operator, acts, refused }) {
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
async function sendHere() {
  const received = await post(requestOf('here')).then(
    answer => answer.status === 202,
    () => false,
  );
  const shown = $('controlNotice').textContent;
  if (received && shown === UNSEEN) notice('');
  else if (!received && me.mine && !shown) notice(UNSEEN);
}

// ---- Stop now ----

// It is repeated under one number until the team's answer is seen or the mission has ended, and is obeyed
// once.
function stopNow() {
  if (!stopping) {
    notice('');
    stopping = { request: requestOf('stop-now'), tries: 0, waiting: 0 };
    say('Stop now: sent');
  }
  tryStop();
}

async function tryStop() {
  const one = stopping;
  if (!one) return;
  clearTimeout(one.timer);
  one.timer = setTimeout(tryStop, STOP_MS);
  if (one.waiting >= MOST_STOPS) return;
  one.tries++;
  one.waiting++;
  if (one.tries > 1) say(`Stop now: no answer yet, sent ${one.tries} times. It is repeated until the answer`);
  if (one.tries === 2) speak('Stop now: no answer yet. It is repeated until the answer.');
  try {
    const answer = await post(one.request);
    if (answer.status === 202 || answer.status === 503 || stopping !== one) return;
    endStopping();
    complain(`Stop now: not sent: ${(await answer.text()).trim()}`);
  } catch {
    // The next try follows.
  } finally {
    one.waiting--;
  }
}

function endStopping() {
  clearTimeout(stopping?.timer);
  stopping = null;
}

// An earlier Stop now of another page counts as well, unless it has failed.
const answersStop = act =>
  (act.operator === me.id && act.number === stopping.request.number) ||
  (act.what === 'stop now' && act.state !== 'failed');

// ---- the second press ----

export function disarm() {
  if (!armed) return;
  clearTimeout(armed.timer);
  put(armed.button, armed.button.dataset.label);
  armed.button.classList.remove('armed');
  armed = null;
}

// Every order but the stop at once needs a second press, so that no order comes by accident. The second
// press gives the order of the first one, which the button names meanwhile.
export function press(button, order, name = button.dataset.label) {
  if (armed?.button === button && armed.name === name) {
    const { order: first } = armed;
    disarm();
    first();
    return;
  }
  disarm();
  armed = { button, name, order, timer: setTimeout(disarm, CONFIRM_MS) };
  button.classList.add('armed');
  put(button, `Again: ${name}`);
  speak(`Press again within 3 seconds: ${name}`);
}

// Sends an order, which is shown as sent until the server shows it. Returns its number.
export function give(act, label, more = {}) {
  say(`${capital(label)}: sent`);
  return send(act, capital(label), more);
}

// Whether an order of this page, by its number, is being obeyed.
export const isObeyed = number =>
  last.acts.some(
    act =>
      act.operator === me.id && act.number === number && ['answered', 'obeyed', 'done'].includes(act.state),
  );

function pressOrder(button) {
  const { act, label } = button.dataset,
    names = act === 'home' || act === 'out',
    agent = names ? Number($('orderedAgent').value) : undefined,
    name = names ? `agent ${agent} ${act}` : label;
  press(button, () => give(act, name, names ? { agent } : {}), name);
}

// Another operator loses control by the press, so that needs a second one.
function pressTake() {
  const take = () => send('take', wordsOf('take'));
  if (last.operator) press($('take'), take);
  else take();
}

// A first press ends with any other act, so the second one confirms only what is still in sight.
function watchForOthers() {
  addEventListener(
    'pointerdown',
    e => {
      if (armed && !armed.button.contains(e.target)) disarm();
    },
    true,
  );
  addEventListener('change', disarm, true);
  addEventListener('keydown', onKey, true);
}

function onKey(e) {
  const ended = () => {
    e.preventDefault();
    e.stopImmediatePropagation();
  };
  const plain = !e.ctrlKey && !e.metaKey && !e.altKey;
  if (e.repeat && e.key === 'Enter' && e.target.closest?.('#control button, .armed')) {
    ended(); // a key that is held is one press
  } else if (armed && e.key === 'Escape') {
    disarm();
    speak('The first press is taken back.');
    ended();
  } else if (e.key === '!' && plain && !isTyped(e.target) && mayTakeControl()) {
    if (!e.repeat) stopNow();
    ended();
  } else if (armed && e.target !== armed.button && !['Tab', 'Shift'].includes(e.key)) {
    disarm();
  }
}

// ---- the state that the server sends ----

// Lists the agents that can be chosen. An agent that is pinned on the map or in the table is chosen.
export function listAgents() {
  if (!me.mine) return;
  const select = $('orderedAgent'),
    before = select.value,
    ids = (S.facts?.state?.agents ?? []).map(agent => agent.id).sort((a, b) => a - b),
    [pinned] = S.pins;
  if ([...select.options].map(option => Number(option.value)).join() !== ids.join()) {
    select.replaceChildren(...ids.map(id => new Option(`agent ${id}`, id)));
    if (before !== '' && ids.includes(Number(before))) select.value = before;
  }
  if (S.pins.size === 1 && chosenByPin !== pinned) select.value = pinned;
  chosenByPin = pinned;
  if (select.value !== before) disarm();
}

function showTake(label) {
  const take = $('take');
  if (take.dataset.label !== label && armed?.button === take) disarm();
  take.dataset.label = label;
  if (armed?.button !== take) put(take, label);
}

function showHolder(operator) {
  const mine = operator?.id === me.id;
  if (me.mine && !mine)
    complain(operator ? `${operator.name} has taken control from you.` : 'You no longer have control.');
  if (me.mine !== mine) disarm();
  me.mine = mine;
  put(
    $('holder'),
    mine ? 'You have control' : operator ? `${operator.name} has control` : 'No operator has control',
  );
  showTake(operator && !mine ? 'Take over' : 'Take control');
  $('take').hidden = $('operatorName').hidden = mine;
  $('release').hidden = !mine;
  $('orders').hidden = !mine;
}

// "stop now by anna: stopped at tick 423, t = 42.3 s: all stand still". After the end all are named.
function textOf(act) {
  const name = act.operator === me.id && !over ? '' : ` by ${act.name}`,
    said = act.text || 'sent';
  return !name && said.startsWith('agent ') ? said : `${act.what}${name}: ${said}`;
}

// The newest order, and every earlier one that has failed or is unfinished. An order that was given again
// stands for the earlier one.
function showActs({ acts }) {
  const shown = acts.filter(
    (act, i) =>
      i === acts.length - 1 ||
      ((act.state === 'failed' || !act.over) && !acts.slice(i + 1).some(({ what }) => what === act.what)),
  );
  const spoken = [];
  for (const act of shown) {
    const key = [act.operator, act.number, act.what, act.state].join();
    if (!spokenActs.has(key)) spoken.push(textOf(act));
    spokenActs.add(key);
  }
  if (spoken.length) speak(spoken.join('. '));
  const waits = [...unanswered.values()].some(isOrder);
  const newest = shown.pop();
  if (newest && (waits || stopping)) {
    if (newest.state === 'failed' || !newest.over) shown.push(newest);
  } else if (newest) {
    say(textOf(newest));
    $('controlText').classList.toggle('bad', newest.state === 'failed');
  }
  $('controlActs').replaceChildren(
    ...shown.reverse().map(act => element('li', act.state === 'failed' ? 'bad' : '', textOf(act))),
  );
  $('controlActs').hidden = !shown.length;
}

const SILENT = 'The process that gives the orders does not answer: no order is carried out.';

// Shows the state of control that the server sends: {over, operator, acts, refused}, or {silent}.
export function showControl(state) {
  const shown = $('controlNotice').textContent;
  if (state.silent) {
    if (shown !== SILENT) hiddenNotice = shown;
    return complain(SILENT);
  }
  if (shown === SILENT) notice(hiddenNotice);
  last = { ...state, acts: state.acts ?? last.acts, refused: state.refused ?? [] };
  const { operator, acts } = last;
  if (stopping && acts.some(answersStop)) endStopping();
  if (state.over) {
    noteAnswers(last);
    return endControl();
  }
  $('control').hidden = false;
  $('readOnly').hidden = token !== null;
  $('stopNow').hidden = $('take').parentElement.hidden = token === null;
  document.body.classList.toggle('controlled', token !== null);
  if (token === null) {
    put($('holder'), operator ? `${operator.name} has control` : 'No operator has control');
    $('orders').hidden = true;
  } else {
    showHolder(operator);
    listAgents();
  }
  noteAnswers(last);
  showActs(last);
}

// The mission has ended: what the last orders achieved stays.
export function endControl() {
  const waited = [...unanswered]
    .filter(([number, one]) => isOrder(one) && !replaced.has(number))
    .map(([, { label }]) => label);
  if (stopping !== null && !last.acts.some(answersStop)) waited.push('Stop now');
  disarm();
  endStopping();
  over = true;
  me.mine = false;
  for (const number of [...unanswered.keys()]) forget(number);
  notice(waited.map(label => `${label}: the mission ended before the team had answered.`).join(' '));
  for (const node of [$('stopNow'), $('take').parentElement, $('orders'), $('readOnly')]) node.hidden = true;
  document.body.classList.remove('controlled');
  put($('holder'), 'The mission has ended');
  showActs(last);
  const newest = last.acts[last.acts.length - 1];
  if (newest) speak(textOf(newest));
  $('control').classList.add('ended');
  $('control').hidden = !newest && !waited.length;
}

export function connectControl() {
  $('stopNow').onclick = stopNow;
  $('take').onclick = pressTake;
  $('release').onclick = () => send('release', wordsOf('release'));
  for (const button of document.querySelectorAll('#orders [data-act]')) {
    button.dataset.label = button.textContent;
    button.onclick = () => pressOrder(button);
  }
  watchForOthers();
  setInterval(() => {
    if (me.mine) sendHere();
  }, HERE_MS);
}
