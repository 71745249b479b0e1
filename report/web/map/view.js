// SPDX-License-Identifier: BSD-3-Clause
// Maps the domain, or a part of it, onto the canvas.
import { clamp } from '../text.js';

export class View {
  constructor() {
    Object.assign(this, { zoom: 1, x: 0, y: 0, width: 1, height: 1 });
  }
  resize(width, height) {
    Object.assign(this, { width, height });
  }
  place([lx, ly]) {
    const margin = this.zoom > 1 ? 0 : 12;
    this.fit = Math.min((this.width - 2 * margin) / lx, (this.height - 2 * margin) / ly);
    if (this.zoom === 1) {
      this.x = lx / 2;
      this.y = ly / 2;
    }
    this.scale = this.fit * this.zoom; // pixels per metre
    this.left = this.width / 2 - this.x * this.scale;
    this.bottom = this.height / 2 + this.y * this.scale;
  }
  px(x) {
    return this.left + x * this.scale;
  }
  py(y) {
    return this.bottom - y * this.scale;
  }
  at(track, k) {
    return [this.px(track.p[2 * k]), this.py(track.p[2 * k + 1])];
  }
  // Where an agent at row k is after so many metres in that direction.
  later(run, track, k, direction, metres) {
    const [x, y] = run.axes.map((axis, i) => track.p[2 * k + i] + run.stretch[i] * metres * direction[axis]);
    return [this.px(x), this.py(y)];
  }
  // How much longer what is round is drawn, to the right and upwards.
  stretchOf(run) {
    return run.stretch;
  }
  scaleAt() {
    return this.scale;
  }
  nearness() {
    return 1;
  }
  reset() {
    this.zoom = 1;
  }
  get whole() {
    return this.zoom === 1;
  }
  metres(px, py) {
    return [(px - this.left) / this.scale, (this.bottom - py) / this.scale];
  }
  zoomAt(factor, px, py, size) {
    const [x, y] = this.metres(px, py);
    this.zoom = clamp(this.zoom * factor, 1, 40);
    const scale = this.fit * this.zoom;
    this.x = clamp(x + (this.width / 2 - px) / scale, 0, size[0]);
    this.y = clamp(y - (this.height / 2 - py) / scale, 0, size[1]);
    this.place(size);
  }
  pan(dx, dy, size) {
    this.x = clamp(this.x - dx / this.scale, 0, size[0]);
    this.y = clamp(this.y + dy / this.scale, 0, size[1]);
    this.place(size);
  }
  get key() {
    return [this.zoom, this.x, this.y, this.width, this.height].join();
  }
}
