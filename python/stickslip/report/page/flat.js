// Draws elements and edges with the two-dimensional canvas, where the browser has no WebGL2 (many remote desktops).

const SHADES = 48;

class FlatPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.name = "canvas";
    this.table = colourTable("viridis");
  }

  layer(mesh) {
    const count = Math.max(mesh.nodes, mesh.elements ?? 0);
    return { mesh, positions: { data: new Float32Array(2 * mesh.nodes) }, values: { data: new Float32Array(count) } };
  }

  colours(table) {
    this.table = table;
  }

  begin(camera, ground) {
    this.camera = camera;
    this.context.setTransform(1, 0, 0, 1, 0, 0);
    this.context.fillStyle = ground;
    this.context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    this.context.scale(camera.density, camera.density);
  }

  update() {}

  x(layer, node) {
    return this.camera.width / 2 + (layer.positions.data[2 * node] - this.camera.x) * this.camera.scale;
  }

  y(layer, node) {
    return this.camera.height / 2 - (layer.positions.data[2 * node + 1] - this.camera.y) * this.camera.scale;
  }

  /** A colour of the map between the ends of the range; null where there is no value. */
  shade(value, [low, high]) {
    if (!(value < 1e38)) return null;
    const part = Math.min(Math.max((value - low) / (high - low), 0), 1);
    return Math.round(part * (SHADES - 1));
  }

  css(shade) {
    const at = 4 * Math.round((shade / (SHADES - 1)) * 255);
    return `rgb(${this.table[at]} ${this.table[at + 1]} ${this.table[at + 2]})`;
  }

  drawFaces(layer, paint) {
    const { context } = this;
    const { connectivity, offsets, elements } = layer.mesh;
    const values = layer.values.data;
    const members = Array.from({ length: SHADES + 1 }, () => []);
    for (let cell = 0; cell < elements; cell++) {
      let value = values[cell];
      if (paint.atNodes) {
        value = 0;
        for (let i = offsets[cell]; i < offsets[cell + 1]; i++) value += values[connectivity[i]];
        value /= offsets[cell + 1] - offsets[cell];
      }
      members[(paint.coloured ? this.shade(value, paint.range) : null) ?? SHADES].push(cell);
    }
    members.forEach((cells, shade) => {
      context.beginPath();
      for (const cell of cells) {
        context.moveTo(this.x(layer, connectivity[offsets[cell]]), this.y(layer, connectivity[offsets[cell]]));
        for (let i = offsets[cell] + 1; i < offsets[cell + 1]; i++) {
          context.lineTo(this.x(layer, connectivity[i]), this.y(layer, connectivity[i]));
        }
        context.closePath();
      }
      context.fillStyle = shade === SHADES ? cssOf(paint.plain) : this.css(shade);
      context.fill();
    });
  }

  drawEdges(layer, name, width, paint) {
    const edges = layer.mesh[name];
    if (!edges?.length) return;
    const { context } = this;
    context.lineWidth = width;
    context.lineCap = "round";
    const members = new Map();
    for (let i = 0; i < edges.length; i += 2) {
      const ends = [edges[i], edges[i + 1]];
      let key = "plain";
      if (paint.coloured) {
        const known = ends.map((node) => layer.values.data[node]).filter((value) => value < 1e38);
        if (known.length === 0) continue;
        key = this.shade(known.reduce((a, b) => a + b) / known.length, paint.range);
      }
      if (!members.has(key)) members.set(key, []);
      members.get(key).push(ends);
    }
    for (const [key, all] of members) {
      context.beginPath();
      for (const [a, b] of all) {
        context.moveTo(this.x(layer, a), this.y(layer, a));
        context.lineTo(this.x(layer, b), this.y(layer, b));
      }
      context.strokeStyle = key === "plain" ? cssOf(paint.plain) : this.css(key);
      context.stroke();
    }
  }

}

function cssOf([red, green, blue, opacity]) {
  return `rgb(${255 * red} ${255 * green} ${255 * blue} / ${opacity})`;
}
