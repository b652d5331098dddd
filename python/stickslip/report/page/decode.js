// Arrays of the page: undoes what pack.py does.

/** Bytes of a blob: base64 of a deflated stream. */
async function inflated(blob) {
  const text = document.getElementById(`blob${blob}`).textContent;
  const letters = atob(text);
  const deflated = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) deflated[i] = letters.charCodeAt(i);
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Whole numbers from byte planes, lowest first, of the differences of an order from row to row. */
function wholeNumbers(bytes, { rows, columns, planes, order }) {
  const count = rows * columns;
  const whole = new Int32Array(count);
  for (let plane = 0; plane < planes; plane++) {
    const start = plane * count;
    const shift = 8 * plane;
    for (let i = 0; i < count; i++) whole[i] |= bytes[start + i] << shift;
  }
  for (let i = 0; i < count; i++) whole[i] = (whole[i] >>> 1) ^ -(whole[i] & 1);
  for (let sum = 0; sum < order; sum++) {
    for (let i = columns; i < count; i++) whole[i] += whole[i - columns];
  }
  return whole;
}

/** Values of an array of the page: Int32Array of whole numbers, Float32Array of all others. */
async function unpacked(packed) {
  const whole = wholeNumbers(await inflated(packed.blob), packed);
  if (packed.map === "bits") return new Float32Array(whole.buffer);
  if (packed.map === "linear" && packed.step === 1) return whole;
  const values = new Float32Array(whole.length);
  if (packed.map === "linear") {
    for (let i = 0; i < whole.length; i++) values[i] = whole[i] * packed.step;
  } else {
    const { small, fine, none } = packed;
    for (let i = 0; i < whole.length; i++) {
      values[i] = whole[i] === none ? NaN : small * Math.sinh(whole[i] * fine);
    }
  }
  return values;
}
