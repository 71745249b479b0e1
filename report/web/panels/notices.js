// SPDX-License-Identifier: BSD-3-Clause
// Writes the sentences above the map: what a person should know or do now.
import { S } from './state.js';
import { hasControl, mayTakeControl } from './requests.js';
import { $, grouped, put } from '../text.js';

export const NOTABLE = 0.01; // of the commands

const CAUSE =
  'Unless an agent was away, the machine or the network is too slow for the pace. ' +
  'Use a smaller realtime_factor, a longer dt_s, or fewer agents on a host.';
const percent = share => `${(100 * share).toFixed(share < 0.1 ? 1 : 0)} %`;

// Commands that came too late: how many, which share of all, and which of the latest while a team runs.
export function lateCommands() {
  if (S.facts) {
    const { missed, late, state } = S.facts,
      all = (state?.tick ?? 0) * (state?.agents?.length ?? 0);
    return { missed, share: all > 0 ? Math.min(1, missed / all) : 0, lately: late };
  }
  const { summary } = S.run,
    missed = summary?.missed_deadlines,
    all = summary?.ticks * summary?.agents?.length;
  return {
    missed: typeof missed === 'number' ? missed : 0,
    share: missed > 0 && all > 0 ? Math.min(1, missed / all) : 0,
    lately: 0,
  };
}

// "1 234 (12 %)"
export function lateText({ missed, share }) {
  return grouped(missed) + (share >= NOTABLE ? ` (${percent(share)})` : '');
}

function overload() {
  const { share, lately } = lateCommands();
  if (lately >= NOTABLE)
    return (
      `${percent(lately)} of the latest commands come too late for their tick, ` +
      `so vehicles keep older ones or stand. ${CAUSE}`
    );
  if (!S.live && share >= NOTABLE)
    return (
      `${percent(share)} of all commands came too late for their tick, ` +
      `so vehicles kept older ones or stood. ${CAUSE}`
    );
  return '';
}

function resumption() {
  if (hasControl()) return '“Resume” lets it go on.';
  if (mayTakeControl()) return 'Take control; then “Resume” lets it go on.';
  return 'The command “ergocast resume” lets it go on.';
}

function pause() {
  if (S.live && S.following) {
    return S.facts?.state?.paused ? `The mission is paused. ${resumption()}` : '';
  }
  return S.run.heldAt(S.run.rowAt(S.t)) ? 'The mission was paused at this time.' : '';
}

export function showNotices() {
  for (const [id, text] of [
    ['overload', overload()],
    ['pause', pause()],
  ]) {
    put($(id), text);
    if ($(id).hidden === Boolean(text)) $(id).hidden = !text;
  }
}
