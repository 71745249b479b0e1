// SPDX-License-Identifier: BSD-3-Clause
// Shows the line at the top: mission, time, φ² and state at the chosen time.
import { S } from './state.js';
import { QUANTITIES, readingAt } from './chart.js';
import { showTeam } from './team.js';
import { showNotices } from './notices.js';
import { $, chance, ofModes, put, readable } from '../text.js';

let textAt = 0;

function missionState(all) {
  const worst = all.find(agent => agent.state.rank === 0),
    { summary, end } = S.run;
  if (worst) return [`${worst.track.id} silent`, 'bad'];
  if (S.live && S.following) {
    const state = S.facts?.state?.paused ? 'paused' : (S.facts?.state?.state ?? 'waiting');
    return [state, state === 'failed' ? 'bad' : state === 'running' ? '' : 'idle'];
  }
  if (S.t < end && S.run.heldAt(S.run.rowAt(S.t))) return ['paused', 'idle'];
  if (S.t < end || S.live) return ['running', ''];
  const result = typeof summary?.result === 'string' ? summary.result : 'no result';
  return [result, result === 'done' ? '' : result === 'failed' ? 'bad' : 'warn'];
}

export function drawHeadline(now) {
  const { run, t } = S;
  put($('nowTime'), run.counted(t).toFixed(1));
  put($('nowMetric'), readable(run.metricAt(t)));
  put($('nowFound'), chance(run.foundAt(t)));
  $('slider').value = run.rowAt(t);
  if (S.playing && now - textAt < 150) return;
  textAt = now;
  const { all, alive } = showTeam(),
    [text, css] = missionState(all);
  put($('nowAlive'), `${alive}/${Math.max(all.length, S.facts?.state?.agents_expected ?? 0)}`);
  $('nowAlive').style.color = alive < all.length ? S.colours.bad : '';
  showNotices();
  put($('state'), text);
  $('state').className = `pill ${css}`;
  $('markers').setAttribute(
    'aria-label',
    `Map of ${run.mission.name} at ${t.toFixed(1)} s: ${alive} of ${all.length} agents alive, ` +
      `φ²${ofModes(run.mission)} ${readable(run.metricAt(t))}, found ${chance(run.foundAt(t))}`,
  );
  $('chart').setAttribute('aria-label', `${QUANTITIES[S.quantity].title}: ${readingAt(run, S.quantity, t)}`);
  put(
    $('nowEnd'),
    `of ${(S.live ? (run.tickCount - 1) * run.mission.dt_s : run.counted(run.end)).toFixed(0)} s`,
  );
}
