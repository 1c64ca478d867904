// The pictures of the page of a race, with the crop that is picked in one and shown of all.

/** A figure with a picture that takes clicks, and its crop. */
function tile(name, caption) {
  const image = make('img', {
    alt: `${name}: the whole picture`,
    width: race.width,
    height: race.height,
    draggable: 'false',
  });
  const frame = make('div', {class: 'frame'});
  const whole = make(
    'div',
    {class: 'whole', tabindex: 0, role: 'application', 'aria-label': `${name}: move the crop with the arrow keys`},
    image,
    frame,
  );
  const magnified = make('img', {alt: `${name}: the crop, magnified`});
  const crop = make('div', {class: 'crop'}, magnified);
  const pick = (event) => {
    const bounds = image.getBoundingClientRect();
    const {size} = state.crop;
    choose({
      crop: {
        size,
        x: Math.round(((event.clientX - bounds.left) / bounds.width) * race.width - size / 2),
        y: Math.round(((event.clientY - bounds.top) / bounds.height) * race.height - size / 2),
      },
    });
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
  const captions = [
    ['winner', 'a pixel', 'pixels_won'],
    [
      'winner_around',
      `over ${2 * race.winner_reach + 1}×${2 * race.winner_reach + 1} pixels about one`,
      'pixels_won_around',
    ],
  ];
  for (const [name, title, share] of captions) {
    const own = tile(`nearest ${title}`, make('figcaption', {}, make('strong', {}, `Least squared error ${title}`)));
    const rest = 1 - entrants.reduce((sum, entrant) => sum + entrant[share], 0);
    const line = (label, part, colour) =>
      make(
        'li',
        {},
        ...label,
        make('span', {class: 'slope'}, `${(100 * part).toFixed(1)} %`),
        make('span', {class: 'meter'}, make('i', {style: `width:${(100 * part).toFixed(2)}%;background:${colour}`})),
      );
    const legend = make(
      'ul',
      {class: 'legend'},
      ...entrants.map((entrant) => line(named(entrant), entrant[share], entrant.colour)),
      rest > 5e-4 ? line([make('span', {class: 'name'}, 'draw (gray)')], rest, '#c8c8c8') : null,
    );
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
    const size = Number(select.value),
      {x, y, size: old} = state.crop;
    choose({crop: {size, x: Math.round(x + (old - size) / 2), y: Math.round(y + (old - size) / 2)}});
  });
}

/** So many pictures side by side that none is too small and the last row is not left with few. */
function columns() {
  const count = entrants.length + 1,
    most = Math.max(2, Math.floor(at('tiles').clientWidth / 190));
  return Math.ceil(count / Math.ceil(count / most));
}

function drawTiles(metric) {
  const crop = state.crop;
  crop.x = Math.round(Math.max(0, Math.min(race.width - crop.size, crop.x)));
  crop.y = Math.round(Math.max(0, Math.min(race.height - crop.size, crop.y)));
  const part = (value, of) => `${(100 * value) / of}%`;
  for (const {image, frame, magnified, crop: box, source, entrant, told} of tiles) {
    if (image.src !== source()) image.src = magnified.src = source();
    Object.assign(frame.style, {
      left: part(crop.x, race.width),
      top: part(crop.y, race.height),
      width: part(crop.size, race.width),
      height: part(crop.size, race.height),
    });
    box.style.aspectRatio = '1';
    Object.assign(magnified.style, {
      width: part(race.width, crop.size),
      height: part(race.height, crop.size),
      left: part(-crop.x, crop.size),
      top: part(-crop.y, crop.size),
    });
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
  at('scale').replaceChildren(
    ...(scale
      ? [
          `${number(scale.low)} ${unit}`,
          make('img', {src: pictures.ramp, alt: 'colours from blue over yellow to red'}),
          `${number(scale.high)} ${unit}${scale.logarithmic ? ', logarithmic' : ' and more'}`,
        ]
      : []),
  );
}
