// SPDX-License-Identifier: BSD-3-Clause
// Holds a mission as the page shows it, from a record or as it grows, without any drawing.
import { picture } from './cosine_sums.js';
import { Coverage } from './coverage.js';
import { Detection, FoundCurve } from './detection.js';
import { vehicleOf } from './motion.js';
import { amendedTarget, firstDifference, plannedTarget } from './targets.js';
import { Track, addTracks, firstRowOf } from './tracks.js';

const TOLERANCE_S = 1e-6;
const LONG_BLOCK_S = 1; // bodies that pass each other have shorter ones

// The last index with list[i] ≤ t; −1: none.
export function indexAt(list, t) {
  let low = 0,
    high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= t + TOLERANCE_S) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

export class Run {
  constructor(mission, stride, capacity) {
    this.mission = mission;
    this.size = mission.size_m;
    this.inBox = mission.size_m.length > 2;
    this.axes = [0, 1]; // of the map, and how many times as long they are drawn
    this.stretch = [1, 1];
    this.steps = this.size.map(() => 0); // metres to which places are rounded
    this.stride = stride;
    this.step = mission.dt_s * stride; // mission time between rows
    this.capacity = capacity;
    this.rows = 0;
    this.isCurrent = false; // whether all rows of a running team up to its newest status have come
    this.tracks = []; // ascending by id
    this.byId = new Map();
    this.metrics = { t: [], phi: [], found: [], spread: [], age: [], received: [], lost: [] };
    this.incidents = []; // {t, kind, sign, text, agent, until}, ascending
    this.holds = []; // [first tick that does not count, first that counts again or null]
    this.standing = new Set(); // agents that stand at the end, also if they moved up to it
    this.history = []; // {t, team} as live statuses came
    this.times = []; // their t
    // In ticks that count.
    this.restFrom = new Map((mission.stations ?? []).map(station => [station.id, station.rest_from]));
    this.recalledFrom = new Map(); // world's tick from which a recalled agent rests
    this.homeFrom = new Map(); // tick from which an agent goes home, where no status reports it
    this.summary = null;
    this.finds = []; // {object, agent, tick, t_s, x_m, y_m}, as a record or the newest status has them
    // {number, kind, from: tick, hash, tick_count}, ascending, as far as the page knows them
    this.amendments = [];
    // {number, closed, from, until: ticks, corners_m, heights_m}, ascending
    this.zones = [];
    this.received = new Map(); // coefficients of new targets, by hash
    this.targets = [plannedTarget(mission)]; // ascending by row
    this.coverage = new Coverage(this);
    this.detection = new Detection(this); // at the row that the page shows
    this.foundCurve = new FoundCurve(this);
  }
  get end() {
    return Math.max(0, this.rows - 1) * this.step;
  }
  heldAt(row) {
    const tick = row * this.stride;
    return this.holds.some(([from, until]) => from <= tick && tick < (until ?? Infinity));
  }
  setHolds(holds) {
    const pairs = Array.isArray(holds) ? holds.filter(Array.isArray) : [];
    if (JSON.stringify(pairs) === JSON.stringify(this.holds)) return;
    this.holds = pairs;
    this.noteEnds();
    this.forget(0);
  }
  // What was computed from rows since `row` is wrong now.
  forget(row) {
    this.coverage.reset(row);
    this.detection.reset();
    this.foundCurve.reset(row);
  }
  // What has changed since the plan, the coefficients of targets that are new to the page, by hash, and all
  // zones.
  setAmendments(list, coefficients = {}, zones = this.zones) {
    this.zones = zones;
    for (const [hash, mu] of Object.entries(coefficients)) this.received.set(hash, mu);
    const before = this.targets;
    const targetOf = amendment => {
      const target = amendedTarget(amendment, this.received.get(amendment.hash), this);
      return before.find(one => one.sameAs(target)) ?? target;
    };
    this.amendments = list;
    this.noteEnds();
    this.targets = [before[0], ...list.filter(one => one.kind === 'target').map(targetOf)];
    const changed = firstDifference(before, this.targets);
    if (changed < this.rows) this.forget(changed);
  }
  // How many ticks count, by the newest end.
  get tickCount() {
    return this.amendments.findLast(one => one.kind === 'end')?.tick_count ?? this.mission.tick_count;
  }
  // From when on agents rest at their stations. An agent that rests stays there when another end is named.
  noteEnds() {
    const { dt_s: dt, tick_count: planned, stations = [] } = this.mission,
      ends = this.amendments.filter(one => one.kind === 'end');
    for (const { id, rest_from: first } of stations) {
      let rest = first;
      for (const { from, tick_count: ticks } of ends)
        if (Math.round(this.counted(from * dt) / dt) < rest) rest = ticks - (planned - first);
      this.restFrom.set(id, rest);
    }
  }
  // The target that holds at a row.
  targetAt(row) {
    return this.targets.findLast(target => target.row <= row);
  }
  // The zones that are closed at a row.
  zonesAt(row) {
    const tick = row * this.stride;
    return this.zones.filter(zone => zone.closed <= tick && tick < zone.until);
  }
  // Whether the page has received all of them since the plan.
  get knowsTargets() {
    return (this.amendments[0]?.number ?? 0) === 0 && this.targets.every(target => target.known);
  }
  // Incidents, and the new targets, ends, zones and laws that hold by now, ascending.
  get marks() {
    const ends = this.amendments.filter(one => one.kind === 'end'),
      laws = this.amendments.filter(one => one.kind === 'law'),
      dt = this.mission.dt_s;
    const marks = [
      ...this.targets.slice(1).map(({ from }) => ({ from, kind: 'target', sign: '◎', text: 'new target' })),
      ...ends.map(({ from }) => ({ from, kind: 'end', sign: '⏱', text: 'another end' })),
      ...this.finds.map(({ object, agent, tick }) => ({
        from: tick,
        kind: 'find',
        sign: '◆',
        text: `${agent} found object ${object}`,
      })),
      ...laws.map(({ from }) => ({ from, kind: 'law', sign: '⚙', text: 'another law' })),
      ...this.amendments
        .filter(one => one.kind === 'reopen')
        .map(({ from }) => ({ from, kind: 'reopen', sign: '○', text: 'zone cancelled' })),
      ...this.zones.map(({ closed, from, until }) => ({
        from: until < from ? closed : from,
        until: until * dt,
        kind: 'zone',
        sign: '⊘',
        text: 'zone',
      })),
    ]
      .map(({ from, ...mark }) => ({ t: from * dt, ...mark }))
      .filter(({ t }) => t <= this.end + TOLERANCE_S);
    return marks.length ? [...this.incidents, ...marks].sort((a, b) => a.t - b.t) : this.incidents;
  }
  // Mission time at `t`, without the ticks that do not count.
  counted(t) {
    const tick = t / this.mission.dt_s;
    return (
      t -
      this.mission.dt_s *
        this.holds.reduce(
          (sum, [from, until]) => sum + Math.max(0, Math.min(tick, until ?? Infinity) - from),
          0,
        )
    );
  }
  rests(id, row) {
    return this.restsAt(id, row * this.stride, Math.round(this.counted(row * this.step) / this.mission.dt_s));
  }
  // The same at a tick, which has that number among those that count.
  restsAt(id, tick, counted) {
    return tick >= (this.recalledFrom.get(id) ?? Infinity) || counted >= (this.restFrom.get(id) ?? Infinity);
  }
  // The first row at which an agent rests; it rests at all later ones.
  firstRest(id) {
    if (!this.recalledFrom.has(id) && !this.restFrom.has(id)) return Infinity;
    let low = 0,
      high = this.rows;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.rests(id, middle)) high = middle;
      else low = middle + 1;
    }
    return low;
  }
  goesHome(id, row) {
    return row * this.stride >= (this.homeFrom.get(id) ?? Infinity);
  }
  rowAt(t) {
    return Math.max(0, Math.min(this.rows - 1, Math.round(t / this.step)));
  }
  track(id) {
    let track = this.byId.get(id);
    if (!track) {
      track = new Track(id, this.inBox);
      this.byId.set(id, track);
      this.tracks.push(track);
      this.tracks.sort((a, b) => a.id - b.id);
    }
    return track;
  }
  add(block) {
    for (const measure of [this.detection, this.foundCurve]) measure.rewind(firstRowOf(block));
    const first = addTracks(this, block);
    if (first < this.coverage.upto || first < (this.coverage.sums.length - 1) * 128)
      this.coverage.reset(first);
  }
  // cₖ at a row of a layer of the map: of what was achieved, or what is too much of it.
  coefficients(layer, row) {
    if (layer === 'target') return this.targetAt(row).coefficients;
    const c = this.coverage.at(row);
    if (layer !== 'difference') return c;
    const target = this.coverage.meanTarget();
    return c.map((v, k) => v - target[k]);
  }
  // The same on a grid, the north-west first.
  picture(layer, row, width, height) {
    return picture(this.coefficients(layer, row), this.coverage.M, this.coverage.N, width, height);
  }
  // Where an object may be that has not been found, in a picture (detection.js).
  missed(row, axis = 2, share = null) {
    return this.detection.missed(row, axis, share);
  }
  metricAt(t) {
    const i = indexAt(this.metrics.t, t);
    return i < 0 ? NaN : this.metrics.phi[i];
  }
  // How likely an object had been found by then.
  foundAt(t) {
    const i = indexAt(this.metrics.t, t);
    return this.metrics.found[i] ?? NaN;
  }
  // What the agents' statuses reported last before `t`; null: nothing is known of them.
  teamAt(t) {
    const i = indexAt(this.times, t);
    return i < 0 ? null : this.history[i].team;
  }
  standsAt(id, row) {
    return this.standing.has(id) && row >= this.byId.get(id).last;
  }
  // Whether the world reported that the agent moves, although the mission is paused.
  movesInPause(id, row) {
    return this.heldAt(row) && Boolean(this.teamAt(row * this.step)?.byId.get(id)?.moves);
  }
  // Metres per second over the last second: of one tick, noise is twice the speed.
  speedAt(track, row) {
    if (this.standsAt(track.id, row)) return 0;
    const n = Math.min(row - track.first, Math.max(1, Math.round(1 / this.step)));
    if (n < 1 || !track.has(row) || !track.has(row - n)) return null;
    return track.between(row - n, row) / (n * this.step);
  }
  // Agents are members in these ticks: [{id, active_from, active_until, recalled_from, …}], all their
  // incarnations.
  setRoster(entries) {
    const intervals = new Map(),
      row = tick => Math.ceil(tick / this.stride);
    let changed = Infinity;
    for (const { id, active_from: from, active_until: until, recalled_from: recalled } of entries) {
      if (typeof id !== 'number' || typeof from !== 'number') continue;
      if (!intervals.has(id)) intervals.set(id, []);
      intervals.get(id).push([row(from), typeof until === 'number' ? row(until) : Infinity]);
      if (typeof recalled !== 'number' || this.recalledFrom.get(id) === recalled) continue;
      this.recalledFrom.set(id, recalled);
      changed = Math.min(changed, row(recalled));
    }
    for (const [id, list] of intervals) {
      list.sort((a, b) => a[0] - b[0]);
      const track = this.byId.get(id);
      if (!track || String(track.member) === String(list)) continue;
      const parts = [...track.member, ...list].flat().filter(isFinite);
      // The rows before the first boundary that differs stay as they are.
      changed = Math.min(
        changed,
        ...parts.filter(r => track.isMember(r) !== list.some(([a, b]) => r >= a && r < b)),
        this.rows,
      );
      track.member = list;
    }
    if (changed < this.rows) this.forget(changed);
  }
}

// The objects of a list in a summary, which may be damaged.
function listOf(value) {
  return Array.isArray(value) ? value.filter(one => one && typeof one === 'object') : [];
}

// The finds of a summary, or of a status of a running team.
export const findsIn = told => listOf(told?.objects?.finds);

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
  run.setHolds(run.summary?.holds);
  run.recalledFrom = new Map(listOf(run.summary?.recalls).map(recall => [recall.agent, recall.from_tick]));
  run.homeFrom = new Map(Object.entries(record.home_from ?? {}).map(([id, tick]) => [Number(id), tick]));
  run.standing = new Set(record.standing);
  run.slope = record.slope;
  run.ticks = record.ticks;
  const agents = listOf(run.summary?.agents);
  run.setRoster(agents);
  const roster = rosterIncidents(agents, run.mission.dt_s, run.end);
  const heard = record.team?.incidents ?? [];
  run.incidents = withMore(
    [...heard, ...(heard.some(one => one.kind === 'paused') ? [] : pauses(run))],
    roster,
  );
  if (record.team) recordHistory(run, record.team);
  return run;
}

// What was heard, and what only the roster tells: of agents of which nothing was heard.
export function withMore(heard, roster) {
  const known = new Set(heard.map(incident => incident.agent));
  return [...heard, ...roster.filter(incident => !known.has(incident.agent))].sort((a, b) => a.t - b.t);
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
      }));
    return {
      t: at,
      team: { ergodic_metric: metric[i], agents: list, byId: new Map(list.map(agent => [agent.id, agent])) },
    };
  });
}

// The pauses that no status reports.
function pauses(run) {
  const {
    mission: { dt_s: dt },
    end,
  } = run;
  return run.holds.map(([from, until]) => ({
    t: from * dt,
    kind: 'paused',
    sign: '‖',
    text: 'paused by an operator',
    until: Math.min(end, (until ?? Infinity) * dt),
  }));
}

// Departures and returns in the roster.
export function rosterIncidents(entries, dt, end) {
  const incidents = [],
    byId = new Map();
  for (const entry of entries) {
    if (typeof entry.id !== 'number' || typeof entry.active_from !== 'number') continue;
    if (!byId.has(entry.id)) byId.set(entry.id, []);
    byId.get(entry.id).push(entry);
  }
  for (const [id, list] of byId) {
    list.sort((a, b) => a.active_from - b.active_from);
    list.forEach((entry, i) => {
      const from = entry.active_from * dt,
        left = list[i - 1]?.active_until;
      if (i > 0 && typeof left === 'number' && entry.active_from - left <= 1) {
        incidents.push({ t: from, kind: 'ok', sign: '↻', text: `${id} restarted`, agent: id });
      } else if (entry.active_from > 0) {
        incidents.push({
          t: from,
          kind: 'ok',
          sign: '+',
          text: `${id} ${i > 0 ? 'back' : 'joined'}`,
          agent: id,
        });
      }
      const until = entry.active_until,
        next = list[i + 1]?.active_from;
      if (typeof until === 'number' && !(next - until <= 1)) {
        incidents.push({
          t: until * dt,
          kind: 'gone',
          sign: '–',
          text: `${id} left`,
          agent: id,
          until: Math.min(end, (next ?? Infinity) * dt),
        });
      }
    });
  }
  return incidents.sort((a, b) => a.t - b.t);
}

// The state of an agent at a time, for marker and table. Rank: 0 worst. `blocked`: {by: the agent that
// blocks it, or null for an edge}.
export function stateOf(run, track, t) {
  const row = run.rowAt(t),
    team = run.teamAt(t),
    said = team?.byId.get(track.id);
  if (row < track.first) return { kind: 'gone', text: 'not joined yet', rank: 5, said };
  if (!track.isMember(row)) return { kind: 'gone', text: 'left', rank: 4, said };
  if (!said || said.state === 'ok') return { rank: 6, ...dutyOf(run, track, row, said), said };
  const kinds = { silent: 'silent', waiting: 'late', late: 'late', 'not heard': 'gone', gone: 'gone' };
  const kind = kinds[said.state] ?? 'ok';
  const text =
    said.state === 'silent'
      ? `silent ${said.silent_s.toFixed(0)} s`
      : said.state === 'not heard'
        ? 'no message yet'
        : said.state === 'waiting' && said.waiting_for
          ? `waits for ${said.waiting_for}`
          : said.state;
  return {
    kind,
    text,
    rank: { silent: 0, waiting: 1, late: 2, 'not heard': 3, gone: 4 }[said.state] ?? 6,
    said,
  };
}

// What an agent without trouble does: by its own report, or else by the plan and its track.
function dutyOf(run, track, row, said) {
  if (run.movesInPause(track.id, row))
    return vehicleOf(run, track.id) === 'FIXED_WING'
      ? { kind: 'idle', text: 'paused: circles' }
      : { kind: 'late', text: 'paused: still moves', rank: 3 };
  if (run.heldAt(row)) return { kind: 'idle', text: 'paused' };
  const phase =
    said?.phase ??
    (run.rests(track.id, row) ? 'resting' : run.goesHome(track.id, row) ? 'returning' : 'running');
  if (phase === 'resting') return { kind: 'idle', text: 'rests' };
  if (phase === 'returning') return { kind: 'ok', text: 'goes home' };
  if (said?.blocked_s >= LONG_BLOCK_S) {
    const by = typeof said.blocked_by === 'number' ? said.blocked_by : null;
    return { kind: 'ok', text: `blocked by ${by ?? 'an edge'}`, blocked: { by } };
  }
  return { kind: 'ok', text: phase === 'waiting' ? 'ready' : 'ok' };
}
