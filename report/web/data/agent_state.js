// SPDX-License-Identifier: BSD-3-Clause
// What an agent does at a time, in the words of its marker and its row of the table.
import { vehicleOf } from './motion.js';

const LONG_BLOCK_S = 1; // bodies that pass each other have shorter ones

// The state of an agent at a time, for marker and table. Rank: 0 worst. `blocked`: {by: the agent that
// blocks it, or null for an edge}.
export function stateOf(run, track, t) {
  const row = run.rowAt(t),
    team = run.teamAt(t),
    status = team?.byId.get(track.id);
  if (row < track.first) return { kind: 'gone', text: 'not joined yet', rank: 5, status };
  if (!track.isMember(row)) return { kind: 'gone', text: 'left', rank: 4, status };
  if (!status || status.state === 'ok') return { rank: 6, ...dutyOf(run, track, row, status), status };
  const kinds = { silent: 'silent', waiting: 'late', late: 'late', 'not heard': 'gone', gone: 'gone' };
  const kind = kinds[status.state] ?? 'ok';
  const text =
    status.state === 'silent'
      ? `silent ${status.silent_s.toFixed(0)} s`
      : status.state === 'not heard'
        ? 'no message yet'
        : status.state === 'waiting' && status.waiting_for
          ? `waits for ${status.waiting_for}`
          : status.state;
  return {
    kind,
    text,
    rank: { silent: 0, waiting: 1, late: 2, 'not heard': 3, gone: 4 }[status.state] ?? 6,
    status,
  };
}

// What an agent without trouble does: by its own report, or else by the plan and its track.
function dutyOf(run, track, row, status) {
  if (run.movesInPause(track.id, row))
    return vehicleOf(run, track.id) === 'FIXED_WING'
      ? { kind: 'idle', text: 'paused: circles' }
      : { kind: 'late', text: 'paused: still moves', rank: 3 };
  if (run.heldAt(row)) return { kind: 'idle', text: 'paused' };
  const phase =
    status?.phase ??
    (run.rests(track.id, row) ? 'resting' : run.goesHome(track.id, row) ? 'returning' : 'running');
  if (phase === 'resting') return { kind: 'idle', text: 'rests' };
  if (phase === 'returning') return { kind: 'ok', text: status?.charges ? 'charging' : 'goes home' };
  if (status?.blocked_s >= LONG_BLOCK_S) {
    const by = typeof status.blocked_by === 'number' ? status.blocked_by : null;
    return { kind: 'ok', text: `blocked by ${by ?? 'an edge'}`, blocked: { by } };
  }
  return { kind: 'ok', text: phase === 'waiting' ? 'ready' : 'ok' };
}
