// SPDX-License-Identifier: BSD-3-Clause
// Holds a mission as the page shows it, from a record or as it grows, without any drawing.
import { picture } from './cosine_sums.js';
import { Coverage } from './coverage.js';
import { Detection, FoundCurve } from './detection.js';
import { amendedTarget, firstDifference, plannedTarget } from './targets.js';
import { Track, addTracks, firstRowOf } from './tracks.js';

const TOLERANCE_S = 1e-6;

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
    this.wrong = 0;
    this.moreContacts = false; // whether the newest status may lack some, which are less likely
    this.contacts = []; // {x_m, y_m, probability, reports, t_s, confirmed}, as finds
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
      ...this.targets.slice(1).map(({ from, number }) => ({
        from,
        kind: 'target',
        sign: '◎',
        text: this.amendments.find(one => one.number === number)?.text ?? 'new target',
      })),
      ...this.amendments
        .filter(one => one.kind === 'dismiss')
        .map(({ from, text }) => ({ from, kind: 'dismiss', sign: '✕', text: text ?? 'contact dismissed' })),
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
  // Whether the battery of a track's vehicle is charged at a row: it has come slowly from the row before,
  // and is at its station.
  charges(track, row) {
    const { at_m: at, charges } = this.stationOf(track.id) ?? {};
    if (!charges || !track.has(row) || !track.has(row - 1)) return false;
    const { p, z } = track,
      apart = Math.hypot(p[2 * row] - at[0], p[2 * row + 1] - at[1], z ? z[row] - at[2] : 0);
    return apart <= charges.within_m && track.between(row - 1, row) < charges.below_mps * this.step;
  }
  stationOf(id) {
    return this.mission.stations?.find(station => station.id === id);
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
