// SPDX-License-Identifier: BSD-3-Clause
// Lists the contacts: where sensors with false alarms have reported something, the likeliest first.
import { $, chance, element, put } from '../text.js';

const fixed = (v, digits = 1) => (typeof v === 'number' ? v.toFixed(digits) : '–');
const COLUMNS = [
  ['x [m]', 'Where it is: the middle of a cell', one => fixed(one.x_m)],
  ['y [m]', 'Where it is: the middle of a cell', one => fixed(one.y_m)],
  [
    'Likely',
    'How likely an object is there; when it was confirmed, if it is',
    one => chance(one.probability),
  ],
  ['Reports', 'How often sensors have reported something there', one => fixed(one.reports, 0)],
  ['Newest [s]', 'Mission time of the newest report', one => fixed(one.t_s)],
  ['', 'Whether it is confirmed: agents then search elsewhere', one => (one.confirmed ? 'confirmed' : '')],
];

export function showContacts({ contacts, moreContacts }) {
  $('contactBox').hidden = contacts.length === 0;
  put($('contactNote'), moreContacts ? `the ${contacts.length} likeliest; there may be more` : '');
  const rows = contacts.map(one => COLUMNS.map(([, , text]) => text(one))),
    shown = JSON.stringify(rows);
  if ($('contacts').dataset.shown === shown) return;
  $('contacts').dataset.shown = shown;
  const heads = COLUMNS.map(([head, means]) => {
    const th = element('th', '', head);
    th.scope = 'col';
    th.title = means;
    return th;
  });
  $('contactHeads').replaceChildren(...heads);
  $('contacts').replaceChildren(
    ...rows.map(cells => {
      const tr = element('tr');
      tr.append(...cells.map(text => element('td', '', text)));
      return tr;
    }),
  );
}
