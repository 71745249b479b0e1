// SPDX-License-Identifier: BSD-3-Clause
// Brings data, figures, table and controls together on the page of a study.
import { themeColours } from './colours.js';
import { S, curvesOf } from './study/study_state.js';
import { QUANTITIES, Study, cellsOf, intervalText, sorted } from './study/study.js';
import { cellAt, middleOf, paintHeatMap } from './study/heat_map.js';
import { paintFieldChart } from './study/field_chart.js';
import { curveReading, curveScales, paintCurves } from './study/curves.js';
import { buildTable, showCounts, showTable } from './study/study_table.js';
import { SvgContext } from './svg.js';
import { download } from './download.js';
import { $, element, grouped, put, readable } from './text.js';

let shown = { points: [], cells: [], best: null, near: [], curves: [] },
  pointer = -1,
  asked = false;

// --- what is shown ---

function choose() {
  const { study } = S,
    points = sorted(study.chosen(S), S),
    best = study.best(points, S.quantity);
  shown = {
    points,
    best,
    near: study.near(points, S.quantity, best),
    curves: curvesOf(points),
    cells: cellsOf(study, points, S.quantity, S.across, S.up === S.across ? null : S.up),
  };
}

const colourOf = point => S.colours.agent(shown.curves.indexOf(point));
const hot = point => S.hover === point.index || S.pins.has(point.index);
const figureState = () => ({
  across: S.across,
  up: S.up === S.across ? null : S.up,
  quantity: S.quantity,
  best: shown.best,
  near: shown.near,
  hot,
  colours: S.colours,
});
const curveState = () => ({
  curve: S.curve,
  colours: S.colours,
  colourOf,
  hover: shown.curves.some(p => p.index === S.hover) ? S.hover : -1,
  pointer,
});

function paintFigure(g, width, height) {
  const state = figureState();
  if (S.figure === 'map' && state.up) paintHeatMap(g, shown.cells, state, width, height);
  else paintFieldChart(g, shown.cells, state, width, height);
}

function showBest() {
  const { best, near, points } = shown,
    box = $('best'),
    q = QUANTITIES[S.quantity];
  box.hidden = !best;
  if (!best) return;
  const others = near.length === 1 ? 'One other point is' : `${grouped(near.length)} other points are`;
  box.replaceChildren(
    'Best of ',
    points.length === S.study.points.length ? 'all' : 'what is shown',
    ': ',
    element('b', '', S.study.nameOf(best)),
    `. ${q.title} `,
    element('b', '', intervalText(best, S.quantity)),
    ` of ${grouped(best.runs)} ${best.runs === 1 ? 'run' : 'runs'}. `,
    q.bounds(best)
      ? near.length
        ? `${others} not distinguishable from it.`
        : 'Its interval overlaps with no other.'
      : '',
  );
}

function showKey() {
  $('key').replaceChildren(
    ...shown.curves.map(point => {
      const li = element(
        'li',
        '',
        S.study.nameOf(point) + (pointer > 0 ? `: ${curveReading(point, S.curve, pointer)}` : ''),
      );
      li.style.setProperty('--c', colourOf(point));
      li.onpointerenter = () => hover(point.index);
      li.onpointerleave = () => hover(-1);
      return li;
    }),
  );
  const flown = shown.points.filter(point => point.runs > 0).length;
  put(
    $('reading'),
    pointer > 0
      ? `t ${readable(pointer)} s`
      : !S.pins.size && flown > shown.curves.length
        ? `the first ${shown.curves.length} rows; click others`
        : '',
  );
  $('showFirst').hidden = !S.pins.size;
}

function noteOf() {
  const most = Math.max(0, ...shown.cells.map(cell => cell.list.length));
  return most > 1
    ? `Each ${S.figure === 'map' && figureState().up ? 'cell' : 'dot'} is the best of up to ${most} points ` +
        'that differ in other fields.'
    : '';
}

function context(id) {
  const canvas = $(id),
    scale = Math.min(devicePixelRatio || 1, 2),
    { clientWidth: width, clientHeight: height } = canvas;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const g = canvas.getContext('2d');
  g.setTransform(scale, 0, 0, scale, 0, 0);
  g.clearRect(0, 0, width, height);
  return [g, width, height];
}

function draw() {
  asked = false;
  choose();
  paintFigure(...context('picture'));
  const [g, width, height] = context('curves');
  paintCurves(g, shown.curves, curveState(), width, height);
  showTable(shown.points, shown.best, shown.near);
  showCounts(S.study, shown.points);
  showBest();
  showKey();
  put($('figureNote'), noteOf());
  const words = $('best').hidden ? '' : $('best').textContent;
  $('picture').setAttribute(
    'aria-label',
    `${QUANTITIES[S.quantity].title} against ${S.across.name}. ${words}`,
  );
  $('curves').setAttribute('aria-label', `${$('curveTitle').textContent} of ${shown.curves.length} points`);
}

function ask() {
  if (!asked) requestAnimationFrame(draw);
  asked = true;
}

// --- controls ---

function press(id, value) {
  for (const button of $(id).children) button.setAttribute('aria-pressed', button.dataset.value === value);
}

function showControls() {
  press('figure', S.figure);
  press('curve', S.curve);
  put($('curveTitle'), S.curve === 'phi' ? 'φ² in cosines over time' : 'Agents that escaped');
  $('quantity').value = S.quantity;
  for (const id of ['across', 'up']) $(id).value = S[id].number;
  for (const select of $('filters').querySelectorAll('select')) {
    select.value = S.filters.get(Number(select.dataset.number)) ?? '';
    select.dataset.on = select.value !== '';
  }
}

function set(changes) {
  Object.assign(S, changes);
  showControls();
  ask();
}

function sort(by) {
  const same = by === S.by || (by.key && by.key === S.by?.key);
  set({ by, down: same ? !S.down : by.key ? (QUANTITIES[by.key]?.better ?? 1) > 0 : false });
}
function pin(index) {
  if (index < 0) S.pins.clear();
  else if (!S.pins.delete(index)) S.pins.add(index);
  ask();
}
function hover(index) {
  if (S.hover === index) return;
  S.hover = index;
  ask();
}
function setTheme(theme) {
  document.documentElement.dataset.theme = S.theme = theme;
  S.colours = themeColours(theme);
  ask();
}

function filter(number, value) {
  if (value) S.filters.set(number, value);
  else S.filters.delete(number);
  set({});
}

function buildFilters() {
  const { study } = S,
    form = $('filters');
  for (const { name, number, values } of study.varied) {
    const label = element('label', '', name),
      select = element('select');
    select.append(new Option('all', ''), ...values.map(value => new Option(value, value)));
    select.dataset.number = number;
    select.onchange = () => filter(number, select.value);
    label.append(select);
    form.append(label);
  }
  const words = element('input');
  Object.assign(words, {
    type: 'search',
    id: 'words',
    placeholder: 'words, like epsilon=0.2',
    ariaLabel: 'Words in the name of a point',
  });
  words.oninput = () => set({ words: words.value });
  form.append(words, element('span', 'grow'));
  form.onsubmit = e => e.preventDefault();
  for (const id of ['across', 'up']) {
    for (const { name, number } of study.varied.length ? study.varied : study.dimensions.slice(0, 1))
      $(id).append(new Option(name, number));
    $(id).onchange = e => {
      const other = id === 'across' ? 'up' : 'across',
        chosen = study.dimensions[e.target.value],
        swap = S[other] === chosen;
      set({ [id]: chosen, ...(swap ? { [other]: S[id] } : {}) });
    };
  }
  $('upLabel').hidden = $('figure').hidden = study.varied.length < 2;
  for (const key of study.quantities) $('quantity').append(new Option(QUANTITIES[key].title, key));
  $('curve').hidden = !study.points.some(point => point.escapes);
}

function connectFigures() {
  const picture = $('picture'),
    curves = $('curves'),
    tip = $('tip');
  const cell = e =>
    S.figure === 'map' && figureState().up
      ? cellAt(
          picture.getContext('2d'),
          shown.cells,
          figureState(),
          picture.clientWidth,
          picture.clientHeight,
          e.offsetX,
          e.offsetY,
        )
      : null;
  picture.onpointermove = e => {
    const at = cell(e);
    hover(at ? at.point.index : -1);
    tip.hidden = !at;
    if (!at) return;
    put(
      tip,
      `${S.study.nameOf(at.point)}: ${intervalText(at.point, S.quantity)}, ${grouped(at.point.runs)} runs`,
    );
    tip.style.left = `${Math.max(0, Math.min(e.offsetX + 14, picture.clientWidth - tip.offsetWidth - 4))}px`;
    tip.style.top = `${e.offsetY > 60 ? e.offsetY - 34 : e.offsetY + 16}px`;
  };
  picture.onpointerleave = () => {
    hover(-1);
    tip.hidden = true;
  };
  picture.onclick = e => {
    const at = cell(e);
    if (at) pin(at.point.index);
  };
  curves.onpointermove = e => {
    pointer = curveScales(shown.curves, S.curve, curves.clientWidth, curves.clientHeight).at(e.offsetX);
    ask();
  };
  curves.onpointerleave = () => {
    pointer = -1;
    ask();
  };
}

function svgText() {
  choose();
  const { clientWidth: w, clientHeight: h } = $('picture'),
    g = new SvgContext(2 * w + 48, h + 46);
  g.fillStyle = S.colours.panel;
  g.fillRect(0, 0, g.width, g.height);
  g.fillStyle = S.colours.ink;
  g.font = '600 15px system-ui, sans-serif';
  g.textBaseline = 'middle';
  g.fillText(`${S.study.title}: ${QUANTITIES[S.quantity].title}`, 16, 20);
  g.fillText($('curveTitle').textContent, w + 32, 20);
  g.begin(16, 40, w, h);
  paintFigure(g, w, h);
  g.end();
  g.begin(w + 32, 40, w, h);
  paintCurves(g, shown.curves, { ...curveState(), pointer: -1 }, w, h);
  g.end();
  return g.text();
}
const save = () => download(new Blob([svgText()], { type: 'image/svg+xml' }), `${S.study.title}-study.svg`);

function connectButtons() {
  $('quantity').onchange = e => set({ quantity: e.target.value });
  $('figure').onclick = e => e.target.dataset.value && set({ figure: e.target.dataset.value });
  $('curve').onclick = e => e.target.dataset.value && set({ curve: e.target.dataset.value });
  $('theme').onclick = () => setTheme(S.theme === 'dark' ? 'light' : 'dark');
  $('showFirst').onclick = () => pin(-1);
  $('detailsButton').onclick = () => $('details').showModal();
  $('saveSvg').onclick = save;
  const keys = {
    '/': () => $('words').focus(),
    d: () => $('theme').click(),
    s: save,
    i: () => $('details').showModal(),
    escape: () => pin(-1),
  };
  addEventListener('keydown', e => {
    const action = keys[e.key.toLowerCase()];
    if (
      !action ||
      e.ctrlKey ||
      e.metaKey ||
      e.altKey ||
      document.querySelector('dialog[open]') ||
      ['INPUT', 'SELECT'].includes(e.target.tagName)
    )
      return;
    e.preventDefault();
    action();
  });
}

// --- start ---

const dark = matchMedia('(prefers-color-scheme: dark)'),
  wishes = new URLSearchParams(location.hash.slice(1)); // for links: #theme=dark
const study = (S.study = new Study(JSON.parse($('data').textContent).study));
// The two fields with the most values.
const [first, second] = [...study.varied].sort((a, b) => b.values.length - a.values.length);
Object.assign(S, { across: first ?? study.dimensions[0], up: second ?? first ?? study.dimensions[0] });
put($('name'), study.title);
put($('command'), study.command);
put($('version'), `Made by ergocast ${study.version}.`);
S.by = study.quantities.includes('metric') ? { key: 'metric' } : study.dimensions[0];
buildFilters();
buildTable(study, { sort, pin, hover });
connectFigures();
connectButtons();
setTheme(wishes.get('theme') ?? (dark.matches ? 'dark' : 'light'));
dark.addEventListener('change', e => setTheme(e.matches ? 'dark' : 'light'));
set({});
new ResizeObserver(ask).observe(document.body);
draw();

// What tests ask the page; it changes nothing but what is shown.
window.ergocast = {
  S,
  set,
  sort,
  pin,
  filter,
  setTheme,
  svgText,
  shown: () => shown,
  middleOf: cell =>
    middleOf(
      $('picture').getContext('2d'),
      cell,
      figureState(),
      $('picture').clientWidth,
      $('picture').clientHeight,
    ),
};
