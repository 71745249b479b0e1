// SPDX-License-Identifier: BSD-3-Clause
// Writes numbers as text and makes elements; text from a record or network only becomes textContent.
export const clamp = (v, low, high) => (v < low ? low : v > high ? high : v);
export const $ = id => document.getElementById(id);

export function element(tag, css, text) {
  const made = document.createElement(tag);
  if (css) made.className = css;
  if (text !== undefined) made.textContent = text;
  return made;
}

// Writes only what changed: the browser lays out less.
export function put(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

export const capital = text => text.replace(/^./, first => first.toUpperCase());

// Whether keys are text in an element.
export const isTyped = ({ tagName, type }) => tagName === 'INPUT' && !['range', 'checkbox'].includes(type);

const SUPERSCRIPT = '⁰¹²³⁴⁵⁶⁷⁸⁹';
export const superscript = n => String(n).replace(/./g, c => (c === '-' ? '⁻' : SUPERSCRIPT[c]));

// The modes of φ² over time, as words that follow it. Without these words it is in cosines.
export const ofModes = mission => (mission.free_domain ? ' in modes of the free domain' : '');

// Three digits: 0.368, 12.5, 9.33·10⁻⁴.
export function readable(v) {
  if (typeof v !== 'number' || !isFinite(v)) return '–';
  if (v === 0) return '0';
  let exponent = Math.floor(Math.log10(Math.abs(v))),
    mantissa = v / 10 ** exponent;
  if (Math.abs(mantissa) >= 9.995) {
    mantissa /= 10;
    exponent++;
  }
  const text =
    exponent >= -2 && exponent < 3
      ? v.toPrecision(3)
      : exponent >= 3 && exponent < 6
        ? grouped(Math.round(v))
        : `${mantissa.toFixed(2)}·10${superscript(exponent)}`;
  return text.replace('-', '−');
}

// A whole number in groups of three.
export const grouped = n => String(n).replace(/\B(?=(\d{3})+(?!\d))/g, '\u202f');

export function duration(s) {
  if (!(s >= 120)) return `${s.toFixed(s < 10 ? 1 : 0)} s`;
  const whole = Math.round(s),
    h = Math.floor(whole / 3600),
    m = Math.floor(whole / 60) % 60;
  return h ? `${h} h ${m} min` : `${m} min ${whole % 60} s`;
}

// 0.125 → 12.5 %.
export const share = v => (typeof v === 'number' ? `${+(100 * v).toFixed(1)}\u00a0%` : '–');

// A probability; one near 1 is not rounded to it.
export const chance = v => (v > 0.999 && v < 1 ? `>\u202f99.9\u00a0%` : isFinite(v) ? share(v) : '–');

// A time, or that it never comes.
export const seconds = s => (s === Infinity ? 'never' : `${readable(s)}\u00a0s`);
