// Pictures with a crop that is picked in one and shown of all. The page has the constants `extent` {width, height},
// `cropSizes` and `pictures` with a `ramp`, `state` with a `crop` {x, y, size}, choose(change), which changes the state
// and draws what it changes, and the elements crop-size, crop-place and scale.

/** Sides of crops that fit into a picture. */
function cropSizesOf({width, height}) {
  const sizes = [8, 16, 32, 64, 128].filter((size) => size <= Math.min(width, height));
  return sizes.length ? sizes : [Math.min(width, height)];
}

/** The crop of an address, "X,Y,SIZE"; without one in the middle. */
function cropOf(text) {
  const crop = (text ?? '').split(',').map(Number);
  const size = cropSizes.includes(crop[2]) ? crop[2] : cropSizes[Math.min(2, cropSizes.length - 1)];
  const place =
    crop.length >= 2 && crop.every(Number.isFinite) ? crop : [(extent.width - size) / 2, (extent.height - size) / 2];
  return {x: place[0], y: place[1], size};
}

/** A figure with a picture that takes clicks, and its crop. */
function tile(name, caption) {
  const image = make('img', {
    alt: `${name}: the whole picture`,
    width: extent.width,
    height: extent.height,
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
        x: Math.round(((event.clientX - bounds.left) / bounds.width) * extent.width - size / 2),
        y: Math.round(((event.clientY - bounds.top) / bounds.height) * extent.height - size / 2),
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

/** The list of sizes; another one keeps the middle. */
function buildCropSizes() {
  const select = at('crop-size');
  for (const size of cropSizes) select.append(make('option', {value: size}, `${size}×${size}`));
  select.addEventListener('change', () => {
    const size = Number(select.value),
      {x, y, size: old} = state.crop;
    choose({crop: {size, x: Math.round(x + (old - size) / 2), y: Math.round(y + (old - size) / 2)}});
  });
}

/** Keeps the crop within the picture, and tells where it is. */
function holdCrop() {
  const crop = state.crop;
  crop.x = Math.round(Math.max(0, Math.min(extent.width - crop.size, crop.x)));
  crop.y = Math.round(Math.max(0, Math.min(extent.height - crop.size, crop.y)));
  at('crop-size').value = crop.size;
  at('crop-place').textContent = `from column ${crop.x}, row ${crop.y}`;
}

/** Frame and magnified crop of a tile. */
function placeCrop({frame, magnified, crop: box}) {
  const {x, y, size} = state.crop;
  const part = (value, of) => `${(100 * value) / of}%`;
  Object.assign(frame.style, {
    left: part(x, extent.width),
    top: part(y, extent.height),
    width: part(size, extent.width),
    height: part(size, extent.height),
  });
  box.style.aspectRatio = '1';
  Object.assign(magnified.style, {
    width: part(extent.width, size),
    height: part(extent.height, size),
    left: part(-x, size),
    top: part(-y, size),
  });
}

/** What the colours of a map mean; nothing without a scale. */
function drawScale(scale, unit) {
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
