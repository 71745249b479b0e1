// SPDX-License-Identifier: BSD-3-Clause
// Draws wide lines and textured planes with WebGL; it knows no mission.
// Lines join successive places, and planes carry pictures.
const PLACE = 32; // bytes of a place of a line: two vertices
const UNKNOWN = -1e30;
const CORNERS = [
  [0, -1],
  [0, 1],
  [1, -1],
  [1, -1],
  [0, 1],
  [1, 1],
]; // of a line: end, side

// A line is a strip of two vertices a place: `at` has the place and which side of the line it is.
const LINES = [
  `#version 300 es
in vec4 at;
in vec3 before, after;
uniform mat4 matrix;
uniform vec2 size;                         // of the canvas, in its pixels
uniform float width, bias, first, count, fades;
out float along;
bool known(vec3 place) { return place.x > -1e29; }
void main() {
  vec4 p = matrix * vec4(at.xyz, 1.0);
  vec4 q = known(before) ? matrix * vec4(before, 1.0) : p, r = known(after) ? matrix * vec4(after, 1.0) : p;
  vec2 way = (r.xy / r.w - q.xy / q.w) * size;
  way = length(way) > 1e-6 ? normalize(way) : vec2(1.0, 0.0);
  p.xy += vec2(-way.y, way.x) * at.w * width / size * p.w;
  p.z -= bias * p.w;
  along = fades > 0.5 ? clamp((float(gl_VertexID / 2) - first) / count, 0.0, 1.0) : 1.0;
  gl_Position = p;
}`,
  `#version 300 es
precision mediump float;
in float along;
uniform vec3 ground, colour;
uniform float strength, least;
out vec4 pixel;
void main() { pixel = vec4(mix(ground, colour, strength * mix(least, 1.0, pow(along, 1.5))), 1.0); }`,
];

const PLANES = [
  `#version 300 es
in vec3 at;
in vec2 from;
uniform mat4 matrix;
out vec2 place;
void main() { place = from; gl_Position = matrix * vec4(at, 1.0); }`,
  `#version 300 es
precision mediump float;
in vec2 place;
uniform sampler2D picture;
out vec4 pixel;
void main() { vec4 c = texture(picture, place); pixel = vec4(c.rgb * c.a, c.a); }`,
];

function programOf(gl, sources) {
  const program = gl.createProgram();
  sources.forEach((source, i) => {
    const shader = gl.createShader(i ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  });
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  const at = {};
  for (const [kind, find, locate] of [
    [gl.ACTIVE_UNIFORMS, 'getActiveUniform', 'getUniformLocation'],
    [gl.ACTIVE_ATTRIBUTES, 'getActiveAttrib', 'getAttribLocation'],
  ]) {
    for (let i = 0; i < gl.getProgramParameter(program, kind); i++) {
      const { name } = gl[find](program, i);
      at[name] = gl[locate](program, name);
    }
  }
  return { program, at };
}

// "#rrggbb" or "#rgb" → three shares.
const sharesOf = hex =>
  hex.length < 7
    ? [1, 2, 3].map(i => parseInt(hex[i], 16) / 15)
    : [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255);

export class SpaceGl {
  // null if this browser has no WebGL 2.
  static on(canvas) {
    const gl = canvas.getContext('webgl2', { antialias: true, alpha: false, preserveDrawingBuffer: true });
    if (!gl) return null;
    const lines = programOf(gl, LINES),
      planes = programOf(gl, PLANES);
    return lines && planes
      ? Object.assign(new SpaceGl(), { gl, lines, planes, scratch: gl.createBuffer() })
      : null;
  }
  begin(matrix, colour) {
    const { gl } = this,
      { width, height } = gl.canvas;
    Object.assign(this, { matrix, ground: sharesOf(colour) });
    gl.viewport(0, 0, width, height);
    gl.clearColor(...this.ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }
  // A buffer for a line of so many places, none of which is known yet.
  line(places) {
    const { gl } = this,
      made = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, made);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(8 * (places + 2)).fill(UNKNOWN), gl.DYNAMIC_DRAW);
    return made;
  }
  // Writes x, y, z of places from the n-th on; NaN is an unknown place.
  write(line, n, places) {
    const { gl } = this,
      vertices = new Float32Array((8 * places.length) / 3);
    for (let i = 0, o = 0; i < places.length; i += 3)
      for (const side of [-1, 1]) {
        const x = places[i];
        vertices[o++] = x === x ? x : UNKNOWN;
        vertices[o++] = places[i + 1];
        vertices[o++] = places[i + 2];
        vertices[o++] = side;
      }
    gl.bindBuffer(gl.ARRAY_BUFFER, line);
    gl.bufferSubData(gl.ARRAY_BUFFER, PLACE * (n + 1), vertices);
  }
  remove(line) {
    this.gl.deleteBuffer(line);
  }
  useLines({ first = 0, count = 1, width, colour, strength = 1, fades = false, least = 0.12, bias = 0 }) {
    const {
      gl,
      lines: { program, at },
    } = this;
    gl.useProgram(program);
    gl.uniformMatrix4fv(at.matrix, false, this.matrix);
    gl.uniform2f(at.size, gl.canvas.width, gl.canvas.height);
    gl.uniform3fv(at.ground, this.ground);
    gl.uniform3fv(at.colour, sharesOf(colour));
    for (const [name, value] of Object.entries({
      first,
      count,
      width,
      strength,
      least,
      bias,
      fades: Number(fades),
    }))
      gl.uniform1f(at[name], value);
  }
  // Parts of a line from place to place, [[from, to], …], all known. `style`: width in pixels of the
  // canvas, colour, strength; a line that fades begins at place `first` with the share `least` of its
  // strength, and has all of it `count` places later.
  drawLine(line, parts, style) {
    const {
      gl,
      lines: { at },
    } = this;
    this.useLines(style);
    gl.bindBuffer(gl.ARRAY_BUFFER, line);
    for (const [name, length, offset] of [
      ['before', 3, 0],
      ['at', 4, PLACE],
      ['after', 3, 2 * PLACE],
    ])
      this.attribute(at[name], length, PLACE / 2, offset);
    for (const [from, to] of parts)
      if (to > from) gl.drawArrays(gl.TRIANGLE_STRIP, 2 * from, 2 * (to - from + 1));
    for (const name of ['before', 'at', 'after']) gl.disableVertexAttribArray(at[name]);
  }
  attribute(index, length, stride, offset) {
    this.gl.enableVertexAttribArray(index);
    this.gl.vertexAttribPointer(index, length, this.gl.FLOAT, false, stride, offset);
  }
  // Lines between pairs of places, a list of numbers.
  drawPairs(places, style) {
    const {
        gl,
        scratch,
        lines: { at },
      } = this,
      vertices = [];
    for (let i = 0; i < places.length; i += 6) {
      const a = places.slice(i, i + 3),
        b = places.slice(i + 3, i + 6);
      for (const [end, side] of CORNERS) vertices.push(...(end ? b : a), side, ...a, ...b);
    }
    this.useLines(style);
    gl.bindBuffer(gl.ARRAY_BUFFER, scratch);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.STREAM_DRAW);
    for (const [name, length, offset] of [
      ['at', 4, 0],
      ['before', 3, 16],
      ['after', 3, 28],
    ])
      this.attribute(at[name], length, 40, offset);
    gl.drawArrays(gl.TRIANGLES, 0, places.length);
    for (const name of ['before', 'at', 'after']) gl.disableVertexAttribArray(at[name]);
  }
  // An ImageData as a texture; its first row has the texture's v = 0.
  texture(image, before) {
    const { gl } = this,
      made = before ?? gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, image);
    for (const kind of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
      gl.texParameteri(gl.TEXTURE_2D, kind, gl.LINEAR);
    for (const kind of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
      gl.texParameteri(gl.TEXTURE_2D, kind, gl.CLAMP_TO_EDGE);
    return made;
  }
  // A part of a picture over what is there; four times x, y, z, u, v.
  drawPlane(texture, corners) {
    const {
      gl,
      scratch,
      planes: { program, at },
    } = this;
    gl.useProgram(program);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.bindBuffer(gl.ARRAY_BUFFER, scratch);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(corners.flat()), gl.STREAM_DRAW);
    for (const [name, length, offset] of [
      ['at', 3, 0],
      ['from', 2, 12],
    ])
      this.attribute(at[name], length, 20, offset);
    gl.uniformMatrix4fv(at.matrix, false, this.matrix);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    for (const name of ['at', 'from']) gl.disableVertexAttribArray(at[name]);
  }
}
