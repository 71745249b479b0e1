// SPDX-License-Identifier: BSD-3-Clause
// Projects a box in perspective from a point around it.
// It has the methods of View (view.js) that the map uses.
import { stretchOf } from '../data/stretch.js';
import { clamp } from '../text.js';

const DISTANCE = 4; // of the eye, in radii of the box's sphere
const START = { azimuth: -0.55, elevation: 0.42, zoom: 1, dx: 0, dy: 0 };

export class SpaceView {
  constructor() {
    Object.assign(this, START, { width: 1, height: 1 });
  }
  resize(width, height) {
    Object.assign(this, { width, height });
  }
  place(size) {
    const longest = Math.max(size[0], size[1], size[2] * stretchOf(size));
    this.size = size;
    this.units = [1 / longest, 1 / longest, stretchOf(size) / longest]; // of a metre
    const radius = Math.hypot(...size.map((l, i) => l * this.units[i])) / 2;
    this.eye = DISTANCE * radius;
    this.near = 1.2 * radius;
    this.far = 6.8 * radius;
    const room = Math.max(40, Math.min(this.width - 90, this.height - 70) / 2);
    this.focal = this.zoom * 1.04 * room * Math.sqrt(DISTANCE ** 2 - 1);
    const [sa, ca, se, ce] = [
      Math.sin(this.azimuth),
      Math.cos(this.azimuth),
      Math.sin(this.elevation),
      Math.cos(this.elevation),
    ];
    this.right = [ca, -sa, 0];
    this.up = [sa * se, ca * se, ce];
    this.forward = [sa * ce, ca * ce, -se];
  }
  // [x, y, depth] of a place, in pixels and in units before the eye.
  project(place) {
    const { size, units } = this,
      q = place.map((v, i) => (v - size[i] / 2) * units[i]);
    const along = axis => axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2],
      depth = this.eye + along(this.forward);
    return [
      this.width / 2 + this.dx + (this.focal * along(this.right)) / depth,
      this.height / 2 + this.dy - (this.focal * along(this.up)) / depth,
      depth,
    ];
  }
  // From metres to clip space, column by column.
  matrix() {
    const { size, units, near, far, eye } = this,
      slope = (far + near) / (far - near),
      shift = (-2 * far * near) / (far - near);
    const sx = (2 * this.focal) / this.width,
      sy = (2 * this.focal) / this.height,
      px = (2 * this.dx) / this.width,
      py = (-2 * this.dy) / this.height;
    const column = (r, u, f, one) => [sx * r + px * f, sy * u + py * f, slope * f + shift * one, f],
      columns = [];
    const rest = [0, 0, eye];
    for (let i = 0; i < 3; i++) {
      columns.push(...column(this.right[i] * units[i], this.up[i] * units[i], this.forward[i] * units[i], 0));
      for (const [j, axis] of [this.right, this.up, this.forward].entries())
        rest[j] -= (axis[i] * units[i] * size[i]) / 2;
    }
    return new Float32Array([...columns, ...column(...rest, 1)]);
  }
  // The place of the eye, in metres from the domain's corner.
  eyePlace() {
    return this.size.map((l, i) => l / 2 - (this.eye * this.forward[i]) / this.units[i]);
  }
  placeAt(track, k) {
    return [track.p[2 * k], track.p[2 * k + 1], track.z[k]];
  }
  at(track, k) {
    return this.project(this.placeAt(track, k));
  }
  later(run, track, k, direction, metres) {
    return this.project(this.placeAt(track, k).map((v, axis) => v + metres * direction[axis])).slice(0, 2);
  }
  // A ball in a flat box is as much higher as the box is.
  stretchOf() {
    return [1, Math.hypot(Math.sin(this.elevation), stretchOf(this.size) * Math.cos(this.elevation))];
  }
  // Pixels per metre at that depth.
  scaleAt(track, k) {
    return (this.focal * this.units[0]) / this.at(track, k)[2];
  }
  // How large a marker is there.
  nearness(track, k) {
    return clamp((this.eye / this.at(track, k)[2]) ** 1.5, 0.7, 1.4);
  }
  get scale() {
    return (this.focal * this.units[0]) / this.eye;
  }
  zoomAt(factor, px, py) {
    const before = this.zoom;
    this.zoom = clamp(this.zoom * factor, 0.5, 20);
    const grown = this.zoom / before;
    this.dx = (px - this.width / 2) * (1 - grown) + this.dx * grown;
    this.dy = (py - this.height / 2) * (1 - grown) + this.dy * grown;
    this.place(this.size);
  }
  pan(dx, dy) {
    this.dx += dx;
    this.dy += dy;
    this.place(this.size);
  }
  turn(right, up) {
    this.azimuth = (this.azimuth + right) % (2 * Math.PI);
    this.elevation = clamp(this.elevation + up, -Math.PI / 2, Math.PI / 2);
    this.place(this.size);
  }
  reset() {
    Object.assign(this, START);
  }
  get whole() {
    return Object.entries(START).every(([key, value]) => this[key] === value);
  }
  get key() {
    return [this.azimuth, this.elevation, this.zoom, this.dx, this.dy, this.width, this.height].join();
  }
}
