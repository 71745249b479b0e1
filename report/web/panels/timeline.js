// SPDX-License-Identifier: BSD-3-Clause
// Controls time: play, step, the slider, and the incidents above it.
import { S, SPEEDS, ask } from './state.js';
import { $, clamp, element } from '../text.js';

const COLOUR = {
  silent: 'var(--bad)',
  gone: 'var(--gone)',
  late: 'var(--warn)',
  ok: 'var(--ok)',
  paused: 'var(--muted)',
  target: 'var(--accent)',
  end: 'var(--muted)',
  find: 'var(--accent)',
  zone: 'var(--bad)',
  law: 'var(--muted)',
  reopen: 'var(--muted)',
  dismiss: 'var(--muted)',
};
let last = 0;

export function seek(t) {
  S.t = clamp(t, 0, S.run.end);
  S.following = S.live && S.t >= S.run.end - 1e-9;
  showFollowing();
  ask();
}

export function follow() {
  setPlaying(false);
  seek(S.run.end);
}

export function showFollowing() {
  $('follow').hidden = !S.live;
  $('follow').setAttribute('aria-pressed', S.following);
}

export function setPlaying(on) {
  if (on && S.t >= S.run.end && !S.live) S.t = 0;
  S.playing = on;
  last = performance.now();
  $('play').setAttribute('aria-pressed', on);
  $('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
  ask();
}

// Moves on by the time since the last frame.
export function advance(now) {
  if (S.playing) {
    S.t = Math.min(S.t + (Math.min(now - last, 100) / 1000) * S.speed, S.run.end);
    if (S.t >= S.run.end) {
      setPlaying(false);
      S.following = S.live;
      showFollowing();
    }
  } else if (S.following) {
    S.t = S.run.end;
  }
  last = now;
}

export function step(direction, long) {
  setPlaying(false);
  seek(long ? S.t + 10 * direction : (S.run.rowAt(S.t) + direction) * S.run.step);
}

export function faster(direction) {
  S.speed = SPEEDS[clamp(SPEEDS.indexOf(S.speed) + direction, 0, SPEEDS.length - 1)];
  $('speed').value = S.speed;
}

export function jump(direction) {
  const times = S.run.marks.map(mark => mark.t);
  const t = direction > 0 ? times.find(at => at > S.t + 1e-6) : times.findLast(at => at < S.t - 1e-6);
  if (t !== undefined) seek(t);
}

// The amendment of that kind that holds from `t` on.
function amendmentAt(kind, t) {
  const { amendments, mission } = S.run;
  return amendments.find(one => one.kind === kind && Math.abs(one.from * mission.dt_s - t) < 1e-6);
}

// "amendment 0: new target at 20.0 s, by anna@base".
function phrase(amendment, text, t) {
  const law = amendment?.law ? ` (${amendment.law})` : '',
    words = `${text}${law} at ${S.run.counted(t).toFixed(1)} s`;
  if (!amendment) return words;
  return `amendment ${amendment.number}: ${words}${amendment.by ? `, by ${amendment.by}` : ''}`;
}

function inWords({ kind, text, t, until }) {
  const words = phrase(amendmentAt(kind === 'paused' ? 'pause' : kind, t), text, t),
    resumed = kind === 'paused' && until ? amendmentAt('resume', until) : undefined;
  return resumed ? `${words}, ${phrase(resumed, 'resumed', until)}` : words;
}

const narrow = () => innerWidth <= 820;

// Incidents closer than a glyph share one; their labels shorten to the room there is.
export function buildStrip() {
  const { run } = S,
    box = $('strip'),
    width = box.clientWidth,
    at = t => (t / Math.max(run.end, run.step)) * width,
    groups = [];
  box.replaceChildren();
  for (const incident of run.marks) {
    const group = groups[groups.length - 1];
    if (group && at(incident.t) - at(group[group.length - 1].t) < 16) group.push(incident);
    else groups.push([incident]);
  }
  groups.forEach((group, i) => {
    for (const incident of group)
      if (incident.until) {
        const bar = element('i');
        bar.style.left = `${at(incident.t)}px`;
        bar.style.width = `${Math.max(3, at(Math.min(incident.until, run.end)) - at(incident.t))}px`;
        bar.style.color = COLOUR[incident.kind];
        box.append(bar);
      }
    const [first] = group,
      next = i + 1 < groups.length ? at(groups[i + 1][0].t) - 9 : width + 8;
    const button = element('button'),
      sign = element('b');
    sign.append(element('span', '', first.sign));
    button.append(sign);
    button.style.left = `${at(first.t)}px`;
    button.style.color = COLOUR[first.kind];
    button.title = group.map(inWords).join(', ');
    button.setAttribute('aria-label', button.title);
    button.onclick = () => seek(first.t);
    box.append(button);
    const whole = group.map(incident => incident.text).join(', ');
    if (!narrow())
      for (const text of [whole, first.text, String(first.agent ?? ''), '']) {
        button.append(text);
        if (!text || at(first.t) + button.offsetWidth - 7 <= next) break;
        button.lastChild.remove();
      }
  });
  buildScale();
}

function buildScale() {
  const { end } = S.run,
    most = narrow() ? 5 : 12,
    scale = $('scaleOfTime');
  const power = 10 ** Math.floor(Math.log10(Math.max(end, 1e-3) / most)),
    step = [1, 2, 5, 10].find(m => end / (m * power) <= most) * power;
  const spans = [];
  for (let t = 0; t < end - step * 0.6; t += step) spans.push([t, String(+t.toPrecision(6))]);
  spans.push([end, `${end.toFixed(end < 10 ? 1 : 0)} s`]);
  scale.replaceChildren(
    ...spans.map(([t, text]) => {
      const span = element('span', '', text);
      span.style.left = `${end ? (t / end) * 100 : 100}%`;
      return span;
    }),
  );
}
