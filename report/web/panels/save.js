// SPDX-License-Identifier: BSD-3-Clause
// Saves pictures and films of what the page shows.
import { S, inSpace, mapState, shown } from './state.js';
import { paintShading } from '../map/ground.js';
import { paintMarkers, paintTracks, trailOf, TAILS } from '../map/map.js';
import { paintChart } from './chart.js';
import { download } from '../download.js';
import { SvgContext } from '../svg.js';
import { seek, setPlaying } from './timeline.js';
import { $, element, ofModes, put, readable } from '../text.js';

const GAP = 16,
  HEAD = 46;

function title() {
  const { run, t } = S;
  return (
    `${run.mission.name}, ${run.tracks.length} agents, t = ${t.toFixed(1)} s, ` +
    `φ²${ofModes(run.mission)} = ${readable(run.metricAt(t))}`
  );
}

const save = (blob, ending) => download(blob, `${S.run.mission.name}-${S.t.toFixed(0)}s.${ending}`);

// Title, map and chart on one canvas, as they are on the screen.
function compose(canvas) {
  const map = $('markers'),
    chart = $('chart'),
    scale = map.width / map.clientWidth || 1,
    gap = GAP * scale,
    head = HEAD * scale;
  // Encoders of films want even sizes.
  const width = 2 * Math.ceil((map.width + chart.width + 3 * gap) / 2),
    height = 2 * Math.ceil((Math.max(map.height, chart.height) + head + gap) / 2);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const g = canvas.getContext('2d');
  g.fillStyle = S.colours.panel;
  g.fillRect(0, 0, width, height);
  g.fillStyle = S.colours.ink;
  g.font = `600 ${15 * scale}px system-ui, sans-serif`;
  g.textBaseline = 'middle';
  g.fillText(title(), gap, head / 2);
  for (const id of inSpace() ? ['space', 'markers'] : ['shading', 'trails', 'markers'])
    g.drawImage($(id), gap, head);
  g.drawImage(chart, map.width + 2 * gap, head);
  return canvas;
}

export function savePng() {
  compose(element('canvas')).toBlob(blob => save(blob, 'png'));
}

// The same as lines and text.
export function svgText(view) {
  const { run, colours } = S,
    chart = $('chart'),
    width = chart.clientWidth,
    height = chart.clientHeight;
  const g = new SvgContext(view.width + width + 3 * GAP, Math.max(view.height, height) + HEAD + GAP),
    state = mapState();
  g.fillStyle = colours.panel;
  g.fillRect(0, 0, g.width, g.height);
  g.fillStyle = colours.ink;
  g.font = '600 15px system-ui, sans-serif';
  g.textBaseline = 'middle';
  g.fillText(title(), GAP, HEAD / 2);
  g.begin(GAP, HEAD, view.width, view.height);
  if (state.inSpace) {
    g.drawImage($('space'), 0, 0, view.width, view.height);
  } else {
    paintShading(g, shown(), view, state);
    if (TAILS[S.tail]) paintTracks(g, shown(), view, trailOf(run, state));
  }
  paintMarkers(g, shown(), view, state);
  g.end();
  g.begin(view.width + 2 * GAP, HEAD, width, height);
  paintChart(g, run, S, width, height);
  g.end();
  return g.text();
}

export const saveSvg = view => save(new Blob([svgText(view)], { type: 'image/svg+xml' }), 'svg');

const KINDS = ['video/webm;codecs=vp9', 'video/webm', 'video/mp4'];
let recorder = null;

// Records from the chosen time to the end, or until it is called again; what the browser can do.
export function saveVideo() {
  if (recorder) {
    recorder.stop();
    return;
  }
  const type = KINDS.find(kind => window.MediaRecorder?.isTypeSupported(kind));
  if (!type) {
    put($('saveVideo'), 'This browser cannot');
    return;
  }
  const canvas = compose(element('canvas')),
    parts = [];
  recorder = new MediaRecorder(canvas.captureStream(30), { mimeType: type, videoBitsPerSecond: 6e6 });
  recorder.ondataavailable = e => parts.push(e.data);
  recorder.onstop = () => {
    recorder = null;
    put($('saveVideo'), 'Film from here');
    setPlaying(false);
    save(new Blob(parts, { type }), type.startsWith('video/mp4') ? 'mp4' : 'webm');
  };
  put($('saveVideo'), 'End the film');
  if (S.t >= S.run.end) seek(0);
  recorder.start();
  setPlaying(true);
  const draw = () => {
    if (!recorder) return;
    compose(canvas);
    if (S.playing) requestAnimationFrame(draw);
    else setTimeout(() => recorder?.stop(), 400);
  };
  requestAnimationFrame(draw);
}
