// Draws elements and edges with WebGL2. Positions and values stand in textures, so that a frame changes nothing else.

const TEXELS = 2048; // width of the textures of nodes and elements

const COMMON = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D positions, values;
uniform vec2 centre, stretch;
vec2 place(uint node) {
  vec2 p = texelFetch(positions, ivec2(int(node) % ${TEXELS}, int(node) / ${TEXELS}), 0).xy;
  return (p - centre) * stretch;
}
float value(uint i) { return texelFetch(values, ivec2(int(i) % ${TEXELS}, int(i) / ${TEXELS}), 0).x; }
`;

const FACE_VERTEX = `${COMMON}
layout(location = 0) in uint node;
layout(location = 1) in uint cell;
uniform bool atNodes;
out float shade;
out float known;
void main() {
  float v = value(atNodes ? node : cell);
  known = v < 1e38 ? 1.0 : 0.0;
  shade = known > 0.5 ? v : 0.0;
  gl_Position = vec4(place(node), 0.0, 1.0);
}`;

const FACE_FRAGMENT = `#version 300 es
precision highp float;
in float shade;
in float known;
uniform sampler2D map;
uniform vec2 range;
uniform vec4 plain;
uniform bool coloured;
out vec4 colour;
void main() {
  float t = (shade - range.x) / (range.y - range.x);
  colour = coloured && known > 0.999 ? texture(map, vec2(clamp(t, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)) : plain;
}`;

// An edge is a rectangle of some pixels' width, which fades out over a pixel on both sides.
const EDGE_VERTEX = `${COMMON}
layout(location = 0) in uvec2 ends;
uniform vec2 pixels;
uniform float width;
out float shade;
out float known;
out float across;
void main() {
  int corner = gl_VertexID;
  bool last = corner == 1 || corner == 2 || corner == 4;
  float side = corner == 0 || corner == 1 || corner == 3 ? -1.0 : 1.0;
  vec2 a = place(ends.x), b = place(ends.y);
  vec2 way = (b - a) * pixels;
  float size = length(way);
  vec2 along = size > 0.0 ? way / size : vec2(1.0, 0.0);
  vec2 normal = vec2(-along.y, along.x);
  float half_ = 0.5 * width + 1.0;
  vec2 p = (last ? b : a) + (normal * side * half_ + along * (last ? 0.35 : -0.35) * width) / pixels;
  across = side * half_;
  float v0 = value(ends.x), v1 = value(ends.y);
  bool k0 = v0 < 1e38, k1 = v1 < 1e38;
  known = k0 || k1 ? 1.0 : 0.0;
  shade = last ? (k1 ? v1 : v0) : (k0 ? v0 : v1);
  if (known < 0.5) shade = 0.0;
  gl_Position = vec4(p, 0.0, 1.0);
}`;

const EDGE_FRAGMENT = `#version 300 es
precision highp float;
in float shade;
in float known;
in float across;
uniform sampler2D map;
uniform vec2 range;
uniform vec4 plain;
uniform bool coloured;
uniform float width;
out vec4 colour;
void main() {
  float t = (shade - range.x) / (range.y - range.x);
  if (coloured && known < 0.5) discard;
  vec4 base = coloured ? texture(map, vec2(clamp(t, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)) : plain;
  float cover = clamp(0.5 * width + 0.5 - abs(across), 0.0, 1.0) * min(width, 1.0);
  colour = vec4(base.rgb, base.a * cover);
}`;

/** A colour #rrggbb with an opacity as four numbers. */
function fourNumbers(hex, opacity = 1) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255).concat(opacity);
}

class ShadedPainter {
  /** A painter on a canvas; null where the browser has no WebGL2. */
  static on(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false });
    return gl ? new ShadedPainter(canvas, gl) : null;
  }

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.name = "WebGL2";
    this.faces = this.program(FACE_VERTEX, FACE_FRAGMENT);
    this.edges = this.program(EDGE_VERTEX, EDGE_FRAGMENT);
    this.map = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    for (const [name, kind] of [["MIN_FILTER", "LINEAR"], ["MAG_FILTER", "LINEAR"], ["WRAP_S", "CLAMP_TO_EDGE"], ["WRAP_T", "CLAMP_TO_EDGE"]]) {
      gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${name}`], gl[kind]);
    }
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(vertex, fragment) {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const logs = gl.getAttachedShaders(program).map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`the drawing program does not link: ${logs.join(" ")}`);
    }
    const places = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); i++) {
      const { name } = gl.getActiveUniform(program, i);
      places[name] = gl.getUniformLocation(program, name);
    }
    return { program, places };
  }

  /** What is drawn of a mesh; a mesh without elements is drawn by its edges. */
  layer(mesh) {
    const { gl } = this;
    const layer = { nodes: mesh.nodes, positions: this.numbers(mesh.nodes, 2) };
    if (mesh.connectivity) {
      const { nodes, cells } = triangles(mesh);
      layer.values = this.numbers(Math.max(mesh.nodes, mesh.elements), 1);
      layer.corners = nodes.length;
      layer.faces = gl.createVertexArray();
      gl.bindVertexArray(layer.faces);
      [nodes, cells].forEach((numbers, place) => this.attribute(numbers, place, 1, 0));
    }
    for (const name of ["outline", "inner", "rigid"]) {
      if (!mesh[name]?.length) continue;
      layer[name] = { count: mesh[name].length / 2, array: gl.createVertexArray() };
      gl.bindVertexArray(layer[name].array);
      this.attribute(new Uint32Array(mesh[name]), 0, 2, 1);
    }
    gl.bindVertexArray(null);
    return layer;
  }

  attribute(numbers, place, size, divisor) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribIPointer(place, size, gl.UNSIGNED_INT, 0, 0);
    gl.vertexAttribDivisor(place, divisor);
  }

  /** A texture of numbers, filled by `write`. */
  numbers(count, components) {
    const { gl } = this;
    const rows = Math.max(1, Math.ceil(count / TEXELS));
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, components === 2 ? gl.RG32F : gl.R32F, TEXELS, rows);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return { texture, rows, components, data: new Float32Array(rows * TEXELS * components) };
  }

  write(numbers) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, numbers.texture);
    const format = numbers.components === 2 ? gl.RG : gl.RED;
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, TEXELS, numbers.rows, format, gl.FLOAT, numbers.data);
  }

  colours(table) {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, table);
  }

  /** Begins a picture seen by a camera. */
  begin(camera, ground) {
    const { gl, canvas } = this;
    this.camera = camera;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...fourNumbers(ground));
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /** Writes positions of a layer, and values if it is coloured. */
  update(layer, withValues) {
    this.write(layer.positions);
    if (withValues) this.write(layer.values);
  }

  use({ program, places }, layer, paint) {
    const { gl, camera, canvas } = this;
    gl.useProgram(program);
    [["positions", layer.positions.texture], ["values", (layer.values ?? layer.positions).texture], ["map", this.map]].forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(places[name], unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform2f(places.centre, camera.x, camera.y);
    gl.uniform2f(places.stretch, (2 * camera.scale) / camera.width, (2 * camera.scale) / camera.height);
    gl.uniform2f(places.pixels, canvas.width / 2, canvas.height / 2);
    gl.uniform4fv(places.plain, paint.plain);
    gl.uniform1i(places.coloured, paint.coloured ? 1 : 0);
    gl.uniform2f(places.range, ...(paint.range ?? [0, 1]));
    return places;
  }

  /** Elements of a layer: plain, or coloured by values at nodes or of elements. */
  drawFaces(layer, paint) {
    const { gl } = this;
    const places = this.use(this.faces, layer, paint);
    gl.uniform1i(places.atNodes, paint.atNodes ? 1 : 0);
    gl.bindVertexArray(layer.faces);
    gl.drawArrays(gl.TRIANGLES, 0, layer.corners);
  }

  /** Edges of a layer with a width in pixels of the page. */
  drawEdges(layer, name, width, paint) {
    if (!layer[name]) return;
    const { gl } = this;
    const places = this.use(this.edges, layer, paint);
    gl.uniform1f(places.width, width * this.camera.density);
    gl.bindVertexArray(layer[name].array);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, 6, layer[name].count);
  }

}

/** Nodes and elements of the corners of all triangles; a quadrilateral is two. */
function triangles({ connectivity, offsets, elements }) {
  const nodes = [];
  const cells = [];
  for (let cell = 0; cell < elements; cell++) {
    const first = offsets[cell];
    for (let i = first + 1; i + 1 < offsets[cell + 1]; i++) {
      nodes.push(connectivity[first], connectivity[i], connectivity[i + 1]);
      cells.push(cell, cell, cell);
    }
  }
  return { nodes: new Uint32Array(nodes), cells: new Uint32Array(cells) };
}
