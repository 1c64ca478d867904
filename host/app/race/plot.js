// The plots of the page of a race, and the marks of its entrants: every one has a colour and a shape.

const shapes = [
  (r) => `M${-r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0`, // disc
  (r) => `M${-r},${-r}h${2 * r}v${2 * r}h${-2 * r}z`, // square
  (r) => `M0,${-1.25 * r}L${1.2 * r},${r}H${-1.2 * r}z`, // triangle
  (r) => `M0,${-1.4 * r}L${1.4 * r},0L0,${1.4 * r}L${-1.4 * r},0z`, // diamond
  (r) => `M0,${1.25 * r}L${1.2 * r},${-r}H${-1.2 * r}z`, // triangle down
  (r) => polygon(5, r * 1.25),
  (r) => star(4, r * 1.5),
  (r) => polygon(6, r * 1.2),
  (r) => star(5, r * 1.5),
  (r) => `M${-r * 1.3},${-r * 0.45}H${r * 1.3}V${r * 0.45}H${-r * 1.3}z`, // bar
];

function polygon(corners, r, inner = r) {
  const points = [];
  for (let i = 0; i < (inner === r ? corners : 2 * corners); ++i) {
    const angle = (2 * Math.PI * i) / (inner === r ? corners : 2 * corners);
    const length = i % 2 && inner !== r ? inner : r;
    points.push(`${(length * Math.sin(angle)).toFixed(2)},${(-length * Math.cos(angle)).toFixed(2)}`);
  }
  return `M${points.join('L')}z`;
}
const star = (corners, r) => polygon(corners, r, 0.45 * r);
const shape = (entrant, r) => shapes[entrant.index % shapes.length](r);

function key(entrant) {
  return make(
    'svg',
    {class: 'key series', viewBox: '-11 -7 22 14', 'aria-hidden': 'true'},
    make('line', {x1: -11, x2: 11, y1: 0, y2: 0, stroke: entrant.colour, 'stroke-width': 2}),
    make('path', {d: shape(entrant, 4), fill: entrant.colour}),
  );
}

const named = (entrant) => [key(entrant), make('span', {class: 'name', title: entrant.name}, entrant.name)];

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
  return Number(race.reference.attributes[`vkcppm.${metric.name}`]);
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
  return {
    x: room(Math.min(...xs), Math.max(...xs), 0.02),
    y: room(low, Math.min(Math.max(...ys), highest * 3), 0.04),
  };
}

/** What a plot needs of the style of the page once it is a file of its own. */
const ownStyle = [
  ...['fill', 'stroke', 'stroke-width', 'stroke-dasharray', 'stroke-linejoin', 'opacity'],
  ...['font-family', 'font-size', 'font-weight', 'text-anchor'],
];

/** The colours of the light page: those of paper. */
function lightColours() {
  const {style} = document.styleSheets[0].cssRules[0];
  return [...style].filter((name) => name.startsWith('--')).map((name) => `${name}:${style.getPropertyValue(name)};`);
}

/** The plot alone as the address of an SVG: its colours written out, its entrants named below it. */
function svgAddress(svg, metric, axis) {
  const copy = svg.cloneNode(true);
  const {width, height} = svg.viewBox.baseVal;
  const columns = Math.max(1, Math.floor(width / 170));
  shown().forEach((entrant, i) => {
    const {slope} = entrant.metrics[metric.name][`against_${axis}`];
    const place = `translate(${14 + (i % columns) * (width / columns)} ${height + 12 + 18 * Math.floor(i / columns)})`;
    copy.append(
      make(
        'g',
        {transform: place},
        make('line', {x1: -11, x2: 11, y1: 0, y2: 0, stroke: entrant.colour, 'stroke-width': 2}),
        make('path', {d: shape(entrant, 4), fill: entrant.colour}),
        make('text', {x: 17, y: 4}, slope ? `${entrant.name}, slope ${signed(slope.mean)}` : entrant.name),
      ),
    );
  });
  const whole = height + 18 * Math.ceil(shown().length / columns) + 8;
  for (const [name, value] of Object.entries({viewBox: `0 0 ${width} ${whole}`, width, height: whole})) {
    copy.setAttribute(name, value);
  }
  copy.querySelector('.cursor').remove();
  const holder = make('div', {class: 'plot', style: `${lightColours().join('')}position:absolute;visibility:hidden`});
  holder.append(copy);
  document.body.append(holder);
  for (const element of copy.querySelectorAll('line, path, text')) {
    const style = getComputedStyle(element);
    for (const name of ownStyle) element.setAttribute(name, style.getPropertyValue(name));
  }
  holder.remove();
  for (const element of copy.querySelectorAll('[class]')) element.removeAttribute('class');
  return `data:image/svg+xml,${encodeURIComponent(new XMLSerializer().serializeToString(copy))}`;
}

function plot(figure, metric, axis) {
  const title = axis === 'iterations' ? 'iterations' : 'seconds on the clock';
  const bounds = boundsOf(metric, axis);
  figure.replaceChildren();
  if (!bounds) {
    figure.append(make('p', {class: 'quiet'}, `There is no ${metric.title} greater than 0 to draw.`));
    return;
  }
  const width = Math.max(280, Math.round(figure.clientWidth - 26)),
    height = Math.round(Math.min(420, Math.max(270, 0.68 * width)));
  const box = {left: 58, right: width - 10, top: 26, bottom: height - 40};
  const map =
    ([low, high], from, to) =>
    (value) =>
      from + ((to - from) * Math.log(value / low)) / Math.log(high / low);
  const px = map(bounds.x, box.left, box.right),
    py = map(bounds.y, box.bottom, box.top);
  const f = (value) => value.toFixed(1);

  const clip = `clip-${axis}`;
  const svg = make(
    'svg',
    {
      viewBox: `0 0 ${width} ${height}`,
      height,
      role: 'img',
      'data-metric': metric.name,
      'aria-label': `${metric.title} against ${title}, both logarithmic; the table below has the numbers`,
    },
    make(
      'defs',
      {},
      make(
        'clipPath',
        {id: clip},
        make('rect', {x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top}),
      ),
    ),
    make('text', {class: 'title', x: 0, y: 13}, `${metric.title} against ${title}`),
  );
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
    svg.append(
      make('line', {class: 'level', x1: box.left, x2: box.right, y1: y, y2: y}),
      make('text', {x: box.left + 6, y: Number(y) + 15}, `${baseline.name} at its end`),
    );
  }

  const noise = noiseOf(metric);
  if (noise > bounds.y[0] && noise < bounds.y[1]) {
    const y = f(py(noise));
    svg.append(
      make('line', {class: 'level', 'data-noise': noise, x1: box.left, x2: box.right, y1: y, y2: y}),
      make('text', {x: box.right - 4, y: Number(y) - 6, 'text-anchor': 'end'}, 'noise of the reference'),
    );
  }

  const lines = make('g', {'clip-path': `url(#${clip})`});
  for (const entrant of shown()) {
    const points = pointsOf(entrant, metric, axis);
    if (points.length === 0) continue;
    const group = make('g', {class: 'series', 'data-name': entrant.name});
    const banded = points.filter((point) => point.low > 0);
    if (banded.length > 1) {
      const edge = (side) =>
        banded.map((point) => `${f(px(point.x))},${f(Math.max(-1e4, Math.min(1e4, py(point[side]))))}`);
      group.append(
        make('path', {
          class: 'band',
          fill: entrant.colour,
          opacity: Math.min(0.16, 0.6 / entrants.length),
          d: `M${[...edge('low'), ...edge('high').reverse()].join('L')}z`,
        }),
      );
    }
    group.append(
      make('path', {
        class: 'line',
        stroke: entrant.colour,
        d: `M${points.map((point) => `${f(px(point.x))},${f(py(point.mean))}`).join('L')}`,
      }),
    );
    let last = -Infinity;
    for (const point of points) {
      const x = px(point.x);
      if (x - last < 22 && point !== points[points.length - 1]) continue;
      last = x;
      group.append(
        make('path', {
          class: 'mark',
          fill: entrant.colour,
          d: shape(entrant, 3.6),
          transform: `translate(${f(x)} ${f(py(point.mean))})`,
        }),
      );
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
    const row = make(
      'li',
      {'data-name': entrant.name},
      ...named(entrant),
      make(
        'span',
        {class: 'slope', title: 'slope in the log-log plot'},
        slope ? `slope ${signed(slope.mean)}${spread}` : 'no slope',
      ),
    );
    const fade = (others) => () => {
      for (const group of lines.children)
        group.classList.toggle('faded', others && group.dataset.name !== entrant.name);
    };
    row.addEventListener('pointerenter', fade(true));
    row.addEventListener('pointerleave', fade(false));
    legend.append(row);
  }
  const save = make('a', {class: 'save', download: `${metric.name}-${axis}.svg`, href: svgAddress(svg, metric, axis)});
  save.textContent = 'Save as SVG';
  figure.append(svg, tip, legend, save);

  svg.addEventListener('pointermove', (event) => {
    const scale = width / svg.clientWidth;
    const x = (event.clientX - svg.getBoundingClientRect().left) * scale;
    const nearest = (points) => points.reduce((a, b) => (Math.abs(px(b.x) - x) < Math.abs(px(a.x) - x) ? b : a));
    const rows = shown()
      .map((entrant) => ({entrant, points: pointsOf(entrant, metric, axis)}))
      .filter(({points}) => points.length > 0)
      .map(({entrant, points}) => ({entrant, point: nearest(points)}))
      .sort((a, b) => b.point.mean - a.point.mean);
    if (rows.length === 0) return;
    const snapped = px(nearest(rows.map(({point}) => point)).x);
    cursor.setAttribute('x1', snapped);
    cursor.setAttribute('x2', snapped);
    cursor.setAttribute('visibility', 'visible');
    tip.hidden = false;
    tip.replaceChildren(
      make(
        'table',
        {},
        ...rows.map(({entrant, point}) =>
          make(
            'tr',
            {},
            make('td', {}, ...named(entrant)),
            make('td', {}, ...(rows.length > 5 ? [digits(point.mean)] : estimate(point))),
            make('td', {class: 'quiet'}, `${number(point.x)}${axis === 'seconds' ? ' s' : ''}`),
          ),
        ),
      ),
    );
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
