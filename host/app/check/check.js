// The page of a check, drawn from its two JSON elements: "check" is check.json with the titles of the measures,
// "pictures" are data URIs. What is chosen stands in the address: #view=1&crop=X,Y,SIZE

const check = JSON.parse(document.getElementById('check').textContent);
const pictures = JSON.parse(document.getElementById('pictures').textContent);
const extent = {width: check.width, height: check.height};
const cropSizes = cropSizesOf(extent);
const state = {view: 0, crop: null};

function readAddress() {
  const chosen = new URLSearchParams(location.hash.slice(1));
  const view = Number(chosen.get('view') ?? 0);
  state.view = pictures.maps[view] ? view : 0;
  state.crop = cropOf(chosen.get('crop'));
}

function choose(change) {
  Object.assign(state, change);
  draw();
  const {x, y, size} = state.crop;
  writeAddress(`#view=${state.view}&crop=${x},${y},${size}`);
}

function row(cell, texts) {
  return make('tr', {}, ...texts.map((text) => make(cell, {class: 'text'}, text)));
}

function drawHead() {
  at('heading').textContent = `Check: ${check.image.split('/').pop()}`;
  at('facts').textContent = [
    `against ${check.reference}`,
    `${check.width}×${check.height} pixels`,
    check.noise ? `level ${number(100 * check.noise.level)} %` : null,
    check.noise ? `p = ${number(check.noise.p_value)}` : null,
    `vkcppm ${check.version}`,
  ]
    .filter(Boolean)
    .join(' · ');
  at('verdict').append(make('strong', {}, check.passes ? 'Passes' : 'Differs'), `: ${check.why}.`);
  at('verdict').className = check.passes ? 'pass' : 'alert';
  at('conditions').append(
    make('thead', {}, row('th', ['verdict', 'asked', 'found'])),
    make(
      'tbody',
      {},
      ...check.conditions.map(({name, holds, told}) => row('td', [holds ? '✓ holds' : '✗ fails', name, told])),
    ),
  );
  at('measures').append(
    make('tbody', {}, ...check.titles.map(([name, title]) => row('td', [title, number(check.measures[name])]))),
  );
  const out = check.image_non_finite + check.reference_non_finite;
  at('pictures-note').textContent =
    `The pictures are shown with ${number(check.exposure)} stops, tone map ${check.tone_map}.` +
    (out ? ` ${plural(out, 'pixel')} NaN or infinite: gray in the maps.` : '');
}

/** The worst pixels and blocks; a click moves the crop there. */
function drawPlaces() {
  const found = (check.noise?.scales ?? []).flatMap(({side, places}) => places.map((place) => ({side, ...place})));
  if (!found.length) {
    at('places-section').hidden = true;
    return;
  }
  at('places').append(
    make('thead', {}, row('th', ['what', 'column', 'row', 'sigma', 'show'])),
    make(
      'tbody',
      {},
      ...found.map(({side, x, y, sigma}) => {
        const line = row('td', [
          side === 1 ? 'pixel' : `block of ${side}×${side}`,
          String(x),
          String(y),
          number(sigma),
        ]);
        const button = make('button', {type: 'button'}, 'Show');
        button.addEventListener('click', () => {
          const size = cropSizes.find((size) => size >= Math.max(side, 16)) ?? cropSizes[cropSizes.length - 1];
          const middle = Math.min(side, size) / 2;
          choose({crop: {size, x: Math.round(x + middle - size / 2), y: Math.round(y + middle - size / 2)}});
        });
        line.append(make('td', {}, button));
        return line;
      }),
    ),
  );
  at('places-note').textContent =
    'Sigma is the difference over the standard error of both pictures together. At most 20 of each kind are listed.';
}

function buildSlider() {
  at('under').src = pictures.reference;
  at('over').src = pictures.image;
  at('slider').style.aspectRatio = `${extent.width} / ${extent.height}`;
  const split = (part) => {
    at('over').style.clipPath = `inset(0 ${100 * (1 - part)}% 0 0)`;
    at('edge').style.left = `${100 * part}%`;
  };
  at('split').addEventListener('input', () => split(at('split').value / 1000));
  const follow = (event) => {
    const bounds = at('slider').getBoundingClientRect();
    const part = Math.max(0, Math.min(1, (event.clientX - bounds.left) / bounds.width));
    at('split').value = Math.round(1000 * part);
    split(part);
  };
  at('slider').addEventListener('pointerdown', (event) => {
    at('slider').setPointerCapture(event.pointerId);
    follow(event);
  });
  at('slider').addEventListener('pointermove', (event) => {
    if (event.buttons & 1) follow(event);
  });
  split(0.5);
}

const tiles = [];

function buildTiles() {
  const map = () => pictures.maps[state.view].picture;
  for (const [name, source] of [
    ['image', () => pictures.image],
    ['reference', () => pictures.reference],
    ['map', map],
  ]) {
    tiles.push({...tile(name, make('figcaption', {}, make('strong', {}, name))), source});
  }
  at('tiles').append(...tiles.map(({figure}) => figure));
  at('tiles').style.setProperty('--columns', tiles.length);
  pictures.maps.forEach(({title}, view) => {
    const button = make('button', {type: 'button'}, title);
    button.addEventListener('click', () => choose({view}));
    at('views').append(button);
  });
  buildCropSizes();
}

function draw() {
  holdCrop();
  for (const own of tiles) {
    const {image, magnified, source} = own;
    if (image.src !== source()) image.src = magnified.src = source();
    placeCrop(own);
  }
  [...at('views').children].forEach((button, view) => button.setAttribute('aria-pressed', view === state.view));
  const {scale, unit} = pictures.maps[state.view];
  drawScale(scale, unit);
}

readAddress();
drawHead();
drawPlaces();
buildSlider();
buildTiles();
draw();
followAddress(readAddress, draw);
