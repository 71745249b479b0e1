// SPDX-License-Identifier: BSD-3-Clause
// Shows the agents: a table for eyes and screen readers, and a chip each for a large team.
import { S, ask } from './state.js';
import { stateOf } from '../data/agent_state.js';
import { $, element, ofModes, put, readable, grouped } from '../text.js';
import { meaningOf } from './words.js';

const MOST_WITHOUT_CHIPS = 12;

const own = (status, key, text = readable) => (typeof status?.[key] === 'number' ? text(status[key]) : '–');

// A live team reports its state; a record has the last report of each agent.
const COLUMNS = [
  {
    head: 'Battery',
    live: true,
    shown: ({ stations }) => stations?.some(({ battery }) => battery) ?? false,
    text: ({ status }) => own(status, 'charge', v => `${(100 * v).toFixed(0)} %`),
  },
  { head: 'Speed', text: ({ speed }) => (speed === null ? '–' : `${speed.toFixed(1)} m/s`) },
  {
    head: 'Distance',
    record: true,
    text: ({ way }) => (way === null ? '–' : `${grouped(Math.round(way))} m`),
  },
  {
    head: 'Oldest update',
    live: true,
    text: ({ status }) => own(status, 'max_staleness_s', v => `${v.toFixed(1)} s`),
  },
  {
    head: 'φ² vs team',
    live: true,
    text: ({ status, median }) => {
      const mine = status?.ergodic_metric;
      return typeof mine === 'number' && median > 0
        ? `${mine < median ? '−' : '+'}${Math.abs((100 * (mine - median)) / median).toFixed(1)} %`
        : '–';
    },
  },
  {
    head: 'Lag',
    live: true,
    long: true,
    text: ({ status }) => own(status, 'loop_lag_s', v => `${(1000 * v).toFixed(0)} ms`),
  },
  { head: 'Own φ²', metric: true, record: true, text: ({ last }) => own(last, 'ergodic_metric') },
  { head: 'Lost', text: ({ status, last }) => own(status ?? last, 'contributions_lost', grouped) },
  { head: 'Dropped', long: true, text: ({ status, last }) => own(status ?? last, 'kernel_drops', grouped) },
];

let rows = new Map(),
  columns = [],
  order = '';

function row(id) {
  const tr = element('tr'),
    cells = columns.map(({ long }) => element('td', long ? 'long' : ''));
  const number = element('span', 'number', String(id)),
    condition = element('span', 'condition ok');
  const first = element('th'),
    second = element('td');
  first.scope = 'row';
  first.append(number);
  second.append(condition);
  tr.append(first, second, ...cells);
  tr.tabIndex = 0;
  const chip = element('button', '', String(id));
  chip.setAttribute('aria-label', `Agent ${id}`);
  for (const node of [tr, chip]) {
    node.onpointerenter = () => hover(id);
    node.onpointerleave = () => hover(-1);
    node.onclick = () => pin(id);
  }
  tr.onfocus = () => hover(id);
  tr.onblur = () => hover(-1);
  tr.onkeydown = e => {
    if (e.key === 'Enter') pin(id);
  };
  return { tr, chip, condition, cells, kind: 'ok' };
}

// Makes rows for all agents of the run; again when others have joined.
export function buildTeam() {
  const live = S.run.history.length > 0 || S.live;
  columns = COLUMNS.filter(
    ({ record, live: alive, shown }) => (live ? !record : !alive) && (shown?.(S.run.mission) ?? true),
  );
  const heads = [{ head: '#' }, { head: 'State' }, ...columns].map(({ head, metric, long }) => {
    const th = element('th', long ? 'long' : '', head);
    th.scope = 'col';
    th.title = meaningOf('AGENTS', head) + (metric ? ofModes(S.run.mission) : '');
    return th;
  });
  $('heads').replaceChildren(...heads);
  rows = new Map(S.run.tracks.map(({ id }) => [id, row(id)]));
  order = '';
  $('rows').replaceChildren(...[...rows.values()].map(r => r.tr));
  $('chips').replaceChildren(...[...rows.values()].map(r => r.chip));
  $('chips').hidden = rows.size <= MOST_WITHOUT_CHIPS;
  colourTeam();
}

export function colourTeam() {
  for (const [id, { tr, chip }] of rows)
    for (const node of [tr, chip]) node.style.setProperty('--c', S.colours.agent(id));
}

export function hover(id) {
  if (id === S.hover) return;
  for (const [which, on] of [
    [S.hover, false],
    [id, true],
  ]) {
    const r = rows.get(which);
    if (r) for (const node of [r.tr, r.chip]) node.classList.toggle('hot', on);
  }
  S.hover = id;
  ask();
}

// Chooses an agent, or lets it go; a negative number lets all go.
export function pin(id) {
  if (id < 0) {
    for (const other of [...S.pins]) pin(other);
    return;
  }
  const on = !S.pins.has(id),
    r = rows.get(id);
  if (on) S.pins.add(id);
  else S.pins.delete(id);
  if (r) for (const node of [r.tr, r.chip]) node.classList.toggle('pin', on);
  if (r) r.chip.setAttribute('aria-pressed', on);
  $('showAll').hidden = !S.pins.size;
  ask();
}

// The agents' states now, by the order of their numbers; writes the table.
export function showTeam() {
  const { run, t } = S,
    at = run.rowAt(t),
    team = run.teamAt(t);
  if (rows.size !== run.tracks.length) buildTeam();
  const lasts = new Map(
    (Array.isArray(run.summary?.agents) ? run.summary.agents : []).filter(Boolean).map(a => [a.id, a]),
  );
  const all = run.tracks.map(track => {
    const state = stateOf(run, track, t),
      away = state.kind === 'silent' || state.kind === 'gone';
    return {
      track,
      state,
      status: state.status,
      last: lasts.get(track.id),
      median: team?.ergodic_metric,
      speed: away ? null : run.speedAt(track, at),
      way: at < track.first ? null : track.distance(Math.min(at, track.last)),
    };
  });
  for (const agent of all) {
    const r = rows.get(agent.track.id),
      { kind, text } = agent.state;
    if (r.kind !== kind) {
      r.kind = kind;
      r.condition.className = `condition ${kind}`;
      for (const name of ['silent', 'gone']) r.chip.classList.toggle(name, kind === name);
    }
    put(r.condition, text);
    columns.forEach((column, i) => put(r.cells[i], column.text(agent)));
  }
  sortRows(all);
  const trouble = all.filter(a => a.state.rank < 3).length;
  put($('teamNote'), trouble ? `${trouble} in trouble` : '');
  return { all, alive: all.filter(a => a.state.kind !== 'silent' && a.state.kind !== 'gone').length };
}

// Trouble first; never under the pointer or a finger.
function sortRows(all) {
  if ($('rows').matches(':hover') || $('rows').contains(document.activeElement)) return;
  const sorted = [...all]
    .sort((a, b) => a.state.rank - b.state.rank || a.track.id - b.track.id)
    .map(a => a.track.id);
  if (sorted.join() === order) return;
  order = sorted.join();
  $('rows').append(...sorted.map(id => rows.get(id).tr));
}
