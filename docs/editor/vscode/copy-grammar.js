// The grammar stands once, beside this folder; an extension holds its files in its own.
const { copyFileSync } = require("node:fs");
const { join } = require("node:path");

const grammar = "stickslip.tmLanguage.json";
copyFileSync(join(__dirname, "..", grammar), join(__dirname, "dist", grammar));
