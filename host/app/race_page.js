'use strict';
// Draws the page from the two JSON elements: "race" is race.json without the curves of single seeds, "pictures" are
// data URIs. What is chosen stands in the address: #metric=relmse&view=difference&crop=X,Y,SIZE&hide=sppm,appm

addEventListener('error', (event) => {
  const alert = document.getElementById('alert');
  alert.hidden = false;
  alert.textContent = `This page failed: ${event.message}`;
});

const race = JSON.parse(document.getElementById('race').textContent);
const pictures = JSON.parse(document.getElementById('pictures').textContent);
const entrants = race.entrants.map((entrant, index) => ({...entrant, index, pictures: pictures.entrants[index]}));
const baseline = entrants.find((entrant) => entrant.name === race.baseline);
const seeds = race.seeds.length;
const views = [['picture', 'Picture'], ['difference', 'Difference'], ['radius', 'Radius']];
const cropSizes = [8, 16, 32, 64, 128].filter((size) => size <= Math.min(race.width, race.height));
if (cropSizes.length === 0) cropSizes.push(Math.min(race.width, race.height));
const percent = Math.round(100 * race.confidence);

// ---- Small helpers

const svgSpace = 'http://www.w3.org/2000/svg';

/** An element with attributes and children; strings become text. */
function make(name, attributes = {}, ...children) {
  const svg = ['svg', 'g', 'path', 'line', 'rect', 'text', 'circle', 'title', 'defs', 'clipPath', 'tspan'].includes(name);
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
  return Number.isFinite(value) && value !== 0 && /^[0-9.]+$/.test(text) && Math.abs(value) < 100 ? value.toPrecision(3) : text;
}

const signed = (value) => value.toFixed(2).replace('-', '−');

/** "1.23" with its interval behind it, if there is one. */
function estimate(value, text = digits, unit = '') {
  if (!value) return ['–'];
  if (value.low === null || value.low === value.high) return [text(value.mean) + unit];
  return [text(value.mean) + unit, ' ', make('small', {title: `${percent} % confidence interval`},
                                             `${text(value.low)}–${text(value.high)}`)];
}

// ---- What is chosen

const state = {metric: race.metrics[0].name, view: 'picture', crop: null, hidden: new Set()};

function readAddress() {
  const chosen = new URLSearchParams(location.hash.slice(1));
  if (race.metrics.some((metric) => metric.name === chosen.get('metric'))) state.metric = chosen.get('metric');
  if (views.some(([name]) => name === chosen.get('view'))) state.view = chosen.get('view');
  const crop = (chosen.get('crop') ?? '').split(',').map(Number);
  const size = cropSizes.includes(crop[2]) ? crop[2] : cropSizes[Math.min(2, cropSizes.length - 1)];
  const place = crop.length >= 2 && crop.every(Number.isFinite) ? crop : [(race.width - size) / 2, (race.height - size) / 2];
  state.crop = {x: place[0], y: place[1], size};
  const hidden = (chosen.get('hide') ?? '').split(',');
  state.hidden = new Set(entrants.map((entrant) => entrant.name).filter((name) => hidden.includes(name)));
}

function writeAddress() {
  const {x, y, size} = state.crop;
  const hide = state.hidden.size ? `&hide=${[...state.hidden].map(encodeURIComponent).join(',')}` : '';
  const hash = `#metric=${state.metric}&view=${state.view}&crop=${x},${y},${size}${hide}`;
  written = hash;
  if (location.hash !== hash) location.replace(hash);
}

let written = null;  // the address that this page gave itself last

function choose(change) {
  Object.assign(state, change);
  const pictures = 'crop' in change || 'view' in change;
  if (pictures) drawTiles(chosenMetric());
  else draw();
  writeAddress();
}

const chosenMetric = () => race.metrics.find((metric) => metric.name === state.metric);
const shown = () => entrants.filter((entrant) => !state.hidden.has(entrant.name));

// ---- Marks: every entrant has a colour and a shape

const shapes = [
  (r) => `M${-r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0`,                          // disc
  (r) => `M${-r},${-r}h${2 * r}v${2 * r}h${-2 * r}z`,                                                // square
  (r) => `M0,${-1.25 * r}L${1.2 * r},${r}H${-1.2 * r}z`,                                              // triangle
  (r) => `M0,${-1.4 * r}L${1.4 * r},0L0,${1.4 * r}L${-1.4 * r},0z`,                                    // diamond
  (r) => `M0,${1.25 * r}L${1.2 * r},${-r}H${-1.2 * r}z`,                                              // triangle down
  (r) => polygon(5, r * 1.25), (r) => star(4, r * 1.5), (r) => polygon(6, r * 1.2), (r) => star(5, r * 1.5),
  (r) => `M${-r * 1.3},${-r * 0.45}H${r * 1.3}V${r * 0.45}H${-r * 1.3}z`,                                  // bar
];

function polygon(corners, r, inner = r) {
  const points = [];
  for (let i = 0; i < (inner === r ? corners : 2 * corners); ++i) {
    const angle = 2 * Math.PI * i / (inner === r ? corners : 2 * corners);
    const length = i % 2 && inner !== r ? inner : r;
    points.push(`${(length * Math.sin(angle)).toFixed(2)},${(-length * Math.cos(angle)).toFixed(2)}`);
  }
  return `M${points.join('L')}z`;
}
const star = (corners, r) => polygon(corners, r, 0.45 * r);
const shape = (entrant, r) => shapes[entrant.index % shapes.length](r);

function key(entrant) {
  return make('svg', {class: 'key series', viewBox: '-11 -7 22 14', 'aria-hidden': 'true'},
              make('line', {x1: -11, x2: 11, y1: 0, y2: 0, stroke: entrant.colour, 'stroke-width': 2}),
              make('path', {d: shape(entrant, 4), fill: entrant.colour}));
}

const named = (entrant) => [key(entrant), make('span', {class: 'name', title: entrant.name}, entrant.name)];

// ---- Head

function drawHead() {
  const file = race.scene.file.split('/').pop();
  at('heading').textContent = `Race: ${file}`;
  const limits = [race.seconds === null ? null : `${number(race.seconds)} s`,
                  race.iterations === null ? null : plural(race.iterations, 'iteration')].filter(Boolean);
  const settings = entrants[0].settings;
  at('facts').textContent = [
    `${race.width}×${race.height} pixels`, `${plural(settings.photons, 'light path')} an iteration`,
    `${limits.join(' or ')} each with ${seeds === 1 ? `seed ${race.seeds[0]}` : `each of ${seeds} seeds`}`, race.device,
    race.interrupted ? 'interrupted' : null].filter(Boolean).join(' · ');
  const select = at('metric');
  for (const metric of race.metrics) select.append(make('option', {value: metric.name}, metric.title));
  select.addEventListener('change', () => choose({metric: select.value}));
  for (const entrant of entrants) {
    const chip = make('button', {type: 'button', class: 'chip', 'data-name': entrant.name,
                                 title: `Show or hide the curve of ${entrant.name}`}, ...named(entrant));
    chip.addEventListener('click', () => {
      const hidden = new Set(state.hidden);
      if (!hidden.delete(entrant.name)) hidden.add(entrant.name);
      choose({hidden});
    });
    at('chips').append(chip);
  }
}

function drawVerdict(metric) {
  const measured = entrants.filter((entrant) => entrant.metrics[metric.name].final);
  const verdict = at('verdict');
  verdict.replaceChildren();
  if (measured.length === 0) return;
  const best = measured.reduce((a, b) => (b.metrics[metric.name].final.mean < a.metrics[metric.name].final.mean ? b : a));
  const own = best.metrics[metric.name];
  const limit = race.interrupted || (race.seconds === null) === (race.iterations === null) ? 'At the end'
    : `After ${race.seconds === null ? plural(race.iterations, 'iteration') : `${number(race.seconds)} s`} each`;
  verdict.append(`${limit}, `, make('strong', {}, best.name), ` is nearest to the reference: ${metric.title} `,
                 make('strong', {}, number(own.final.mean)), '.');
  if (best === baseline || !own.equal_seconds.speedup) return;
  /** "1.5 times (95 %: 1.2 to 1.9) sooner", or later where the factor is below 1. */
  const times = ({mean, low, high}, more, less) => {
    const [factor, from, to] = mean >= 1 ? [mean, low, high] : [1 / mean, 1 / high, 1 / low];
    return [make('strong', {}, `${number(factor)} times`),
            low === null ? '' : ` (${percent} %: ${number(from)} to ${number(to)})`, mean >= 1 ? more : less];
  };
  verdict.append(` It reaches the error that ${baseline.name} has at its end `,
                 ...times(own.equal_seconds.speedup, ' sooner', ' later'));
  if (own.equal_iterations.speedup) {
    verdict.append(', with ', ...times(own.equal_iterations.speedup, ' fewer iterations', ' as many iterations'));
  }
  verdict.append('.');
  const {low, high} = own.equal_seconds.speedup;
  if (low !== null && low <= 1 && high >= 1) verdict.append(` ${plural(seeds, 'seed')} cannot tell that time from the same time.`);
}

// ---- Plots

/** Ticks of a logarithmic axis: [{value, major, label}]. */
function logTicks(low, high) {
  const decades = Math.log10(high / low);
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
    for (let digit = 1; digit < 10; ++digit) {
      const value = digit * 10 ** power;
      if (value < low * 0.9999 || value > high * 1.0001) continue;
      const told = digit === 1 || (decades < 2.2 && (digit === 2 || digit === 5)) || decades < 0.7;
      ticks.push({value, major: digit === 1, label: told ? number(value) : ''});
    }
  }
  return ticks;
}

function pointsOf(entrant, metric, axis) {
  return entrant.metrics[metric.name][`against_${axis}`].points.filter((point) => point.x > 0 && point.mean > 0);
}

/** What the reference says of its own error; NaN where it does not. */
function noiseOf(metric) {
  return metric.name === 'relmse' ? Number(race.reference.attributes['vkcppm.relmse']) : NaN;
}

/** Bounds of all points, a little room around them; null without points. */
function boundsOf(metric, axis) {
  const points = shown().flatMap((entrant) => pointsOf(entrant, metric, axis));
  if (points.length === 0) return null;
  const xs = points.map((point) => point.x);
  const ys = points.flatMap((point) => [point.mean, ...(point.low === null ? [] : [point.low, point.high])]);
  const room = (low, high, part) => {
    const factor = Math.max((high / low) ** part, 1.03);
    return [low / factor, high * factor];
  };
  // An interval of two seeds may span many decades: the means decide, the bands are clipped.
  const means = points.map((point) => point.mean);
  const [lowest, highest] = [Math.min(...means), Math.max(...means)];
  const noise = noiseOf(metric);
  const low = Math.min(Math.max(Math.min(...ys), lowest / 3), noise > lowest / 10 ? noise : Infinity);
  return {x: room(Math.min(...xs), Math.max(...xs), 0.02), y: room(low, Math.min(Math.max(...ys), highest * 3), 0.04)};
}

function plot(figure, metric, axis) {
  const title = axis === 'iterations' ? 'iterations' : 'seconds on the clock';
  const bounds = boundsOf(metric, axis);
  figure.replaceChildren();
  if (!bounds) {
    figure.append(make('p', {class: 'quiet'}, `There is no ${metric.title} greater than 0 to draw.`));
    return;
  }
  const width = Math.max(280, Math.round(figure.clientWidth - 26)), height = Math.round(Math.min(420, Math.max(270, 0.68 * width)));
  const box = {left: 58, right: width - 10, top: 26, bottom: height - 40};
  const map = ([low, high], from, to) => (value) => from + (to - from) * Math.log(value / low) / Math.log(high / low);
  const px = map(bounds.x, box.left, box.right), py = map(bounds.y, box.bottom, box.top);
  const f = (value) => value.toFixed(1);

  const clip = `clip-${axis}`;
  const svg = make('svg', {viewBox: `0 0 ${width} ${height}`, height, role: 'img', 'data-metric': metric.name,
                           'aria-label': `${metric.title} against ${title}, both logarithmic; the table below has the numbers`},
    make('defs', {}, make('clipPath', {id: clip}, make('rect', {x: box.left, y: box.top, width: box.right - box.left,
                                                                 height: box.bottom - box.top}))),
    make('text', {class: 'title', x: 0, y: 13}, `${metric.title} against ${title}`));
  let lastLabel = -Infinity;
  for (const tick of logTicks(...bounds.x)) {
    const x = f(px(tick.value));
    svg.append(make('line', {class: tick.major ? 'grid major' : 'grid', x1: x, x2: x, y1: box.top, y2: box.bottom}));
    if (!tick.label || px(tick.value) - lastLabel < 34) continue;
    lastLabel = px(tick.value);
    svg.append(make('text', {x, y: box.bottom + 17, 'text-anchor': 'middle'}, tick.label));
  }
  let lastY = Infinity;
  for (const tick of logTicks(...bounds.y)) {
    const y = f(py(tick.value));
    svg.append(make('line', {class: tick.major ? 'grid major' : 'grid', x1: box.left, x2: box.right, y1: y, y2: y}));
    if (!tick.label || lastY - py(tick.value) < 14) continue;
    lastY = py(tick.value);
    svg.append(make('text', {x: box.left - 6, y: Number(y) + 4, 'text-anchor': 'end'}, tick.label));
  }
  svg.append(make('text', {x: (box.left + box.right) / 2, y: height - 5, 'text-anchor': 'middle'}, title));

  const goal = baseline.metrics[metric.name].final;
  if (goal && goal.mean > bounds.y[0] && goal.mean < bounds.y[1]) {
    const y = f(py(goal.mean));
    svg.append(make('line', {class: 'level', x1: box.left, x2: box.right, y1: y, y2: y}),
               make('text', {x: box.left + 6, y: Number(y) + 15}, `${baseline.name} at its end`));
  }

  const noise = noiseOf(metric);
  if (noise > bounds.y[0] && noise < bounds.y[1]) {
    const y = f(py(noise));
    svg.append(make('line', {class: 'level', 'data-noise': noise, x1: box.left, x2: box.right, y1: y, y2: y}),
               make('text', {x: box.right - 4, y: Number(y) - 6, 'text-anchor': 'end'}, 'noise of the reference'));
  }

  const lines = make('g', {'clip-path': `url(#${clip})`});
  for (const entrant of shown()) {
    const points = pointsOf(entrant, metric, axis);
    if (points.length === 0) continue;
    const group = make('g', {class: 'series', 'data-name': entrant.name});
    const banded = points.filter((point) => point.low > 0);
    if (banded.length > 1) {
      const edge = (side) => banded.map((point) => `${f(px(point.x))},${f(Math.max(-1e4, Math.min(1e4, py(point[side]))))}`);
      group.append(make('path', {class: 'band', fill: entrant.colour, opacity: Math.min(0.16, 0.6 / entrants.length), d: `M${[...edge('low'), ...edge('high').reverse()].join('L')}z`}));
    }
    group.append(make('path', {class: 'line', stroke: entrant.colour,
                               d: `M${points.map((point) => `${f(px(point.x))},${f(py(point.mean))}`).join('L')}`}));
    let last = -Infinity;
    for (const point of points) {
      const x = px(point.x);
      if (x - last < 22 && point !== points[points.length - 1]) continue;
      last = x;
      group.append(make('path', {class: 'mark', fill: entrant.colour, d: shape(entrant, 3.6),
                                 transform: `translate(${f(x)} ${f(py(point.mean))})`}));
    }
    lines.append(group);
  }
  const cursor = make('line', {class: 'cursor', y1: box.top, y2: box.bottom, visibility: 'hidden'});
  svg.append(lines, cursor);
  const tip = make('div', {class: 'tip', hidden: 'hidden'});

  const legend = make('ul', {class: 'legend'});
  for (const entrant of shown()) {
    const {slope} = entrant.metrics[metric.name][`against_${axis}`];
    const spread = slope && slope.low !== null ? ` ± ${((slope.high - slope.low) / 2).toFixed(2)}` : '';
    const row = make('li', {'data-name': entrant.name}, ...named(entrant),
                     make('span', {class: 'slope', title: 'slope in the log-log plot'},
                          slope ? `slope ${signed(slope.mean)}${spread}` : 'no slope'));
    const fade = (others) => () => {
      for (const group of lines.children) group.classList.toggle('faded', others && group.dataset.name !== entrant.name);
    };
    row.addEventListener('pointerenter', fade(true));
    row.addEventListener('pointerleave', fade(false));
    legend.append(row);
  }
  figure.append(svg, tip, legend);

  svg.addEventListener('pointermove', (event) => {
    const scale = width / svg.clientWidth;
    const x = (event.clientX - svg.getBoundingClientRect().left) * scale;
    const nearest = (points) => points.reduce((a, b) => (Math.abs(px(b.x) - x) < Math.abs(px(a.x) - x) ? b : a));
    const rows = shown().map((entrant) => ({entrant, points: pointsOf(entrant, metric, axis)}))
      .filter(({points}) => points.length > 0).map(({entrant, points}) => ({entrant, point: nearest(points)}))
      .sort((a, b) => b.point.mean - a.point.mean);
    if (rows.length === 0) return;
    const snapped = px(nearest(rows.map(({point}) => point)).x);
    cursor.setAttribute('x1', snapped);
    cursor.setAttribute('x2', snapped);
    cursor.setAttribute('visibility', 'visible');
    tip.hidden = false;
    tip.replaceChildren(make('table', {}, ...rows.map(({entrant, point}) => make('tr', {},
      make('td', {}, ...named(entrant)), make('td', {}, ...(rows.length > 5 ? [digits(point.mean)] : estimate(point))),
      make('td', {class: 'quiet'}, `${number(point.x)}${axis === 'seconds' ? ' s' : ''}`)))));
    const right = snapped / scale > svg.clientWidth / 2;
    tip.style.left = right ? '' : `${snapped / scale + 26}px`;
    tip.style.right = right ? `${svg.clientWidth - snapped / scale + 26}px` : '';
    tip.style.top = '44px';
  });
  svg.addEventListener('pointerleave', () => {
    tip.hidden = true;
    cursor.setAttribute('visibility', 'hidden');
  });
}

function drawPlots(metric) {
  plot(at('plot-iterations'), metric, 'iterations');
  plot(at('plot-seconds'), metric, 'seconds');
}

// ---- Tables

const row = (kind, cells) => make('tr', {}, ...cells.map((cell) => (cell instanceof Node ? cell : make(kind, {}, cell))));
const cells = (parts, best) => make('td', best ? {class: 'best'} : {}, ...parts);
const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const totals = (entrant, name) => entrant.runs.reduce((sum, run) => sum + run[name], 0);

/** The entrants as the table ranks them: by time to equal error, then by the error at the end. */
function ranked(metric) {
  const rank = (entrant) => entrant.metrics[metric.name].equal_seconds.at?.mean ?? Infinity;
  const end = (entrant) => entrant.metrics[metric.name].final?.mean ?? Infinity;
  return [...entrants].sort((a, b) => (rank(a) === rank(b) ? end(a) - end(b) : rank(a) - rank(b)));
}

function drawEqual(metric) {
  const least = (read) => Math.min(...entrants.map(read).filter(Number.isFinite));
  const values = (entrant) => entrant.metrics[metric.name];
  const bestEnd = least((entrant) => values(entrant).final?.mean);
  const table = at('equal');
  const unreached = (equal) => (equal.reached === 0 ? 'not reached' : `reached by ${equal.reached} of ${seeds} seeds`);
  const equal = (entrant, axis) => {
    const {reached, at: place, speedup} = values(entrant)[`equal_${axis}`];
    if (!place) return [make('td', {colspan: 2, class: 'quiet'}, unreached({reached}))];
    const best = place.mean === least((other) => values(other)[`equal_${axis}`].at?.mean);
    return [cells(estimate(place, entrant === baseline && axis === 'iterations' ? number : digits), best),
            entrant === baseline ? make('td', {}, '1×') : cells(estimate(speedup, digits, '×'), best)];
  };
  table.replaceChildren(
    make('thead', {},
      make('tr', {}, make('th', {rowspan: 2}, 'estimator'), make('th', {class: 'group', colspan: 3}, 'at its end'),
           make('th', {class: 'group', colspan: 4}, `to the error of ${baseline.name} at its end`)),
      row('th', [metric.title, 'iterations', 'seconds', 'iterations', 'fewer', 'seconds', 'sooner'])),
    make('tbody', {}, ...ranked(metric).map((entrant) => {
      const iterations = totals(entrant, 'iterations'), seconds = totals(entrant, 'seconds');
      const {final} = values(entrant);
      return make('tr', {'data-name': entrant.name},
        make('th', {scope: 'row'}, ...named(entrant), entrant === baseline ? make('span', {class: 'badge'}, 'baseline') : null),
        cells(estimate(final), final?.mean === bestEnd), cells([number(iterations / seeds)]), cells([digits(seconds / seeds)]),
        ...equal(entrant, 'iterations'), ...equal(entrant, 'seconds'));
    })));
}

/** Kernels by the pass that they belong to. */
const passes = [['eye', /^eye$/], ['photon', /^photon$/], ['grid', /^(grid|scan|radix)/], ['knn', /^knn$/],
                ['gather', /^gather$/], ['update', /^(update|advance)$/]];

function drawCost() {
  const milliseconds = (entrant, kernels) => 1000 / totals(entrant, 'iterations') * entrant.runs.reduce((sum, run) =>
    sum + Object.entries(run.pass_seconds).filter(([name]) => kernels.test(name)).reduce((all, [, value]) => all + value, 0), 0);
  at('cost').replaceChildren(
    make('thead', {}, row('th', ['estimator', ...passes.map(([name]) => name), 'all', 'photons stored an iteration'])),
    make('tbody', {}, ...entrants.map((entrant) => {
      const each = passes.map(([, kernels]) => milliseconds(entrant, kernels));
      return make('tr', {}, make('th', {scope: 'row'}, ...named(entrant)), ...each.map((value) => make('td', {}, digits(value))),
        make('td', {}, digits(each.reduce((a, b) => a + b, 0))),
        make('td', {}, number(totals(entrant, 'stored_photons') / totals(entrant, 'iterations'))));
    })));
}

// ---- Pictures

/** A figure with a picture that takes clicks, and its crop. */
function tile(name, caption) {
  const image = make('img', {alt: `${name}: the whole picture`, width: race.width, height: race.height, draggable: 'false'});
  const frame = make('div', {class: 'frame'});
  const whole = make('div', {class: 'whole', tabindex: 0, role: 'application', 'aria-label': `${name}: move the crop with the arrow keys`},
                     image, frame);
  const magnified = make('img', {alt: `${name}: the crop, magnified`});
  const crop = make('div', {class: 'crop'}, magnified);
  const pick = (event) => {
    const bounds = image.getBoundingClientRect();
    const {size} = state.crop;
    choose({crop: {size, x: Math.round((event.clientX - bounds.left) / bounds.width * race.width - size / 2),
                   y: Math.round((event.clientY - bounds.top) / bounds.height * race.height - size / 2)}});
  };
  whole.addEventListener('pointerdown', (event) => {
    whole.setPointerCapture(event.pointerId);
    pick(event);
  });
  whole.addEventListener('pointermove', (event) => {
    if (event.buttons & 1) pick(event);
  });
  whole.addEventListener('keydown', (event) => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (!step) return;
    event.preventDefault();
    const far = event.shiftKey ? state.crop.size : 1;
    choose({crop: {...state.crop, x: state.crop.x + far * step[0], y: state.crop.y + far * step[1]}});
  });
  const figure = make('figure', {class: 'tile', 'data-name': name}, caption, whole, crop);
  return {figure, image, frame, magnified, crop};
}

const tiles = [];

function buildTiles() {
  const reference = tile('reference', make('figcaption', {}, make('strong', {}, 'reference')));
  tiles.push({...reference, source: () => pictures.reference});
  for (const entrant of entrants) {
    const told = make('span', {class: 'quiet'});
    const own = tile(entrant.name, make('figcaption', {}, ...named(entrant), told));
    tiles.push({...own, entrant, told, source: () => entrant.pictures[state.view]});
  }
  at('tiles').append(...tiles.map(({figure}) => figure));
  const captions = [['winner', 'a pixel', 'pixels_won'],
                    ['winner_around', `over ${2 * race.winner_reach + 1}×${2 * race.winner_reach + 1} pixels about one`, 'pixels_won_around']];
  for (const [name, title, share] of captions) {
    const own = tile(`nearest ${title}`, make('figcaption', {}, make('strong', {}, `Least squared error ${title}`)));
    const rest = 1 - entrants.reduce((sum, entrant) => sum + entrant[share], 0);
    const line = (label, part, colour) => make('li', {}, ...label,
      make('span', {class: 'slope'}, `${(100 * part).toFixed(1)} %`),
      make('span', {class: 'meter'}, make('i', {style: `width:${(100 * part).toFixed(2)}%;background:${colour}`})));
    const legend = make('ul', {class: 'legend'}, ...entrants.map((entrant) => line(named(entrant), entrant[share], entrant.colour)),
      rest > 5e-4 ? line([make('span', {class: 'name'}, 'draw (gray)')], rest, '#c8c8c8') : null);
    own.crop.replaceWith(legend);
    tiles.push({...own, source: () => pictures[name]});
    at('winners').append(own.figure);
  }
  for (const {image, magnified, source} of tiles) image.src = magnified.src = source();
  for (const [name, title] of views) {
    const button = make('button', {type: 'button', 'data-view': name}, title);
    button.addEventListener('click', () => choose({view: name}));
    at('views').append(button);
  }
  const select = at('crop-size');
  for (const size of cropSizes) select.append(make('option', {value: size}, `${size}×${size}`));
  select.addEventListener('change', () => {
    const size = Number(select.value), {x, y, size: old} = state.crop;
    choose({crop: {size, x: Math.round(x + (old - size) / 2), y: Math.round(y + (old - size) / 2)}});
  });
}

/** So many pictures side by side that none is too small and the last row is not left with few. */
function columns() {
  const count = entrants.length + 1, most = Math.max(2, Math.floor(at('tiles').clientWidth / 190));
  return Math.ceil(count / Math.ceil(count / most));
}

function drawTiles(metric) {
  const crop = state.crop;
  crop.x = Math.round(Math.max(0, Math.min(race.width - crop.size, crop.x)));
  crop.y = Math.round(Math.max(0, Math.min(race.height - crop.size, crop.y)));
  const part = (value, of) => `${100 * value / of}%`;
  for (const {image, frame, magnified, crop: box, source, entrant, told} of tiles) {
    if (image.src !== source()) image.src = magnified.src = source();
    Object.assign(frame.style, {left: part(crop.x, race.width), top: part(crop.y, race.height),
                                width: part(crop.size, race.width), height: part(crop.size, race.height)});
    box.style.aspectRatio = '1';
    Object.assign(magnified.style, {width: part(race.width, crop.size), height: part(race.height, crop.size),
                                    left: part(-crop.x, crop.size), top: part(-crop.y, crop.size)});
    if (entrant) {
      told.textContent = digits(entrant.metrics[metric.name].final?.mean ?? null);
      told.title = `${metric.title} at its end`;
    }
  }
  at('tiles').style.setProperty('--columns', columns());
  at('crop-size').value = crop.size;
  at('crop-place').textContent = `from column ${crop.x}, row ${crop.y}`;
  for (const button of at('views').children) button.setAttribute('aria-pressed', button.dataset.view === state.view);
  const scale = {difference: race.difference_scale, radius: race.radius_scale}[state.view];
  const unit = state.view === 'radius' ? 'm' : 'W m⁻² sr⁻¹';
  at('scale').replaceChildren(...(scale ? [`${number(scale.low)} ${unit}`,
    make('img', {src: pictures.ramp, alt: 'colours from blue over yellow to red'}),
    `${number(scale.high)} ${unit}${scale.logarithmic ? ', logarithmic' : ' and more'}`] : []));
}

// ---- Foot

function drawSettings() {
  at('command').textContent = race.command;
  at('copy').addEventListener('click', () => {
    const chosen = document.createRange();
    chosen.selectNodeContents(at('command'));
    getSelection().removeAllRanges();
    getSelection().addRange(chosen);
    navigator.clipboard?.writeText(race.command).then(() => { at('copy').textContent = 'Copied'; }, () => {});
  });
  const settings = entrants[0].settings;
  const own = ['estimator', 'knn', 'alpha', 'k', 'beta', 'significance', 'rings', 'sectors'];
  const common = Object.entries(settings).filter(([name]) => ![...own, 'iterations', 'time', 'seed'].includes(name));
  const lines = [
    ['scene', race.scene.file], ['hash of the scene', race.scene.hash], ['environment', race.scene.environment ?? 'none'],
    ['glass without a volume', race.scene.thin_glass], ['reference', race.reference.file], ...Object.entries(race.reference.attributes)
      .filter(([name]) => ['iterations_done', 'samples_done', 'estimator', 'photons', 'relmse'].includes(name.replace('vkcppm.', '')))
      .map(([name, value]) => [`${name.replace('vkcppm.', '').replace('_', ' ')} of the reference`, value]),
    ['each gets', at('facts').textContent.split(' · ')[2].replace(' each with', ' with')], ['seeds', race.seeds.join(', ')],
    ...common.map(([name, value]) => [name.replace('_', ' '), String(value)]),
    ['exposure of the pictures', `${race.exposure} stops`], ['device', race.device], ['driver', race.driver],
    ['version', `vkcppm ${race.version}`]];
  at('settings').append(make('tbody', {}, ...lines.map(([name, value]) => make('tr', {}, make('th', {scope: 'row'}, name), make('td', {}, value)))));
  at('parameters').append(
    make('thead', {}, row('th', own)),
    make('tbody', {}, ...entrants.map((entrant) => make('tr', {}, make('th', {scope: 'row'}, key(entrant), ` ${entrant.settings.estimator}`),
      ...own.slice(1).map((name) => make('td', {class: entrant.settings[name] === settings[name] ? '' : 'best'}, number(entrant.settings[name])))))));
}

function drawNotes() {
  const spread = seeds === 1
    ? 'There is one seed, so nothing tells how much of a difference is chance: --seeds 3 adds confidence bands.'
    : `Curves are geometric means over ${seeds} seeds; bands and ranges are ${percent} % confidence intervals by Student’s t on the logarithms.`;
  at('curves-note').textContent = `Both axes are logarithmic. ${spread} A slope is the least squares fit over the last factor of ten; ` +
    'of a squared error −1 is that of noise alone, −2/3 the best asymptotic rate of progressive photon mapping (Kaplanyan and Dachsbacher 2013).';
  at('equal-note').textContent = `Where each curve, interpolated log-log, first comes down to the error that ${baseline.name} ` +
    `has at its end, seed by seed; “sooner” and “fewer” are ${baseline.name}’s own over that.`;
  at('pictures-note').textContent = `Pictures and maps are those of seed ${race.seeds[0]} at its end. The difference is the ` +
    'absolute one, mean over the channels; the radius is that of the disc over which photons are gathered.';
  at('winner-note').textContent = `Errors are squared, means over channels${seeds === 1 ? '' : ` and ${seeds} seeds`}, each estimator at its end. ` +
    'A single pixel is a throw of dice between good estimators; over its neighbours it shows where one is better.';
  at('settings-note').textContent = 'With the same device and driver the error against iterations is the same to the last bit. ' +
    'race.json holds all of this and every snapshot, curves.csv the snapshots alone; pictures are beside them as EXR and PNG.';
}

// ---- All

function draw() {
  const metric = chosenMetric();
  at('metric').value = metric.name;
  for (const chip of at('chips').children) chip.setAttribute('aria-pressed', !state.hidden.has(chip.dataset.name));
  drawVerdict(metric);
  drawPlots(metric);
  drawEqual(metric);
  drawTiles(metric);
}

readAddress();
drawHead();
drawSettings();
drawNotes();
drawCost();
buildTiles();
draw();
addEventListener('hashchange', () => {
  if (location.hash === written) return;
  readAddress();
  draw();
});
let lastWidth = innerWidth;
addEventListener('resize', () => {
  if (innerWidth === lastWidth) return;
  lastWidth = innerWidth;
  draw();
});
