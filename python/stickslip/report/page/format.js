// Numbers and words as text, and small helpers for elements of the page.

/** A number with so many digits, in powers of ten where it is very large or small. */
function number(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, power] = value.toExponential(digits - 1).split("e");
    return `${Number(mantissa)}e${Number(power)}`;
  }
  return String(Number(value.toPrecision(digits)));
}

/** A whole number with narrow spaces between thousands. */
function counted(value) {
  return String(value).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}

/** A dimension as it is written in text: force/length². */
function dimensionText(dimension) {
  if (!dimension || dimension === "1") return "";
  return dimension.replaceAll("*", "·").replaceAll(" ", "·").replace(/\^2/g, "²").replace(/\^3/g, "³");
}

/** An element with attributes, children and text. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

function byId(id) {
  return document.getElementById(id);
}

/** Value of a colour of the style sheet. */
function styleColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Fills a selection list from groups [[group, [[value, text]]]]. */
function fillSelect(select, groups) {
  select.replaceChildren();
  for (const [group, options] of groups) {
    const into = group ? select.appendChild(make("optgroup", { label: group })) : select;
    for (const [value, text] of options) into.append(make("option", { value }, text));
  }
}
