// SPDX-License-Identifier: BSD-3-Clause
// Draws a box with WebGL: faces, edges, slices and trails.
import { TAILS, trailOf, rowsPerPiece } from './map.js';
import { ticksFor } from './box_axes.js';
import { Places } from '../data/places.js';
import { SpaceGl } from './space_gl.js';
import { cornersOf, partsOf, sliceImage } from '../data/slices.js';

const RECENT_S = 30; // in full colour over the whole history
const COARSER = 5; // is the history than on the map: the graphics card may be the processor
const LIFT = 3e-3; // of the depth: so much nearer is a line that lies over another

// The lines of the box's far faces at the axes' ticks, and its edges: those at the back and in front.
function framework(run, view) {
  const { size } = run,
    faces = [],
    back = [],
    front = [];
  const far = [0, 1, 2].map(axis => (view.forward[axis] > 0 ? size[axis] : 0));
  for (let axis = 0; axis < 3; axis++) {
    const [a, b] = [0, 1, 2].filter(other => other !== axis),
      line = (list, at, to) => list.push(...at, ...at.map((v, i) => (i === to ? size[to] : v)));
    for (const [along, across] of [
      [a, b],
      [b, a],
    ])
      for (const { at } of ticksFor(run, across)) {
        const from = [0, 0, 0];
        from[axis] = far[axis];
        from[across] = at;
        line(faces, from, along);
      }
    for (const u of [0, size[a]])
      for (const v of [0, size[b]]) {
        const from = [0, 0, 0];
        from[a] = u;
        from[b] = v;
        line(u !== far[a] && v !== far[b] ? front : back, from, axis);
      }
  }
  return { faces, back, front };
}

export class Space {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = SpaceGl.on(canvas);
    this.lines = [new Map(), new Map()]; // of tracks, history and tail: {places, line, capacity, apart}
    this.textures = [null, null, null];
    this.keys = ['', '', ''];
  }
  get works() {
    return Boolean(this.gl && !this.gl.gl.isContextLost());
  }

  // Waits until the picture is there.
  read() {
    this.gl.gl.readPixels(0, 0, 1, 1, this.gl.gl.RGBA, this.gl.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  paint(run, view, state, scale) {
    const { gl } = this,
      { colours } = state,
      edge = { colour: colours.muted, strength: 0.75, width: 1.3 * scale };
    if (this.run !== run) this.forget(run);
    gl.begin(view.matrix(), colours.bg);
    const { faces, back, front } = framework(run, view);
    gl.drawPairs(faces, { colour: colours.line, width: scale, bias: -LIFT });
    gl.drawPairs(back, edge);
    this.paintTails(run, view, state, scale);
    gl.drawPairs(front, edge);
    this.paintSlices(run, view, state, scale);
  }

  forget(run) {
    for (const lines of this.lines) {
      for (const { line } of lines.values()) this.gl.remove(line);
      lines.clear();
    }
    this.keys.fill('');
    this.run = run;
  }

  paintSlices(run, view, state, scale) {
    const { gl, keys, textures } = this,
      { size } = run,
      places = state.slices.map((share, axis) => (share === null ? null : share * size[axis]));
    places.forEach((at, axis) => {
      if (at === null) return;
      const key = [
        run.id,
        state.layer,
        state.layer === 'target' ? run.targetAt(state.row).id : state.row,
        state.colours.theme,
        at,
      ].join();
      if (key !== keys[axis])
        textures[axis] = gl.texture(sliceImage(run, state, axis, state.slices[axis]), textures[axis]);
      keys[axis] = key;
    });
    const sides = view.eyePlace().map((eye, axis) => eye - places[axis]);
    for (const part of partsOf(size, places, sides)) gl.drawPlane(textures[part.axis], cornersOf(part, size));
    places.forEach((at, axis) => {
      if (at !== null)
        gl.drawPairs(rim(size, axis, at), { colour: state.colours.muted, width: scale, strength: 0.4 });
    });
  }

  // Every `apart`-th place of the track on the graphics card.
  lineOf(track, apart, lines) {
    let own = lines.get(track);
    if (!own) lines.set(track, (own = { places: new Places(track, [0, 1, 2]), line: null, capacity: 0 }));
    let first = own.places.update();
    const { array, rows } = own.places,
      capacity = Math.ceil(array.length / 3 / apart);
    if (own.capacity < capacity || own.apart !== apart) {
      if (own.line) this.gl.remove(own.line);
      Object.assign(own, { capacity, apart, line: this.gl.line(capacity) });
      first = 0;
    }
    const from = Math.ceil(first / apart),
      some = [];
    for (let k = from * apart; k < rows; k += apart)
      some.push(array[3 * k], array[3 * k + 1], array[3 * k + 2]);
    if (some.length) this.gl.write(own.line, from, some);
    return own;
  }

  paintTails(run, view, state, scale) {
    if (!TAILS[state.tail]) return;
    const trail = trailOf(run, state),
      whole = TAILS[state.tail] === Infinity,
      crowd = run.tracks.length > 12;
    const recent = Math.max(0, state.row - Math.round(RECENT_S / run.step));
    for (const track of run.tracks) {
      const hot = Boolean(state.focus?.(track.id)),
        faint = state.focus && !hot,
        colour = faint ? state.colours.muted : state.colours.agent(track.id);
      const width = (hot ? 2.6 : crowd ? 1.3 : 2) * scale,
        style = { colour, width };
      if (whole)
        this.paintTail(run, view, track, trail.from, trail.to, {
          ...style,
          strength: faint ? 0.2 : trail.strength,
          colour: crowd && !hot ? state.colours.muted : colour,
        });
      this.paintTail(run, view, track, whole ? recent : trail.from, trail.to, {
        ...style,
        strength: faint ? 0.25 : 1,
        fades: true,
        least: whole ? trail.strength : 0.12,
        bias: 2 * LIFT,
        casing: faint || crowd ? null : state.colours.panel,
      });
    }
  }

  paintTail(run, view, track, from, to, { casing, ...style }) {
    const apart = rowsPerPiece(run, { scale: view.scale / (style.fades ? 2 : COARSER) }, !style.fades),
      { line, places } = this.lineOf(track, apart, this.lines[Number(Boolean(style.fades))]);
    const first = Math.ceil(Math.max(from, track.first) / apart),
      last = Math.floor(Math.min(to, track.last) / apart);
    const parts = knownParts(places.array, first, last, apart),
      place = { first: from / apart, count: Math.max(1, (to - from) / apart) };
    if (casing)
      this.gl.drawLine(line, parts, {
        ...style,
        ...place,
        colour: casing,
        width: 2 * style.width,
        strength: 0.6,
        bias: LIFT,
      });
    this.gl.drawLine(line, parts, { ...style, ...place });
    const end = Math.min(to, track.last),
      whole = last * apart,
      { array } = places; // what is left of a piece
    if (last >= first && end > whole && track.has(end) && track.has(whole)) {
      this.gl.drawPairs(
        [...array.subarray(3 * whole, 3 * whole + 3), ...array.subarray(3 * end, 3 * end + 3)],
        { ...style, fades: false },
      );
    }
  }
}

// The parts of a line between which something is unknown.
function knownParts(array, first, last, apart) {
  const parts = [];
  for (let i = first, from = -1; i <= last + 1; i++) {
    const x = i <= last ? array[3 * i * apart] : NaN;
    if (x === x) {
      if (from < 0) from = i;
    } else if (from >= 0) {
      parts.push([from, i - 1]);
      from = -1;
    }
  }
  return parts;
}

// The four edges of a plane.
function rim(size, axis, at) {
  const [a, b] = [0, 1, 2].filter(other => other !== axis),
    lines = [];
  const corner = (u, v) => {
    const p = [0, 0, 0];
    p[axis] = at;
    p[a] = u;
    p[b] = v;
    return p;
  };
  const around = [corner(0, 0), corner(size[a], 0), corner(size[a], size[b]), corner(0, size[b])];
  around.forEach((from, i) => lines.push(...from, ...around[(i + 1) % 4]));
  return lines;
}
