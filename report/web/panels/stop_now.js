// SPDX-License-Identifier: BSD-3-Clause
// Sends Stop now, which needs neither control nor a second press, until the team answers.
import { complain, notice, say, speak } from './control_text.js';
import { me, post, requestOf } from './requests.js';

const STOP_MS = 700, // between repeats
  MOST_STOPS = 4; // requests at once; a browser has six connections to a server

let stopping = null; // {request, tries, waiting, timer}: until the team's answer is seen

export const isStopping = () => stopping !== null;

// It is repeated under one number until the team's answer is seen or the mission has ended, and is obeyed
// once.
export function stopNow() {
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

export function endStopping() {
  clearTimeout(stopping?.timer);
  stopping = null;
}

// An earlier Stop now of another page counts as well, unless it has failed.
const answersStop = act =>
  (act.operator === me.id && act.number === stopping.request.number) ||
  (act.what === 'stop now' && act.state !== 'failed');

// Whether Stop now is on its way, and these acts have its answer.
export const isStopAnswered = acts => stopping !== null && acts.some(answersStop);
