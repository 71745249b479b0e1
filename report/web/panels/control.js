// SPDX-License-Identifier: BSD-3-Clause
// Lets an operator give orders to a running team, and shows what the team reports about them.
import { S } from './state.js';
import { complain, notice, say, speak } from './control_text.js';
import { disarm, isArmed, press, watchPresses } from './presses.js';
import {
  endRequests,
  give,
  isAnyOrderOpen,
  isOver,
  mayOrder,
  me,
  noteAnswers,
  send,
  sendHere,
} from './requests.js';
import { endStopping, isStopAnswered, isStopping, stopNow } from './stop_now.js';
import { $, element, put } from '../text.js';

const HERE_MS = 3000; // an operator whose browser is silent for 10 s loses control

let last = { acts: [] }, // the state that came last
  hiddenNotice = '', // the one that SILENT has replaced
  chosenByPin;
const spokenActs = new Set(); // operator, number, act and state of each that was spoken

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
  const take = () => send('take', 'Take control');
  if (last.operator) press($('take'), take);
  else take();
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
  if (take.dataset.label !== label && isArmed(take)) disarm();
  take.dataset.label = label;
  if (!isArmed(take)) put(take, label);
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
  const name = act.operator === me.id && !isOver() ? '' : ` by ${act.name}`,
    text = act.text || 'sent';
  return !name && text.startsWith('agent ') ? text : `${act.what}${name}: ${text}`;
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
  const newest = shown.pop();
  if (newest && (isAnyOrderOpen() || isStopping())) {
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
  if (isStopAnswered(acts)) endStopping();
  if (state.over) {
    noteAnswers(last);
    return endControl();
  }
  $('control').hidden = false;
  $('readOnly').hidden = mayOrder;
  $('stopNow').hidden = $('take').parentElement.hidden = !mayOrder;
  document.body.classList.toggle('controlled', mayOrder);
  if (!mayOrder) {
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
  const waited = endRequests();
  if (isStopping() && !isStopAnswered(last.acts)) waited.push('Stop now');
  disarm();
  endStopping();
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
  $('release').onclick = () => send('release', 'Give back');
  for (const button of document.querySelectorAll('#orders [data-act]')) {
    button.dataset.label = button.textContent;
    button.onclick = () => pressOrder(button);
  }
  watchPresses(stopNow);
  setInterval(() => {
    if (me.mine) sendHere();
  }, HERE_MS);
}
