// SPDX-License-Identifier: BSD-3-Clause
// Writes SVG through the methods of a canvas context that the figures use.
const two = v => String(Math.round(v * 100) / 100);
const escaped = text => text.replace(/[&<>"]/g, c => `&#${c.charCodeAt(0)};`);

export class SvgContext {
  constructor(width, height) {
    Object.assign(this, {
      width,
      height,
      out: [],
      path: '',
      dash: '',
      groups: [0],
      clips: 0,
      fillStyle: '#000',
      strokeStyle: '#000',
      lineWidth: 1,
      globalAlpha: 1,
      lineCap: 'butt',
      lineJoin: 'miter',
      font: '11px sans-serif',
      textAlign: 'left',
      textBaseline: 'alphabetic',
    });
    this.measure = document.createElement('canvas').getContext('2d');
  }
  beginPath() {
    this.path = '';
  }
  moveTo(x, y) {
    this.path += `M${two(x)} ${two(y)}`;
  }
  lineTo(x, y) {
    this.path += `${this.path ? 'L' : 'M'}${two(x)} ${two(y)}`;
  }
  closePath() {
    this.path += 'Z';
  }
  rect(x, y, w, h) {
    this.path += `M${two(x)} ${two(y)}h${two(w)}v${two(h)}h${two(-w)}Z`;
  }
  arc(x, y, r, from, to) {
    const at = angle => `${two(x + r * Math.cos(angle))} ${two(y + r * Math.sin(angle))}`,
      middle = (from + to) / 2;
    this.path += `${this.path ? 'L' : 'M'}${at(from)}`;
    for (const end of [middle, to]) this.path += `A${two(r)} ${two(r)} 0 0 1 ${at(end)}`;
  }
  alpha(kind) {
    return this.globalAlpha < 1 ? ` ${kind}-opacity="${two(this.globalAlpha)}"` : '';
  }
  stroke() {
    if (!this.path) return;
    this.out.push(
      `<path d="${this.path}" fill="none" stroke="${this.strokeStyle}"` +
        ` stroke-width="${two(this.lineWidth)}" stroke-linejoin="${this.lineJoin}"` +
        (this.dash ? ` stroke-dasharray="${this.dash}"` : '') +
        `${this.alpha('stroke')}/>`,
    );
  }
  fill(rule = 'nonzero') {
    this.out.push(
      `<path d="${this.path}" fill="${this.fillStyle}" fill-rule="${rule}"${this.alpha('fill')}/>`,
    );
  }
  fillRect(x, y, w, h) {
    this.out.push(
      `<rect x="${two(x)}" y="${two(y)}" width="${two(w)}" height="${two(h)}"` +
        ` fill="${this.fillStyle}"${this.alpha('fill')}/>`,
    );
  }
  strokeRect(x, y, w, h) {
    this.beginPath();
    this.rect(x, y, w, h);
    this.stroke();
  }
  setLineDash(list) {
    this.dash = list.join(' ');
  }
  measureText(text) {
    this.measure.font = this.font;
    return this.measure.measureText(text);
  }
  fillText(text, x, y) {
    const [, weight, size] = /^(?:(\d+) )?([\d.]+)px/.exec(this.font),
      shift = { top: 0.8, middle: 0.35, bottom: -0.2 }[this.textBaseline] ?? 0;
    const anchor = { center: 'middle', right: 'end' }[this.textAlign] ?? 'start';
    this.out.push(
      `<text x="${two(x)}" y="${two(y + shift * size)}" font-size="${size}" font-weight="${weight ?? 400}"` +
        ` text-anchor="${anchor}" fill="${this.fillStyle}"${this.alpha('fill')}>${escaped(text)}</text>`,
    );
  }
  drawImage(canvas, x, y, w, h) {
    this.out.push(
      `<image href="${canvas.toDataURL()}" x="${two(x)}" y="${two(y)}" width="${two(w)}" height="${two(h)}"` +
        ` preserveAspectRatio="none"/>`,
    );
  }
  save() {
    this.groups.push(0);
  }
  clip() {
    const id = `clip${++this.clips}`;
    this.out.push(`<clipPath id="${id}"><path d="${this.path}"/></clipPath><g clip-path="url(#${id})">`);
    this.groups[this.groups.length - 1]++;
  }
  transform(what) {
    this.out.push(`<g transform="${what}">`);
    this.groups[this.groups.length - 1]++;
  }
  translate(x, y) {
    this.transform(`translate(${two(x)} ${two(y)})`);
  }
  rotate(angle) {
    this.transform(`rotate(${two((angle * 180) / Math.PI)})`);
  }
  restore() {
    for (let n = this.groups.pop(); n > 0; n--) this.out.push('</g>');
    this.globalAlpha = 1;
    this.dash = '';
  }
  // Begins a part at (x, y) that shows nothing outside of its box.
  begin(x, y, w, h) {
    this.out.push(`<svg x="${x}" y="${y}" width="${w}" height="${h}" viewBox="0 0 ${w} ${h}">`);
  }
  end() {
    this.out.push('</svg>');
  }
  text() {
    const { width, height } = this;
    const head =
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}"` +
      ` viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif">`;
    return `${head}\n${this.out.join('\n')}\n</svg>\n`;
  }
}
