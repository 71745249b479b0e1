// SPDX-License-Identifier: BSD-3-Clause
// Holds the colours: eight hues for agents, and ramps for densities that are straight lines in OKLab.
export const HUES = {
  light: ['#0063a8', '#b04a00', '#00705a', '#a3327a', '#7a6000', '#5a48b8', '#0f7488', '#505a66'],
  dark: ['#58aefb', '#ff9455', '#3fd0a2', '#f492cb', '#e8c547', '#b3a5ff', '#6fdbe8', '#c6ced8'],
};

// From little to much, and from too little over as wanted to too much.
export const STOPS = {
  light: {
    heat: ['#eef1f5', '#5f9bd3', '#0a4f9c'],
    amount: ['#ffffff', '#f8d899', '#e9b457', '#da9a3a'],
    difference: ['#b98a5e', '#fbfbfb', '#6f90bd'],
  },
  dark: {
    heat: ['#1d2630', '#2f6aa5', '#7cc0ff'],
    amount: ['#0f151b', '#3d301b', '#66491d', '#80591f'],
    difference: ['#96653a', '#12181f', '#436a9c'],
  },
};

const linear = v => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
const gamma = v => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

// The matrices are those of the definition of OKLab (Ottosson 2020).
function toOklab(hex) {
  const [r, g, b] = [1, 3, 5].map(i => linear(parseInt(hex.slice(i, i + 2), 16) / 255));
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [
    0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s,
    1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s,
  ];
}

function toBytes([lightness, a, b]) {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ].map(v => Math.round(255 * gamma(Math.min(1, Math.max(0, v)))));
}

// At a share of the way along colours.
function between(lab, u) {
  const at = u * (lab.length - 1),
    k = Math.min(Math.floor(at), lab.length - 2);
  return lab[k].map((v, j) => v + (lab[k + 1][j] - v) * (at - k));
}

// 256 pixels of an ImageData, as 32-bit numbers.
export function ramp(stops) {
  const lab = stops.map(toOklab),
    pixels = new Uint32Array(256);
  for (let i = 0; i < 256; i++) {
    const [r, g, b] = toBytes(between(lab, i / 255));
    pixels[i] = 0xff000000 | (b << 16) | (g << 8) | r;
  }
  return pixels;
}

// The colour at a share of the way along these stops, "#rrggbb".
export function mix(stops, u) {
  return (
    '#' +
    toBytes(between(stops.map(toOklab), u))
      .map(v => v.toString(16).padStart(2, '0'))
      .join('')
  );
}

// What can be read on that colour.
export const inkOn = hex => (toOklab(hex)[0] > 0.65 ? '#0b1118' : '#ffffff');

const NAMES = ['bg', 'panel', 'ink', 'muted', 'line', 'soft', 'accent', 'ok', 'warn', 'bad', 'gone'];

// The colours of a theme, which page.css has as custom properties.
export function themeColours(theme) {
  const style = getComputedStyle(document.documentElement),
    colours = { theme };
  for (const name of NAMES) colours[name] = style.getPropertyValue('--' + name).trim();
  const hues = HUES[theme];
  colours.agent = id => hues[id % hues.length];
  colours.heat = STOPS[theme].heat;
  colours.amount = ramp(STOPS[theme].amount);
  colours.difference = ramp(STOPS[theme].difference);
  return colours;
}
