// SPDX-License-Identifier: BSD-3-Clause
// Shows the points as a table: a click on a head sorts it, a click on a row chooses.
import { S } from './study_state.js';
import { QUANTITIES, intervalText } from './study.js';
import { $, element, grouped, put } from '../text.js';

let rows = new Map(),
  order = '',
  columns = [];

// A field's name may be broken before its parts.
function head({ title, means, number, by }, sort) {
  const th = element('th', number ? 'number' : ''),
    button = element('button');
  title.split(/(?=[._])/).forEach((part, i) => button.append(...(i ? [element('wbr')] : []), part));
  th.scope = 'col';
  th.title = means ?? '';
  th.append(button);
  button.onclick = () => sort(by);
  return th;
}

// The command that runs a point, in a row of its own.
function toggleCommand(tr, point) {
  if (tr.nextSibling?.className === 'how') {
    tr.nextSibling.remove();
    return;
  }
  const how = element('tr', 'how'),
    td = element('td');
  td.colSpan = columns.length + 1;
  td.append(element('pre', '', point.command));
  how.append(td);
  tr.after(how);
}

function row(point, { pin, hover }) {
  const tr = element('tr', point.runs ? '' : 'none');
  for (const { number, text } of columns) tr.append(element('td', number ? 'number' : '', text(point)));
  const last = element('td'),
    button = element('button', 'command', 'Command'),
    sign = element('span', '', '$');
  sign.setAttribute('aria-hidden', 'true');
  button.append(sign);
  button.title = 'The command that runs this point';
  button.onclick = e => {
    e.stopPropagation();
    toggleCommand(tr, point);
  };
  last.append(button);
  tr.append(last);
  tr.tabIndex = 0;
  tr.onclick = () => pin(point.index);
  tr.onkeydown = e => {
    if (e.key === 'Enter' && e.target === tr) pin(point.index);
  };
  tr.onpointerenter = tr.onfocus = () => hover(point.index);
  tr.onpointerleave = tr.onblur = () => hover(-1);
  return tr;
}

// `actions`: {sort, pin, hover}.
export function buildTable(study, actions) {
  const fields = study.varied.length ? study.varied : study.dimensions.slice(0, 1);
  columns = [
    ...fields.map(by => ({ by, title: by.name, number: false, text: point => point.all[by.number] })),
    {
      by: { key: 'runs' },
      title: 'Runs',
      means: 'Missions of this point, one for each seed',
      number: true,
      text: point => grouped(point.runs),
    },
    ...study.quantities.map(key => ({
      by: { key },
      means: QUANTITIES[key].means,
      title: QUANTITIES[key].title + (QUANTITIES[key].unit ? ` [${QUANTITIES[key].unit}]` : ''),
      number: true,
      text: point => intervalText(point, key),
    })),
  ];
  const last = element('th');
  last.append(element('span', 'hidden', 'Command'));
  $('heads').replaceChildren(...columns.map(column => head(column, actions.sort)), last);
  rows = new Map(study.points.map(point => [point.index, row(point, actions)]));
}

// Shows these points in this order; marks the best, what is near it, and what is chosen.
export function showTable(points, best, near) {
  const now = points.map(point => point.index).join();
  if (now !== order) {
    order = now;
    $('rows').replaceChildren(...points.map(point => rows.get(point.index)));
  }
  columns.forEach(({ by }, i) => {
    const th = $('heads').children[i],
      on = by === S.by || (by.key && by.key === S.by?.key);
    if (on) th.setAttribute('aria-sort', S.down ? 'descending' : 'ascending');
    else th.removeAttribute('aria-sort');
  });
  for (const point of points) {
    const { classList } = rows.get(point.index);
    classList.toggle('pin', S.pins.has(point.index));
    classList.toggle('hot', S.hover === point.index);
    classList.toggle('best', point === best);
    classList.toggle('near', near.includes(point));
  }
}

export function showCounts(study, points) {
  const runs = `${grouped(study.runs)} runs, ${grouped(study.points.length)} points`;
  put($('counts'), points.length === study.points.length ? runs : `${runs}, ${grouped(points.length)} shown`);
}
