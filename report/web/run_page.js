// SPDX-License-Identifier: BSD-3-Clause
// Brings data, drawing and controls together on the page of a run.
import { S, ask, focusOf, mapState, onFrame, shown } from './panels/state.js';
import { TAILS } from './map/map.js';
import { lineBetween, signAt } from './map/blocks.js';
import { commandOf, courseOf } from './map/course.js';
import { markersOf } from './map/markers.js';
import { recordedRun } from './data/record.js';
import { advance, seek } from './panels/timeline.js';
import { hover, pin } from './panels/team.js';
import { drawPictures, layout, readPixels, view } from './panels/screen.js';
import { drawHeadline } from './panels/headline.js';
import { followTarget, set, setTheme } from './panels/legend.js';
import { livePage, showRecord } from './panels/shown_run.js';
import { connectButtons, connectChart, connectKeys } from './panels/controls.js';
import { connectControl, showControl } from './panels/control.js';
import { connectDrawing, followDrawing } from './panels/drawing.js';
import { connectZones, followZones } from './panels/zone_list.js';
import { connectMap } from './panels/map_pointer.js';
import { labelBoxes, signsAt } from './map/finds_layer.js';
import { connectSpace, showView } from './panels/space_controls.js';
import { svgText } from './panels/save.js';
import { addLog, watchLive } from './data/live.js';
import { $, clamp, put } from './text.js';

let frames = []; // milliseconds that each took

function frame(now) {
  if (!S.run) return;
  const begin = performance.now();
  advance(now);
  followTarget();
  followDrawing();
  followZones();
  drawPictures();
  drawHeadline(now);
  frames.push(performance.now() - begin);
  if (frames.length > 600) frames.shift();
  if (S.playing) ask();
}

const dark = matchMedia('(prefers-color-scheme: dark)');
const wishes = new URLSearchParams(location.hash.slice(1)); // for links: #theme=dark&t=299&layer=achieved
const data = JSON.parse($('data').textContent);

onFrame(frame);
connectButtons();
connectChart();
connectMap();
connectSpace();
connectKeys();
connectControl();
connectDrawing();
connectZones();
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
if (S.run?.inBox && wishes.has('view')) showView(wishes.get('view'));
for (const key of ['layer', 'axis', 'quantity']) if (wishes.has(key)) set(key, wishes.get(key));
if (wishes.has('tail')) set('tail', clamp(Number(wishes.get('tail')) || 0, 0, TAILS.length - 1));
if (wishes.has('t') && S.run) seek(Number(wishes.get('t')) || 0);

// What tests ask the page; it changes nothing but what is shown.
window.ergocast = {
  S,
  seek,
  set,
  shown,
  showView,
  pin,
  hover,
  setTheme,
  svgText: () => svgText(view),
  labelBoxes,
  signs: () => signsAt(shown(), view, mapState().row),
  focus: focusOf,
  get view() {
    return view;
  },
  marker: id => markersOf(shown(), view, mapState()).find(({ track }) => track.id === id),
  course: id => courseOf(shown(), view, ergocast.marker(id)),
  command: id => commandOf(shown(), view, ergocast.marker(id), mapState()),
  showControl,
  block: (id, by) =>
    by === null ? signAt(ergocast.marker(id)) : lineBetween(ergocast.marker(id), ergocast.marker(by)),
  frames: () => frames,
  clearFrames: () => {
    frames = [];
  },
  // Draws a tick at once; the time until its pixels can be read [ms].
  draw(t) {
    const begin = performance.now();
    seek(t);
    if (S.layer === 'missed') S.run.detection.at(S.run.rowAt(t));
    frame(begin);
    readPixels();
    return performance.now() - begin;
  },
  // The greatest difference between the probability of detection of the record and of the positions.
  worstFound() {
    const { run } = S,
      found = run.metrics.t.map(t => run.detection.probability(run.rowAt(t)));
    return Math.max(...found.map((p, i) => Math.abs(p - run.metrics.found[i])));
  },
  // The greatest relative difference between φ² of the record and of the positions in the page.
  worstMetric() {
    const { run } = S;
    return Math.max(
      ...run.metrics.t.map((t, i) => Math.abs(run.coverage.metric(run.rowAt(t)) / run.metrics.phi[i] - 1)),
    );
  },
};
