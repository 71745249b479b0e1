// SPDX-License-Identifier: BSD-3-Clause
// Makes a run of a record: of all its rows, and of how the agents were over time.
import { pausesOf, rosterIncidents, withMore } from './incidents.js';
import { Run } from './run.js';

// The objects of a list in a summary, which may be damaged.
function listOf(value) {
  return Array.isArray(value) ? value.filter(one => one && typeof one === 'object') : [];
}

// The finds of a summary, or of a status of a running team.
export const findsIn = told => listOf(told?.objects?.finds);
// The contacts of a summary or status, the likeliest first.
export const contactsIn = told => listOf(told?.contacts);
// How many contacts were confirmed and are no objects.
export const wrongIn = told => Number(told?.wrong_confirmations) || 0;

// A record as report/page.h writes it.
export function recordedRun(record) {
  const run = new Run(record.mission, record.stride, record.rows);
  if (record.amendments) run.setAmendments(record.amendments, record.targets, record.zones);
  run.add(record.tracks);
  run.metrics = record.metrics;
  run.summary =
    record.summary && typeof record.summary === 'object' && !Array.isArray(record.summary)
      ? record.summary
      : null;
  run.finds = findsIn(run.summary);
  run.wrong = wrongIn(run.summary);
  run.contacts = contactsIn(run.summary);
  run.setHolds(run.summary?.holds);
  run.recalledFrom = new Map(listOf(run.summary?.recalls).map(recall => [recall.agent, recall.from_tick]));
  run.homeFrom = new Map(Object.entries(record.home_from ?? {}).map(([id, tick]) => [Number(id), tick]));
  run.standing = new Set(record.standing);
  run.slope = record.slope;
  run.ticks = record.ticks;
  const agents = listOf(run.summary?.agents);
  run.setRoster(agents);
  const roster = rosterIncidents(agents, run.mission.dt_s, run.end);
  const received = record.team?.incidents ?? [];
  run.incidents = withMore(
    [...received, ...(received.some(one => one.kind === 'paused') ? [] : pausesOf(run))],
    roster,
  );
  if (record.team) recordHistory(run, record.team);
  return run;
}

// How the agents were, as cli/team/agent_history.h writes it, in the shape of live statuses.
export function recordHistory(run, { t, metric, agents, words, phases }) {
  run.times = t;
  run.history = t.map((at, i) => {
    const list = Object.entries(agents)
      .filter(([, own]) => own.state[i] !== null)
      .map(([id, own]) => ({
        id: Number(id),
        state: words[own.state[i]],
        phase: phases[own.phase[i]],
        silent_s: own.silent_s[i],
        waiting_for: own.waits_for[i],
        ergodic_metric: own.metric[i],
        max_staleness_s: own.age_s[i],
        loop_lag_s: own.lag_s[i],
        contributions_lost: own.lost[i],
        kernel_drops: own.drops[i],
        blocked_s: own.blocked_s?.[i],
        blocked_by: own.blocked_by?.[i],
        charge: own.charge?.[i],
        charges: own.charges?.[i],
      }));
    return {
      t: at,
      team: { ergodic_metric: metric[i], agents: list, byId: new Map(list.map(agent => [agent.id, agent])) },
    };
  });
}
