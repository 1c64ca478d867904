// What the scripts of all pages begin with.

addEventListener('error', (event) => {
  const alert = document.getElementById('alert');
  alert.hidden = false;
  alert.textContent = `This page failed: ${event.message}`;
});

const svgSpace = 'http://www.w3.org/2000/svg';

/** An element with attributes and children; strings become text. */
function make(name, attributes = {}, ...children) {
  const svg = ['svg', 'g', 'path', 'line', 'rect', 'text', 'circle', 'title', 'defs', 'clipPath', 'tspan'].includes(
    name,
  );
  const element = svg ? document.createElementNS(svgSpace, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const at = (id) => document.getElementById(id);
const plural = (count, word) => `${count.toLocaleString('en')} ${word}${count === 1 ? '' : 's'}`;

/** Three significant digits, without an exponent where they can be read. */
function number(value) {
  if (value === null || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-5) {
    const [digits, exponent] = value.toExponential(2).split('e');
    return `${Number(digits)}·10${[...String(Number(exponent))].map((c) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[c] ?? '⁻').join('')}`;
  }
  return size >= 100 ? Math.round(value).toLocaleString('en') : String(Number(value.toPrecision(3)));
}

/** The same with all three digits, for columns. */
function digits(value) {
  const text = number(value);
  return Number.isFinite(value) && value !== 0 && /^[0-9.]+$/.test(text) && Math.abs(value) < 100
    ? value.toPrecision(3)
    : text;
}

const signed = (value) => value.toFixed(2).replace('-', '−');

// ---- What is chosen stands in the address

let written = null; // the address that the page gave itself last

function writeAddress(hash) {
  written = hash;
  if (location.hash !== hash) location.replace(hash);
}

/** Reads and draws again whenever somebody else changes the address. */
function followAddress(read, draw) {
  addEventListener('hashchange', () => {
    if (location.hash === written) return;
    read();
    draw();
  });
}
