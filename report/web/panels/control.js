// SPDX-License-Identifier: BSD-3-Clause
// Lets an operator give orders to a running team, and shows what the team reports about the newest one.
import { S } from './state.js';
import { $, put } from '../text.js';

const CONFIRM_MS = 3000, // time for the second press
  HERE_MS = 3000, // an operator whose browser is silent for 10 s loses control
  SEND_MS = 5000;

// The address has, after #, the token that permits orders. Only this page's memory keeps it: not the
// address bar, the history or a cookie.
const token = takeToken();
const me = { id: crypto.getRandomValues(new Uint32Array(1))[0] || 1, number: 0, mine: false };
let armed = null, // {button, timer}: the button that waits for its second press
  shownAct = '', // operator, number and state of the order that was shown last
  shownRefusal = 0,
  chosenByPin;

function takeToken() {
  const wishes = new URLSearchParams(location.hash.slice(1)),
    found = wishes.get('control');
  if (found === null) return null;
  wishes.delete('control');
  const rest = wishes.toString();
  history.replaceState(null, '', location.pathname + location.search + (rest ? `#${rest}` : ''));
  return found;
}

export const say = text => put($('controlText'), text);
const speak = text => put($('controlSpoken'), text);

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
export const mayTakeControl = () => token !== null && !$('control').hidden;

// Sends a request; `more` has what only this act needs.
export async function send(act, more = {}) {
  const request = {
    operator: me.id,
    name: fitting($('operatorName').value.trim()),
    number: ++me.number,
    tick: S.facts?.state?.world_tick ?? 0,
    act,
    ...more,
  };
  try {
    const answer = await fetch('control', {
      method: 'POST',
      headers: { 'X-Ergocast-Token': token, 'X-Ergocast-Request': ascii(JSON.stringify(request)) },
      cache: 'no-store',
      signal: AbortSignal.timeout(SEND_MS),
    });
    if (answer.status === 202) return;
    complain(`${act}: not sent: ${(await answer.text()).trim()}`);
  } catch {
    complain(`${act}: no answer from the page’s server: the order may not have been sent. Press again.`);
  }
}

export function complain(text) {
  say(text);
  speak(text);
}

function disarm() {
  if (!armed) return;
  clearTimeout(armed.timer);
  put(armed.button, armed.button.dataset.label);
  armed.button.classList.remove('armed');
  armed = null;
}

// Every order but the stop at once needs a second press, so that no order comes by accident.
export function press(button, order) {
  const { label } = button.dataset;
  if (armed?.button === button) {
    disarm();
    order();
    return;
  }
  disarm();
  armed = { button, timer: setTimeout(disarm, CONFIRM_MS) };
  button.classList.add('armed');
  put(button, `Again: ${label}`);
  speak(`Press again within 3 seconds: ${label}`);
}

function give(act, label) {
  say(`${label}: sent`);
  const named = act === 'home' || act === 'out';
  send(act, named ? { agent: Number($('orderedAgent').value) } : {});
}

// Lists the agents that can be chosen. An agent that is pinned on the map or in the table is chosen.
export function listAgents() {
  if (!me.mine) return;
  const select = $('orderedAgent'),
    ids = (S.facts?.state?.agents ?? []).map(agent => agent.id).sort((a, b) => a - b),
    [pinned] = S.pins;
  if ([...select.options].map(option => Number(option.value)).join() !== ids.join()) {
    const chosen = select.value;
    select.replaceChildren(...ids.map(id => new Option(`agent ${id}`, id)));
    if (chosen !== '' && ids.includes(Number(chosen))) select.value = chosen;
  }
  if (S.pins.size === 1 && chosenByPin !== pinned) select.value = pinned;
  chosenByPin = pinned;
}

function showHolder(operator) {
  const mine = operator?.id === me.id;
  if (me.mine && !mine)
    complain(operator ? `${operator.name} has taken control from you.` : 'You no longer have control.');
  me.mine = mine;
  put(
    $('holder'),
    mine ? 'You have control' : operator ? `${operator.name} has control` : 'No operator has control',
  );
  put($('take'), operator && !mine ? 'Take over' : 'Take control');
  $('take').hidden = $('operatorName').hidden = mine;
  $('release').hidden = !mine;
  $('orders').hidden = !mine;
  if (!mine) disarm();
}

function showAct(acts) {
  const act = acts[acts.length - 1];
  if (!act) return;
  const name = act.operator === me.id ? '' : ` by ${act.name}`,
    said = act.text || 'sent',
    text = said.startsWith('agent ') ? said : `${act.what}${name}: ${said}`;
  if (act.state === 'failed') $('controlText').classList.add('bad');
  else $('controlText').classList.remove('bad');
  const key = [act.operator, act.number, act.state].join();
  if (key !== shownAct) speak(text);
  shownAct = key;
  say(text);
}

function showRefusal(refused) {
  if (refused?.operator !== me.id || refused.number <= shownRefusal) return false;
  shownRefusal = refused.number;
  complain(`${refused.what}: refused: ${refused.text}`);
  return true;
}

// Shows the state of control that the server sends: {operator, acts, refused}.
export function showControl({ over, silent, operator, acts, refused }) {
  if (over) return hideControl();
  if (silent) {
    complain('The process that gives the orders does not answer: no order is carried out.');
    return;
  }
  $('control').hidden = false;
  $('readOnly').hidden = token !== null;
  $('stopNow').hidden = $('take').parentElement.hidden = token === null;
  if (token === null) {
    put($('holder'), operator ? `${operator.name} has control` : 'No operator has control');
    $('orders').hidden = true;
  } else {
    showHolder(operator);
    listAgents();
  }
  if (!showRefusal(refused)) showAct(acts);
}

export function hideControl() {
  disarm();
  me.mine = false;
  $('control').hidden = true;
}

export function connectControl() {
  $('stopNow').onclick = () => give('stop-now', 'Stop now');
  $('take').onclick = () => send('take');
  $('release').onclick = () => send('release');
  for (const button of document.querySelectorAll('#orders [data-act]')) {
    const { act } = button.dataset,
      label = button.textContent;
    button.dataset.label = label;
    button.onclick = () => press(button, () => give(act, label));
  }
  setInterval(() => {
    if (me.mine) send('here');
  }, HERE_MS);
}
