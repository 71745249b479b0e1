// SPDX-License-Identifier: BSD-3-Clause
// Paints a target or a zone that is drawn on the map, and handles to change it.
const HANDLE = 5; // pixels

// The density as a picture in the accent's colour; what is little is transparent.
function shadingOf({ width, height, values }, accent) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const g = canvas.getContext('2d'),
    image = g.createImageData(width, height),
    full = Math.max(2, ...values) * 0.9,
    rgb = [1, 3, 5].map(i => parseInt(accent.slice(i, i + 2), 16));
  values.forEach((value, i) => image.data.set([...rgb, 170 * Math.min(1, value / full) ** 0.6], 4 * i));
  g.putImageData(image, 0, 0);
  return canvas;
}

function paintHandle(g, x, y, fill) {
  g.beginPath();
  g.arc(x, y, HANDLE, 0, 2 * Math.PI);
  g.fillStyle = fill;
  g.fill();
  g.stroke();
}

// `corner`: the one that the arrows move, −1 for none; `filled`: whether the inside is shaded.
function paintPart(g, view, { kind, at, spread, corners }, { chosen, corner, colour, filled, panel }) {
  g.strokeStyle = g.fillStyle = colour;
  g.lineWidth = chosen ? 2.4 : 1.4;
  g.beginPath();
  if (kind === 'peak') {
    g.arc(view.px(at[0]), view.py(at[1]), spread * view.scale, 0, 2 * Math.PI);
  } else {
    for (const [x, y] of corners) g.lineTo(view.px(x), view.py(y));
    g.closePath();
  }
  if (filled) {
    g.globalAlpha = 0.22;
    g.fill();
    g.globalAlpha = 1;
  }
  g.stroke();
  g.lineWidth = 2;
  if (kind === 'peak') paintHandle(g, view.px(at[0]), view.py(at[1]), panel);
  if (kind === 'peak' && chosen) paintHandle(g, view.px(at[0] + spread), view.py(at[1]), panel);
  if (kind === 'polygon' && chosen)
    corners.forEach(([x, y], i) => paintHandle(g, view.px(x), view.py(y), i === corner ? colour : panel));
}

// The polygon whose corners are not all drawn yet, with a line to the pointer.
function paintOpen(g, view, corners, pointer, { colour, panel }) {
  g.strokeStyle = colour;
  g.lineWidth = 2;
  g.setLineDash([5, 4]);
  g.beginPath();
  for (const [x, y] of pointer ? [...corners, pointer] : corners) g.lineTo(view.px(x), view.py(y));
  g.stroke();
  g.setLineDash([]);
  for (const [x, y] of corners) paintHandle(g, view.px(x), view.py(y), panel);
}

// `drawing`: {kind, parts, chosen, corner, open, pointer, grid}; see panels/drawing.js.
export function paintDrawn(g, [lx, ly], view, drawing, colours) {
  const { kind, parts, chosen, corner, open, pointer, grid } = drawing,
    filled = kind === 'zone',
    style = { colour: filled ? colours.bad : colours.accent, panel: colours.panel, corner, filled };
  if (grid) {
    g.imageSmoothingEnabled = true;
    g.drawImage(shadingOf(grid, colours.accent), view.px(0), view.py(ly), lx * view.scale, ly * view.scale);
  }
  for (const part of parts) paintPart(g, view, part, { ...style, chosen: part === chosen });
  if (open.length) paintOpen(g, view, open, pointer, style);
}
