// SPDX-License-Identifier: BSD-3-Clause
// Makes rows, statuses, incidents and log lines of the frames that the server sends about a running team.
import { withMore } from './incidents.js';
import { contactsIn, findsIn, recordHistory, recordedRun, wrongIn } from './record.js';
import { Run, indexAt } from './run.js';
import { $, element } from '../text.js';

const MOST_LINES = 400,
  MOST_STATUSES = 20000,
  LATELY_MS = 10000,
  AGAIN_MS = 1000,
  MOST_FOUND_MS = 20; // in a frame

// Messages in the last two seconds of wall time, each second.
class Rate {
  constructor() {
    this.points = [];
    this.counts = new Map();
    this.total = 0;
  }
  add(agents) {
    for (const { incarnation, messages_sent: count } of agents) {
      // a new incarnation counts from 0
      if (typeof count !== 'number') continue;
      this.total += Math.max(0, count - (this.counts.get(incarnation) ?? 0));
      this.counts.set(incarnation, count);
    }
    const now = performance.now();
    this.points.push([now, this.total]);
    while (this.points.length > 2 && now - this.points[0][0] > 2000) this.points.shift();
    const [[t0, n0]] = this.points;
    return now - t0 > 100 ? Math.max(0, (1000 * (this.total - n0)) / (now - t0)) : 0;
  }
}

// The share of commands that came too late, of those of the last ten seconds of wall time.
class Lateness {
  constructor() {
    this.points = [];
  }
  add({ tick: ticks, missed_deadlines: missed, agents }) {
    const now = performance.now();
    this.points.push([now, ticks, missed]);
    while (this.points.length > 2 && now - this.points[0][0] > LATELY_MS) this.points.shift();
    const [[, firstTick, firstMissed]] = this.points,
      commands = (ticks - firstTick) * agents.length;
    return commands > 0 ? Math.min(1, (missed - firstMissed) / commands) : 0;
  }
}

const sum = (agents, key) =>
  agents.reduce((total, agent) => total + (typeof agent[key] === 'number' ? agent[key] : 0), 0);

export function addLog(lines) {
  const log = $('log'),
    low = log.scrollHeight - log.scrollTop - log.clientHeight < 24;
  $('logBox').hidden = false;
  for (const line of lines) {
    const css = /\b(error|killed|failed)\b/.test(line) ? 'bad' : /\bwarn/.test(line) ? 'warn' : '';
    log.append(element('li', css, line.replace(/^\d{4}-\d\d-\d\dT/, '')));
  }
  while (log.childElementCount > MOST_LINES) log.firstChild.remove();
  if (low) log.scrollTop = log.scrollHeight;
}

// φ² each mission second from all positions; if the page lacks some of them, a target, or the modes of the
// free domain, what the agents report. A few lost rows would change a small φ² much.
function addMetrics(run) {
  const { told } = run,
    every = Math.max(1, Math.round(1 / run.step)),
    whole =
      !run.mission.free_domain &&
      run.knowsTargets &&
      run.tracks.some(track => track.first === 0) &&
      !run.tracks.some(track => track.hasGaps);
  if (!whole) {
    if (run.metrics !== told) told.found = [];
    run.metrics = told;
    addFound(run);
    return;
  }
  if (run.metrics === told) {
    run.metrics = emptyCurves();
    run.nextMetric = 0;
  }
  const { metrics } = run;
  for (let row = run.nextMetric ?? 0; row < run.rows; row += every) {
    const value = run.coverage.metric(row),
      t = row * run.step,
      i = indexAt(told.t, t);
    if (value === value) {
      metrics.t.push(t);
      metrics.phi.push(value);
      for (const key of OF_STATUSES) metrics[key].push(told[key][i] ?? NaN);
    }
    run.nextMetric = row + every;
  }
  addFound(run);
}

// How likely an object has been found, unless the page lacks places of the beginning. The list may be shorter
// than that of times: the next frame goes on where the time for this one was over.
function addFound(run) {
  const { metrics, foundCurve } = run,
    { t, found } = metrics,
    isWhole = run.tracks.some(track => track.first === 0),
    since = isWhole === run.foundIsWhole ? foundCurve.takeChanged() : 0,
    stop = performance.now() + MOST_FOUND_MS;
  run.foundIsWhole = isWhole;
  while (found.length && run.rowAt(t[found.length - 1]) >= since) found.pop();
  while (found.length < t.length) {
    const row = run.rowAt(t[found.length]);
    if (isWhole && !foundCurve.build(row, stop)) break;
    found.push(isWhole ? foundCurve.at(row) : NaN);
  }
}

const OF_STATUSES = ['spread', 'age', 'received', 'lost'];
const emptyCurves = () => ({ t: [], phi: [], found: [], spread: [], age: [], received: [], lost: [] });

// What the statuses report, at most MOST_STATUSES of them: then every second one is kept.
function addTold(told, { agents, t_s: t, ergodic_metric: phi }) {
  if (typeof phi !== 'number' || !(t > (told.t[told.t.length - 1] ?? -1))) return;
  const own = agents.map(a => a.ergodic_metric).filter(v => typeof v === 'number'),
    ages = agents.map(a => a.max_staleness_s).filter(v => typeof v === 'number');
  const now = {
    t,
    phi,
    spread: own.length ? Math.max(...own) - Math.min(...own) : NaN,
    age: ages.length ? Math.max(...ages) : NaN,
    received: sum(agents, 'contributions_received'),
    lost: sum(agents, 'contributions_lost'),
  };
  for (const key of Object.keys(now)) {
    const list = told[key];
    list.push(now[key]);
    if (list.length <= MOST_STATUSES) continue;
    told[key] = list.filter((_, i) => i % 2 === 0);
    told.found = [];
  }
}

// What was told before this browser came: lists of numbers, null where one is not known.
const toldBefore = past =>
  Object.fromEntries(Object.keys(emptyCurves()).map(key => [key, (past[key] ?? []).map(v => v ?? NaN)]));

// Connects; `page` has began(run), changed(facts), controlled(state), ended(run, why) and lost(text).
export function watchLive(page) {
  const rate = new Rate(),
    lateness = new Lateness(),
    handlers = new Map(); // by the name of the event
  let stream = null,
    run = null,
    facts = null,
    over = false;
  const on = (name, handle) => handlers.set(name, event => handle(JSON.parse(event.data)));
  on('mission', message => {
    // also after a new connection, which repeats everything
    const before = run;
    run = new Run(
      message.mission,
      message.stride,
      Math.ceil(message.mission.tick_count / message.stride) + 1,
    );
    const same = before && facts.run === message.run_id;
    if (same) {
      run.history = before.history;
      run.times = before.times;
      run.wordsSpoken = before.wordsSpoken;
    } else if (message.team) recordHistory(run, message.team);
    run.told = toldBefore(message.past);
    facts = {
      run: message.run_id,
      rate: 0,
      lost: 0,
      missed: 0,
      late: 0,
      authenticated: message.authenticated,
      replay: message.replay,
      clients: [],
      state: same ? facts.state : null, // so an order always names a tick that was shown
    };
    page.began(run, facts);
  });
  on('frame', frame => {
    if (frame.log) addLog(frame.log);
    if (!run) return;
    if (frame.amendments) run.setAmendments(frame.amendments, frame.targets, frame.zones);
    if (frame.tracks) run.add(frame.tracks);
    if (frame.roster) run.setRoster(frame.roster);
    if (frame.incidents) {
      run.incidents = frame.incidents;
      run.newIncidents = true;
    }
    if (frame.team) {
      const { team } = frame,
        { agents } = team,
        t = Math.min(team.t_s ?? 0, Math.max(run.end, 0));
      run.isCurrent = true;
      team.byId = new Map(agents.map(agent => [agent.id, agent]));
      addTold(run.told, team);
      run.setHolds(team.holds);
      run.finds = findsIn(team);
      run.wrong = wrongIn(team);
      run.contacts = contactsIn(team);
      run.moreContacts = Boolean(team.more_contacts);
      const standing = team.state === 'running' ? [] : agents.filter(agent => agent.moves === false);
      run.standing = new Set(standing.map(agent => agent.id));
      if (run.times.length && run.times[run.times.length - 1] >= t) {
        run.times.pop();
        run.history.pop();
      }
      if (run.times.length < MOST_STATUSES) {
        run.times.push(t);
        run.history.push({ t, team });
      }
      Object.assign(facts, {
        rate: rate.add(agents),
        lost: sum(agents, 'contributions_lost'),
        missed: team.missed_deadlines,
        late: lateness.add(team),
        state: team,
        clients: team.clients ?? [],
      });
    }
    addMetrics(run);
    page.changed(facts);
  });
  on('end', async message => {
    over = true;
    stream.close();
    let whole = run;
    if (message.record) {
      const answer = await fetch('record.json');
      if (answer.ok) whole = withHistory(recordedRun(await answer.json()), run);
    }
    page.ended(whole, message.text);
  });
  on('control', message => page.controlled(message));
  on('notice', message => page.lost(message.text));
  // After a refusal, such as 503, the browser itself does not try again.
  const connect = () => {
    stream = new EventSource('events');
    for (const [name, handle] of handlers) stream.addEventListener(name, handle);
    stream.onopen = () => page.lost('');
    stream.onerror = () => {
      if (over) return;
      page.lost('No connection to ergocast watch; it is tried again.');
      if (stream.readyState === EventSource.CLOSED) setTimeout(connect, AGAIN_MS);
    };
  };
  connect();
}

// The record, with what only the live page has heard.
function withHistory(record, live) {
  if (!live || record.history.length) return record;
  record.history = live.history;
  record.times = live.times;
  record.incidents = withMore(live.incidents, record.incidents);
  return record;
}
