// SPDX-License-Identifier: BSD-3-Clause
// The three texts of control: of the newest order, of what has gone wrong, and for screen readers.
import { $, put } from '../text.js';

// The newest order.
export function say(text) {
  put($('controlText'), text);
  $('controlText').classList.remove('bad');
}
export const speak = text => put($('controlSpoken'), text);

// What has gone wrong stays until the operator's next request.
export function notice(text) {
  put($('controlNotice'), text);
  $('controlNotice').hidden = !text;
}

export function complain(text) {
  notice(text);
  speak(text);
}
