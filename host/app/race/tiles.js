// The pictures of the page of a race.

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
  buildCropSizes();
}

/** So many pictures side by side that none is too small and the last row is not left with few. */
function columns() {
  const count = entrants.length + 1,
    most = Math.max(2, Math.floor(at('tiles').clientWidth / 190));
  return Math.ceil(count / Math.ceil(count / most));
}

function drawTiles(metric) {
  holdCrop();
  for (const tile of tiles) {
    const {image, magnified, source, entrant, told} = tile;
    if (image.src !== source()) image.src = magnified.src = source();
    placeCrop(tile);
    if (entrant) {
      told.textContent = digits(entrant.metrics[metric.name].final?.mean ?? null);
      told.title = `${metric.title} at its end`;
    }
  }
  at('tiles').style.setProperty('--columns', columns());
  for (const button of at('views').children) button.setAttribute('aria-pressed', button.dataset.view === state.view);
  const scale = {difference: race.difference_scale, radius: race.radius_scale}[state.view];
  const unit = state.view === 'radius' ? 'm' : 'W m⁻² sr⁻¹';
  drawScale(scale, unit);
}
