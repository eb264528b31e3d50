// Numbers as people write and read them.

/// A number from a field, with a decimal point or comma; NaN where it is none.
function readNumber(text) {
  const plain = text.trim().replace(",", ".").replace(/\s/g, "");
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(plain) ? Number(plain) : NaN;
}

/// As few digits as say the number to `digits` significant ones.
const written = (value, digits = 4) => String(Number(value.toPrecision(digits)));

const seconds = (value) => `${value < 10 ? value.toFixed(2) : value.toFixed(1)} s`;
const millimetres = (value) => `${value.toFixed(0)} mm`;
const byId = (id) => document.getElementById(id);

/// An element with attributes and children.
function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}
