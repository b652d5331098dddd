// Draws elements and edges into the pixels of a picture, without a graphics card: the same everywhere, also on remote
// desktops, and fast enough for tens of thousands of elements.
//
// An element is drawn as triangles around its middle. A pixel belongs to the triangle that holds its centre, so that neighbours leave no gap
// and do not overlap: both find the crossing of a row with their edge from its lower end. An edge covers the pixels near
// it in part, by their distance.

/** Sum of red, green and blue of pixels that are dark. */
const DARK = 330;

/** A colour #rrggbb as bytes. */
function bytesOf(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** A colour as it stands in the picture. */
function pixelOf([red, green, blue]) {
  return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
}

class Painter {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.table = new Uint32Array(256);
  }

  /** What is drawn of a mesh: positions of vertices; places in the picture and values of these and, behind them, of the
   * middles of elements; values of elements. */
  layer(mesh) {
    const { vertices, elements = 0 } = mesh;
    return {
      mesh,
      positions: new Float32Array(2 * vertices),
      values: new Float32Array(vertices + elements),
      ofElements: new Float32Array(elements),
      x: new Float64Array(vertices + elements),
      y: new Float64Array(vertices + elements),
    };
  }

  /** The middles of elements: means of what is around them. */
  middles({ mesh }, values) {
    const { connectivity, offsets, vertices, elements = 0 } = mesh;
    for (let cell = 0; cell < elements; cell++) {
      let sum = 0;
      for (let i = offsets[cell]; i < offsets[cell + 1]; i++) sum += values[connectivity[i]];
      values[vertices + cell] = sum / (offsets[cell + 1] - offsets[cell]);
    }
  }

  colours(table) {
    for (let i = 0; i < 256; i++) this.table[i] = pixelOf(table.subarray(4 * i, 4 * i + 3));
  }

  /** Begins a picture seen by a camera. */
  begin(camera, ground) {
    const { width, height } = this.canvas;
    this.camera = camera;
    if (this.image?.width !== width || this.image.height !== height) {
      this.image = this.context.createImageData(width, height);
      this.pixels = new Uint32Array(this.image.data.buffer);
    }
    this.width = width;
    this.height = height;
    this.pixels.fill(pixelOf(bytesOf(ground)));
  }

  /** Shows the picture. */
  end() {
    this.context.putImageData(this.image, 0, 0);
  }

  /** Places of the vertices of a layer and of the middles of its elements, in pixels. */
  place(layer) {
    const { camera, width, height } = this;
    const { positions, x, y } = layer;
    const stretch = camera.scale * camera.density;
    for (let vertex = 0; vertex < layer.mesh.vertices; vertex++) {
      x[vertex] = width / 2 + (positions[2 * vertex] - camera.x) * stretch;
      y[vertex] = height / 2 - (positions[2 * vertex + 1] - camera.y) * stretch;
    }
    this.middles(layer, x);
    this.middles(layer, y);
  }

  /** Elements of a layer, triangles around their middles: plain, or coloured by values at vertices or of elements. */
  drawFaces(layer, { plain, coloured, atNodes, range }) {
    const { connectivity, offsets, elements, vertices } = layer.mesh;
    const { values, ofElements } = layer;
    const base = pixelOf(bytesOf(plain));
    for (let cell = 0; cell < elements; cell++) {
      let colour = base;
      if (coloured && !atNodes && ofElements[cell] < 1e38) colour = this.table[this.shade(ofElements[cell], range)];
      let a = connectivity[offsets[cell + 1] - 1];
      for (let i = offsets[cell]; i < offsets[cell + 1]; i++) {
        const b = connectivity[i];
        const c = vertices + cell;
        const graded = coloured && atNodes && values[a] < 1e38 && values[b] < 1e38 && values[c] < 1e38;
        this.triangle(layer, a, b, c, colour, graded ? range : null);
        a = b;
      }
    }
  }

  /** Place of a value in the table of colours. */
  shade(value, range) {
    const place = (255 * (value - range[0])) / (range[1] - range[0]) + 0.5;
    return place < 0 ? 0 : place > 255 ? 255 : place | 0;
  }

  /** A triangle of one colour, or graded between the values of its corners. */
  triangle({ x, y, values }, a, b, c, colour, range) {
    // corners from top to bottom
    let swap;
    if (y[b] < y[a]) ((swap = a), (a = b), (b = swap));
    if (y[c] < y[b]) ((swap = b), (b = c), (c = swap));
    if (y[b] < y[a]) ((swap = a), (a = b), (b = swap));
    const { width, height, pixels, table } = this;
    const top = Math.max(Math.ceil(y[a] - 0.5), 0);
    const bottom = Math.min(Math.ceil(y[c] - 0.5), height);
    if (!(top < bottom)) return;
    const long = (x[c] - x[a]) / (y[c] - y[a]);
    const upper = (x[b] - x[a]) / (y[b] - y[a]);
    const lower = (x[c] - x[b]) / (y[c] - y[b]);
    let start = 0;
    let across = 0;
    let down = 0;
    if (range) {
      // shade = start + across x + down y
      const twice = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]);
      const per = 255 / (range[1] - range[0]);
      const s = (values[a] - range[0]) * per;
      const sb = (values[b] - range[0]) * per;
      const sc = (values[c] - range[0]) * per;
      across = ((sb - s) * (y[c] - y[a]) - (sc - s) * (y[b] - y[a])) / twice;
      down = ((sc - s) * (x[b] - x[a]) - (sb - s) * (x[c] - x[a])) / twice;
      start = s - across * x[a] - down * y[a] + 0.5;
    }
    for (let row = top; row < bottom; row++) {
      const middle = row + 0.5;
      const one = x[a] + long * (middle - y[a]);
      const other = middle < y[b] ? x[a] + upper * (middle - y[a]) : x[b] + lower * (middle - y[b]);
      const left = Math.max(Math.ceil((one < other ? one : other) - 0.5), 0);
      const right = Math.min(Math.ceil((one < other ? other : one) - 0.5), width);
      let at = row * width + left;
      const last = row * width + right;
      if (!range) {
        if (last - at > 24) pixels.fill(colour, at, last);
        else for (; at < last; at++) pixels[at] = colour;
        continue;
      }
      let shade = start + across * (left + 0.5) + down * middle;
      for (; at < last; at++, shade += across) pixels[at] = table[shade < 0 ? 0 : shade > 255 ? 255 : shade | 0];
    }
  }

  /** Edges of a layer with a width in pixels of the page, in one colour and one on dark pixels, or coloured by the values at
   * their ends. */
  drawEdges(layer, name, width, { plain, onDark = plain, opacity = 1, coloured = false, range }) {
    const edges = layer.mesh[name];
    if (!edges?.length) return;
    const { values } = layer;
    const thick = width * this.camera.density;
    let colour = pixelOf(bytesOf(plain));
    const lighter = coloured || onDark === plain ? null : pixelOf(bytesOf(onDark));
    for (let i = 0; i < edges.length; i += 2) {
      const a = edges[i];
      const b = edges[i + 1];
      if (coloured) {
        const [one, other] = [values[a] < 1e38, values[b] < 1e38];
        if (!one && !other) continue;
        const value = one && other ? 0.5 * (values[a] + values[b]) : one ? values[a] : values[b];
        colour = this.table[this.shade(value, range)];
      }
      this.line(layer, a, b, thick, colour, opacity, lighter);
    }
  }

  /** A line, row by row or column by column along its longer side; `lighter` is its colour on dark pixels. */
  line(layer, a, b, thick, colour, opacity, lighter = null) {
    const steep = Math.abs(layer.y[b] - layer.y[a]) > Math.abs(layer.x[b] - layer.x[a]);
    const x = steep ? layer.y : layer.x;
    const y = steep ? layer.x : layer.y;
    const back = x[b] < x[a];
    const x0 = back ? x[b] : x[a];
    const y0 = back ? y[b] : y[a];
    const x1 = back ? x[a] : x[b];
    const y1 = back ? y[a] : y[b];
    const slope = x1 > x0 ? (y1 - y0) / (x1 - x0) : 0;
    const longer = Math.sqrt(1 + slope * slope);
    const beyond = thick > 1.5 ? (0.35 * thick) / longer : 0; // so that thick lines meet at corners
    const { width, height, pixels } = this;
    const length = steep ? height : width;
    const breadth = steep ? width : height;
    const half = 0.5 * Math.max(thick, 1);
    const shorter = 1 / longer;
    const first = Math.max(Math.round(x0 - beyond), 0);
    const last = Math.min(Math.round(x1 + beyond), length);
    const reach = (half + 0.5) * longer;
    const full = 256 * opacity * Math.min(thick, 1);
    for (let at = first; at < last; at++) {
      const middle = y0 + slope * (at + 0.5 - x0) - 0.5;
      const low = Math.max(Math.ceil(middle - reach), 0);
      const high = Math.min(Math.floor(middle + reach), breadth - 1);
      for (let side = low; side <= high; side++) {
        const away = side < middle ? middle - side : side - middle;
        const near = half + 0.5 - away * shorter;
        if (near <= 0) continue;
        const cover = (near < 1 ? near * full : full) | 0;
        const index = steep ? at * width + side : side * width + at;
        const below = pixels[index];
        const isDark = lighter !== null && (below & 0xff) + ((below >>> 8) & 0xff) + ((below >>> 16) & 0xff) < DARK;
        const own = isDark ? lighter : colour;
        const redBlue = ((below & 0xff00ff) * (256 - cover) + (own & 0xff00ff) * cover) >>> 8;
        const green = ((below & 0xff00) * (256 - cover) + (own & 0xff00) * cover) >>> 8;
        pixels[index] = 0xff000000 | (redBlue & 0xff00ff) | (green & 0xff00);
      }
    }
  }
}
