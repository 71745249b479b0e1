// SPDX-License-Identifier: BSD-3-Clause
// Holds what the page of a study shows now. Code that changes it asks for a frame.
export const S = {
  study: null,
  filters: new Map(), // number of a dimension → its value
  words: '',
  by: null, // what the table is sorted by: a dimension, {key: 'runs'} or {key} of a quantity
  down: false,
  quantity: 'metric',
  figure: 'map', // or 'field'
  curve: 'phi', // or 'escapes'
  across: null,
  up: null, // dimensions of the figure
  pins: new Set(), // indices of points that were chosen
  hover: -1,
  theme: 'light',
  colours: null,
};

export const MOST_CURVES = 8;

// The curves: what was chosen, else the first rows of the table.
export function curvesOf(rows) {
  const pinned = rows.filter(point => S.pins.has(point.index));
  return (pinned.length ? pinned : rows.filter(point => point.runs > 0)).slice(
    0,
    pinned.length ? 2 * MOST_CURVES : MOST_CURVES,
  );
}
