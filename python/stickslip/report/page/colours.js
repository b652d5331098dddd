// Maps from numbers to colours: perceptually even ones of matplotlib (viridis, cividis, magma: CC0; cool-warm: Moreland).

const MAPS = {
  viridis:
    "440154470d6048186a482374472d7b4537814240863e49893b528b375b8d33638d2f6b8e2c728e297a8e26828e23898e21918c" +
    "1f988b1fa08822a78528ae8032b67a3fbc734ec36b5ec96270cf5784d44b98d83eaddc30c2df23d8e219ece51bfde725",
  cividis:
    "00224e00285b002e6a0533711a386f273e6e32436d3b496c434e6c4b546c535a6d5a5f6e61656f686a716f70737676767d7c78" +
    "8482798c8878938e789b9476a39a74aba072b4a76fbcae6cc4b468cdbb63d5c25edec958e7d150f0d846f9e03afee838",
  magma:
    "0000040303120a0822130d341d114729115a36106b440f7651127c5d177f6a1c81762181832681902a819c2e7faa337db73779" +
    "c43c75d0416fdc4869e75263ef5d5ef56b5cf9795dfc8961fd9869fea772feb67cfec488fed395fde2a3fcf0b2fcfdbf",
  "cool-warm":
    "3b4cc0445acc4e68d85875e16282ea6c8ff1779af782a6fb8db0fe98b9ffa3c2feaec9fcb9d0f9c3d5f4ccd9edd5dbe5dddcdc" +
    "e5d8d1ecd3c5f1ccb8f5c4acf7ba9ff7b093f6a586f4987af08b6eeb7d62e46e56dd5f4bd44e41ca3b37be242eb40426",
  grey: "2b2b2bf2f2f2",
  bodies: "8fb0d3e3b587a5c9a1d3a0a8b7aed4d6cf92a0cfcbc4b5a7",
};

/** 256 colours [4 bytes each] of a map, in so many bands where their number is not 0; those of bodies are steps. */
function colourTable(name, bands = 0) {
  const text = MAPS[name];
  const count = text.length / 6;
  const knots = [];
  for (let i = 0; i < count; i++) {
    knots.push([0, 2, 4].map((at) => parseInt(text.slice(6 * i + at, 6 * i + at + 2), 16)));
  }
  const table = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; i++) {
    const place = name === "bodies" ? Math.floor((i / 256) * count) : banded(i, bands) * (count - 1);
    const left = Math.min(Math.floor(place), count - 1);
    const right = Math.min(left + 1, count - 1);
    for (let k = 0; k < 3; k++) {
      table[4 * i + k] = Math.round(knots[left][k] + (place - left) * (knots[right][k] - knots[left][k]));
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

/** Part of a map at the place i of 256. */
function banded(i, bands) {
  return bands ? Math.min(Math.floor((i / 256) * bands), bands - 1) / (bands - 1) : i / 255;
}

/** Colours of the curves of a chart. */
const CURVES = ["#2f6fb3", "#d1495b", "#2e8b57", "#e08e0b", "#7d5ba6", "#17a2b8", "#8d6e52", "#c2589b", "#7f8c2d", "#5c6b73", "#3f51b5", "#a33b2a"];
