// SPDX-License-Identifier: BSD-3-Clause
// The second press, which confirms an order.
import { speak } from './control_text.js';
import { mayTakeControl } from './requests.js';
import { isTyped, put } from '../text.js';

const CONFIRM_MS = 3000; // time for the second press

let armed = null; // {button, name, order, timer}: the button that waits for its second press

export const isArmed = button => armed?.button === button;

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

// A first press ends with any other act, so the second one confirms only what is still in sight.
export function watchPresses(stop) {
  addEventListener(
    'pointerdown',
    e => {
      if (armed && !armed.button.contains(e.target)) disarm();
    },
    true,
  );
  addEventListener('change', disarm, true);
  addEventListener('keydown', e => onKey(e, stop), true);
}

function onKey(e, stop) {
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
    if (!e.repeat) stop();
    ended();
  } else if (armed && e.target !== armed.button && !['Tab', 'Shift'].includes(e.key)) {
    disarm();
  }
}
