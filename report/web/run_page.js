// SPDX-License-Identifier: BSD-3-Clause
// The page of a run: brings data, drawing and controls together.
import { STOPS, themeColours } from './colours.js';
import { S, SPEEDS, LAYERS, ask, focusOf, mapState, onFrame, startTail } from './state.js';
import { TAILS, View, paintMarkers, paintShading, paintTracks, rowsPerPiece, trailOf } from './map.js';
import { QUANTITIES, paintChart, readingAt, scalesOf } from './chart.js';
import { recordedRun, stateOf } from './run.js';
import { advance, buildStrip, faster, follow, jump, seek, setPlaying, showFollowing, step } from './timeline.js';
import { buildTeam, colourTeam, hover, pin, showTeam } from './team.js';
import { showDetails, showFacts } from './details.js';
import { savePng, saveSvg, saveVideo, svgText } from './save.js';
import { addLog, watchLive } from './live.js';
import { $, clamp, put, readable } from './text.js';

const NO_KEY = 'The team has no key: any host on the network may have sent what is shown';

const view = new View();
let scale = 1, live = null, shadingKey = '', trail = { key: '', row: -1, upto: 0 }, textAt = 0, frames = [];

// --- drawing: each layer only when it changes ---

function context(id) {
  const g = $(id).getContext('2d');
  g.setTransform(scale, 0, 0, scale, 0, 0);
  return g;
}

function drawShading() {
  const row = S.run.rowAt(S.t), key = [S.layer, S.layer === 'target' ? '' : row, view.key, S.theme, S.run.id].join();
  if (key === shadingKey) return;
  shadingKey = key;
  paintShading(context('shading'), S.run, view, mapState());
}

// The whole history grows on its canvas; a bounded trail is drawn anew.
function drawTrails() {
  const { run } = S, row = run.rowAt(S.t), key = [run.id, S.tail, view.key, S.theme, S.hover, ...S.pins].join();
  if (key === trail.key && row === trail.row) return;
  const g = context('trails'), state = mapState(), part = trailOf(run, state), whole = TAILS[S.tail] === Infinity;
  if (!whole || key !== trail.key || row < trail.upto) {
    g.clearRect(0, 0, view.width, view.height);
    trail.upto = 0;
  }
  if (whole) {
    part.from = trail.upto;
    part.to = row - (row % rowsPerPiece(run, view, true));
    trail.upto = part.to;
  }
  if (TAILS[S.tail] && part.to > part.from) paintTracks(g, run, view, part);
  trail.key = key;
  trail.row = row;
}

function drawMarkers() {
  const g = context('markers');
  g.clearRect(0, 0, view.width, view.height);
  paintMarkers(g, S.run, view, mapState());
}

function drawChart() {
  const canvas = $('chart'), g = context('chart');
  g.clearRect(0, 0, canvas.clientWidth, canvas.clientHeight);
  paintChart(g, S.run, S, canvas.clientWidth, canvas.clientHeight);
  put($('reading'), S.pointer >= 0 ? readingAt(S.run, S.quantity, S.pointer) : '');
}

function missionState(all) {
  const worst = all.find(agent => agent.state.rank === 0), { summary, end } = S.run;
  if (worst) return [`${worst.track.id} silent`, 'bad'];
  if (S.live && S.following) {
    const state = live?.state?.state ?? 'waiting';
    return [state, state === 'failed' ? 'bad' : state === 'running' ? '' : 'idle'];
  }
  if (S.t < end || S.live) return ['running', ''];
  const result = typeof summary?.result === 'string' ? summary.result : 'no result';
  return [result, result === 'done' ? '' : result === 'failed' ? 'bad' : 'warn'];
}

function drawText(now) {
  const { run, t } = S;
  put($('nowTime'), t.toFixed(1));
  put($('nowMetric'), readable(run.metricAt(t)));
  $('slider').value = run.rowAt(t);
  if (S.playing && now - textAt < 150) return;
  textAt = now;
  const { all, alive } = showTeam(), [text, css] = missionState(all);
  put($('nowAlive'), `${alive}/${Math.max(all.length, live ? live.state?.agents_expected ?? 0 : 0)}`);
  $('nowAlive').style.color = alive < all.length ? S.colours.bad : '';
  put($('state'), text);
  $('state').className = `pill ${css}`;
  $('markers').setAttribute('aria-label', `Map of ${run.mission.name} at ${t.toFixed(1)} s: ${alive} of ${all.length} agents alive, φ² ${readable(run.metricAt(t))}`);
  $('chart').setAttribute('aria-label', `${QUANTITIES[S.quantity].title}: ${readingAt(run, S.quantity, t)}`);
  put($('nowEnd'), `of ${(S.live ? (run.mission.tick_count - 1) * run.mission.dt_s : run.end).toFixed(0)} s`);
}

function frame(now) {
  if (!S.run) return;
  const begin = performance.now();
  advance(now);
  drawShading();
  drawTrails();
  drawMarkers();
  drawChart();
  drawText(now);
  frames.push(performance.now() - begin);
  if (frames.length > 600) frames.shift();
  if (S.playing) ask();
}

// --- layout ---

function layout() {
  if (!S.run) return;
  const [lx, ly] = S.run.size, main = document.querySelector('main'), narrow = innerWidth <= 820;
  document.documentElement.style.setProperty('--aspect', clamp(lx / ly, 0.5, 4));
  main.classList.toggle('wide', lx / ly > 1.2);
  if (!narrow) {
    const wanted = clamp(((main.clientHeight - 42) * lx) / ly, 420, main.clientWidth * 0.68);
    main.style.setProperty('--mapWidth', `${Math.round(Math.min(wanted, main.clientWidth - 430))}px`);
  }
  scale = Math.min(devicePixelRatio || 1, 2);
  view.resize($('stage').clientWidth, $('stage').clientHeight);
  for (const id of ['shading', 'trails', 'markers', 'chart']) {
    const canvas = $(id), width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
  }
  view.place(S.run.size);
  redraw();
  buildStrip();
}

function redraw() {
  shadingKey = trail.key = '';
  $('fit').hidden = view.zoom === 1;
  ask();
}

function setTheme(theme) {
  document.documentElement.dataset.theme = S.theme = theme;
  S.colours = themeColours(theme);
  colourTeam();
  showLegend();
  redraw();
}

// --- what is shown ---

function showLegend() {
  const difference = S.layer === 'difference', full = S.run?.density.full ?? 2, times = v => `${v.toFixed(v < 10 ? 1 : 0)}×`;
  put($('scaleLow'), difference ? `too little −${times(full / 2)}` : '0');
  put($('scaleHigh'), difference ? `+${times(full / 2)} too much` : `≥ ${times(full)} uniform`);
  const ramp = $('ramp'), g = ramp.getContext('2d'), image = g.createImageData(ramp.width, 1), pixels = new Uint32Array(image.data.buffer);
  const table = S.colours[difference ? 'difference' : 'amount'];
  pixels.forEach((_, i) => { pixels[i] = table[Math.floor((i / (pixels.length - 1)) * 255)]; });
  g.putImageData(image, 0, 0);
  for (const [id, value] of [['layer', S.layer], ['axis', S.axis]]) {
    for (const button of $(id).children) button.setAttribute('aria-pressed', button.dataset.value === value);
  }
  $('guide').setAttribute('aria-pressed', S.guide);
  $('guide').hidden = S.quantity !== 'phi';
  $('quantity').value = S.quantity;
  const seconds = TAILS[S.tail];
  put($('tailText'), seconds === Infinity ? 'all' : seconds ? `${seconds} s` : 'off');
  $('tail').value = S.tail;
}

function set(key, value) {
  S[key] = value;
  showLegend();
  ask();
}

let runs = 0;
function show(run) {
  run.id = ++runs;
  const first = !S.run;
  S.run = run;
  put($('name'), run.mission.name);
  document.title = `${run.mission.name} – Ergocast`;
  $('slider').max = Math.max(0, run.rows - 1);
  $('slider').step = 1;
  $('radioLabel').hidden = !(run.mission.radio_range_m > 0);
  if (first) S.tail = startTail(run);
  buildTeam();
  showLegend();
  layout();
}

// Checkpoints are made in slices, so that the page answers meanwhile.
function buildCheckpoints(run) {
  if (S.run === run && !run.coverage.build(6)) setTimeout(() => buildCheckpoints(run), 0);
  else run.ready = true;
}

function showRecord(run, at) {
  S.live = S.following = false;
  live = null;
  show(run);
  showFollowing();
  showFacts(null);
  seek(Math.min(at ?? run.end, run.end));
  buildCheckpoints(run);
}

const livePage = {
  began(run, facts) {
    live = facts;
    S.live = S.following = true;
    show(run);
    showFollowing();
  },
  changed(facts) {
    live = facts;
    const { run } = S;
    $('slider').max = Math.max(0, run.rows - 1);
    if (run.newIncidents) {
      const last = run.incidents[run.incidents.length - 1];
      if (last) put($('spoken'), `${last.text} at ${last.t.toFixed(0)} s`);
      run.newIncidents = false;
      buildStrip();
    }
    if (performance.now() - (run.stripAt ?? 0) > 500) { run.stripAt = performance.now(); buildStrip(); showFacts(facts); }
    if (run.tracks.length > 12 && !run.tailChosen) { run.tailChosen = true; set('tail', startTail(run)); }
    put($('seal'), facts.replay ? 'replay' : facts.authenticated ? '' : 'not authenticated');
    $('seal').title = facts.replay ? 'ergocast replay sends a record: nobody flies' : NO_KEY;
    $('seal').hidden = facts.authenticated && !facts.replay;
    ask();
  },
  ended(run, text) {
    const at = S.following ? undefined : S.t;
    if (run) showRecord(run, at);
    this.lost('');
    put($('spoken'), `The mission has ended: ${text}`);
  },
  lost(text) {
    put($('banner'), text);
    $('banner').hidden = !text;
  },
};

// --- controls ---

const toggle = (dialog, open) => { if (!dialog.open) open(); };
const showKeys = () => toggle($('keys'), () => $('keys').showModal());
const openDetails = () => S.run && toggle($('details'), showDetails);
const closeMenu = () => { $('saveMenu').hidden = true; $('saveButton').setAttribute('aria-expanded', 'false'); };
function zoom(factor, px = view.width / 2, py = view.height / 2) {
  view.zoomAt(factor, px, py, S.run.size);
  redraw();
}
function fit() {
  view.zoom = 1;
  view.place(S.run.size);
  redraw();
}

function connectButtons() {
  for (const [value, { title }] of Object.entries(QUANTITIES)) $('quantity').append(new Option(title, value));
  for (const speed of SPEEDS) $('speed').append(new Option(`${speed}×`, speed, speed === S.speed, speed === S.speed));
  $('quantity').onchange = e => set('quantity', e.target.value);
  $('speed').onchange = e => { S.speed = Number(e.target.value); };
  $('play').onclick = () => setPlaying(!S.playing);
  $('back').onclick = () => step(-1);
  $('on').onclick = () => step(1);
  $('follow').onclick = follow;
  $('slider').oninput = e => seek(e.target.value * S.run.step);
  $('tail').oninput = e => set('tail', Number(e.target.value));
  $('layer').onclick = e => e.target.dataset.value && set('layer', e.target.dataset.value);
  $('axis').onclick = e => e.target.dataset.value && set('axis', e.target.dataset.value);
  $('guide').onclick = () => set('guide', !S.guide);
  $('radio').checked = S.radio;
  $('radio').onchange = e => set('radio', e.target.checked);
  $('theme').onclick = () => setTheme(S.theme === 'dark' ? 'light' : 'dark');
  $('help').onclick = showKeys;
  $('detailsButton').onclick = openDetails;
  $('showAll').onclick = () => pin(-1);
  $('fit').onclick = fit;
  $('saveButton').onclick = () => {
    $('saveMenu').hidden = !$('saveMenu').hidden;
    $('saveButton').setAttribute('aria-expanded', !$('saveMenu').hidden);
  };
  for (const [id, action] of [['savePng', savePng], ['saveSvg', () => saveSvg(view)], ['saveVideo', saveVideo]]) {
    $(id).onclick = () => { action(); if (id !== 'saveVideo') closeMenu(); };
  }
  addEventListener('pointerdown', e => { if (!e.target.closest('.menu')) closeMenu(); });
}

function connectChart() {
  const chart = $('chart'), timeAt = e => scalesOf(S.run, S, chart.clientWidth, chart.clientHeight).t(e.offsetX);
  chart.onpointermove = e => { S.pointer = timeAt(e); if (e.buttons) seek(S.pointer); ask(); };
  chart.onpointerleave = () => { S.pointer = -1; ask(); };
  chart.onpointerdown = e => { chart.setPointerCapture(e.pointerId); seek(timeAt(e)); };
}

function nearest(x, y) {
  const row = S.run.rowAt(S.t);
  let best = -1, least = 18;
  for (const track of S.run.tracks) {
    const at = track.rowAt(row), d = at < 0 ? Infinity : Math.hypot(view.px(track.p[2 * at]) - x, view.py(track.p[2 * at + 1]) - y);
    if (d < least) { least = d; best = track.id; }
  }
  return best;
}

function showTip(x, y, agent) {
  const { run } = S, tip = $('tip'), [mx, my] = view.metres(x, y), [lx, ly] = run.size, inside = mx >= 0 && my >= 0 && mx <= lx && my <= ly;
  tip.hidden = !inside;
  if (!inside) return;
  if (agent >= 0) {
    const track = run.track(agent), row = run.rowAt(S.t), speed = run.speedAt(track, row), at = track.rowAt(row), [ox, oy] = run.mission.origin_m;
    put(tip, `agent ${agent}: ${stateOf(run, track, S.t).text}, at ${(track.p[2 * at] + ox).toFixed(0)}, ${(track.p[2 * at + 1] + oy).toFixed(0)} m${speed === null ? '' : `, ${speed.toFixed(1)} m/s`}`);
  } else {
    const { width, height, cells, full } = run.density, i = Math.min(width - 1, Math.floor((mx / lx) * width)), j = Math.min(height - 1, Math.floor((1 - my / ly) * height));
    put(tip, `${(mx + run.mission.origin_m[0]).toFixed(0)}, ${(my + run.mission.origin_m[1]).toFixed(0)} m · target ${((cells[j * width + i] / 255) * full).toFixed(2)}×`);
  }
  tip.style.left = `${Math.min(x + 14, view.width - tip.offsetWidth - 6)}px`;
  tip.style.top = `${y > view.height - 50 ? y - 34 : y + 14}px`;
}

function connectMap() {
  const map = $('markers'), fingers = new Map();
  let moved = 0;
  map.onpointerdown = e => {
    fingers.set(e.pointerId, [e.offsetX, e.offsetY]);
    map.setPointerCapture(e.pointerId);
    moved = 0;
  };
  map.onpointerup = map.onpointercancel = e => {
    fingers.delete(e.pointerId);
    if (e.type === 'pointerup' && moved < 4 && S.hover >= 0) pin(S.hover);
  };
  map.onpointermove = e => {
    const was = fingers.get(e.pointerId), x = e.offsetX, y = e.offsetY;
    if (was) {
      const other = [...fingers].find(([id]) => id !== e.pointerId)?.[1];
      if (other) {
        const distance = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
        zoom(distance([x, y]) / Math.max(1, distance(was)), other[0], other[1]);
      } else if (view.zoom > 1) {
        view.pan(x - was[0], y - was[1], S.run.size);
        redraw();
      }
      moved += Math.abs(x - was[0]) + Math.abs(y - was[1]);
      fingers.set(e.pointerId, [x, y]);
    }
    const agent = nearest(x, y);
    hover(agent);
    showTip(x, y, agent);
  };
  map.onpointerleave = () => { hover(-1); $('tip').hidden = true; };
  map.addEventListener('wheel', e => { e.preventDefault(); zoom(Math.exp(-e.deltaY * 0.0016), e.offsetX, e.offsetY); }, { passive: false });
}

const next = (list, value) => list[(list.indexOf(value) + 1) % list.length];
const KEYS = {
  ' ': () => setPlaying(!S.playing), ArrowLeft: e => step(-1, e.shiftKey), ArrowRight: e => step(1, e.shiftKey), Home: () => seek(0), End: () => seek(S.run.end),
  '<': () => faster(-1), ',': () => faster(-1), '>': () => faster(1), '.': () => faster(1), '[': () => jump(-1), ']': () => jump(1),
  c: () => set('layer', next(LAYERS, S.layer)), t: () => set('tail', (S.tail + 1) % TAILS.length), d: () => $('theme').click(), s: savePng, i: openDetails,
  l: () => S.live && follow(), '+': () => zoom(1.4), '=': () => zoom(1.4), '-': () => zoom(1 / 1.4), 0: fit,
  Escape: () => { closeMenu(); pin(-1); }, '?': showKeys,
};

function connectKeys() {
  addEventListener('keydown', e => {
    if (!S.run || e.ctrlKey || e.metaKey || e.altKey || document.querySelector('dialog[open]') || e.target.tagName === 'SELECT') return;
    const action = KEYS[e.key.length === 1 ? e.key.toLowerCase() : e.key];
    const own = (e.key === ' ' && ['BUTTON', 'INPUT'].includes(e.target.tagName) && e.target.type !== 'range') || (e.target.id === 'tail' && e.key.startsWith('Arrow'));
    if (!action || own) return;
    e.preventDefault();
    action(e);
  });
}

// --- start ---

const dark = matchMedia('(prefers-color-scheme: dark)');
const wishes = new URLSearchParams(location.hash.slice(1));   // for links: #theme=dark&t=299&layer=achieved
const data = JSON.parse($('data').textContent);

onFrame(frame);
connectButtons();
connectChart();
connectMap();
connectKeys();
setTheme(wishes.get('theme') ?? (dark.matches ? 'dark' : 'light'));
dark.addEventListener('change', e => setTheme(e.matches ? 'dark' : 'light'));
const sizes = new ResizeObserver(layout);
for (const node of [document.body, $('stage'), $('chart')]) sizes.observe(node);
if (data.log?.length) addLog(data.log);
if (data.record) showRecord(recordedRun(data.record));
if (data.live) {
  put($('name'), 'waiting for a team');
  put($('state'), 'waiting');
  $('state').className = 'pill idle';
  watchLive(livePage);
}
for (const key of ['layer', 'axis', 'quantity']) if (wishes.has(key)) set(key, wishes.get(key));
if (wishes.has('tail')) set('tail', clamp(Number(wishes.get('tail')) || 0, 0, TAILS.length - 1));
if (wishes.has('t') && S.run) seek(Number(wishes.get('t')) || 0);

// What tests ask the page; it changes nothing but what is shown.
window.ergocast = {
  S, view, seek, set, pin, hover, setTheme, svgText: () => svgText(view), focus: focusOf,
  frames: () => frames,
  clearFrames: () => { frames = []; },
  // Draws a tick at once; the time until its pixels can be read [ms].
  draw(t) {
    const begin = performance.now();
    seek(t);
    frame(begin);
    for (const id of ['shading', 'trails', 'markers', 'chart']) $(id).getContext('2d').getImageData(0, 0, 1, 1);
    return performance.now() - begin;
  },
  // The greatest relative difference between φ² of the record and of the positions in the page.
  worstMetric() {
    const { run } = S;
    return Math.max(...run.metrics.t.map((t, i) => Math.abs(run.coverage.metric(run.rowAt(t)) / run.metrics.phi[i] - 1)));
  },
};
