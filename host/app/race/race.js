// The page of a race, drawn from its two JSON elements: "race" is race.json without the curves of single seeds,
// "pictures" are data URIs. What is chosen stands in the address:
// #metric=relmse&view=difference&crop=X,Y,SIZE&hide=sppm,appm

const race = JSON.parse(document.getElementById('race').textContent);
const pictures = JSON.parse(document.getElementById('pictures').textContent);
const entrants = race.entrants.map((entrant, index) => ({...entrant, index, pictures: pictures.entrants[index]}));
const baseline = entrants.find((entrant) => entrant.name === race.baseline);
const seeds = race.seeds.length;
const views = [
  ['picture', 'Picture'],
  ['difference', 'Difference'],
  ['radius', 'Radius'],
  ['direct', 'Direct light'],
  ['caustic', 'Caustics'],
  ['rest', 'Rest'],
].filter(([name]) => name in pictures.entrants[0]);
const extent = {width: race.width, height: race.height};
const cropSizes = cropSizesOf(extent);
const percent = Math.round(100 * race.confidence);

/** "1.23" with its interval behind it, if there is one. */
function estimate(value, text = digits, unit = '') {
  if (!value) return ['–'];
  if (value.low === null || value.low === value.high) return [text(value.mean) + unit];
  return [
    text(value.mean) + unit,
    ' ',
    make('small', {title: `${percent} % confidence interval`}, `${text(value.low)}–${text(value.high)}`),
  ];
}

// ---- What is chosen

const state = {metric: race.metric, view: 'picture', crop: null, hidden: new Set()};

function readAddress() {
  const chosen = new URLSearchParams(location.hash.slice(1));
  if (race.metrics.some((metric) => metric.name === chosen.get('metric'))) state.metric = chosen.get('metric');
  if (views.some(([name]) => name === chosen.get('view'))) state.view = chosen.get('view');
  state.crop = cropOf(chosen.get('crop'));
  const hidden = (chosen.get('hide') ?? '').split(',');
  state.hidden = new Set(entrants.map((entrant) => entrant.name).filter((name) => hidden.includes(name)));
}

function writeChoice() {
  const {x, y, size} = state.crop;
  const hide = state.hidden.size ? `&hide=${[...state.hidden].map(encodeURIComponent).join(',')}` : '';
  writeAddress(`#metric=${state.metric}&view=${state.view}&crop=${x},${y},${size}${hide}`);
}

function choose(change) {
  Object.assign(state, change);
  const pictures = 'crop' in change || 'view' in change;
  if (pictures) drawTiles(chosenMetric());
  else draw();
  writeChoice();
}

const metricNamed = (name) => race.metrics.find((metric) => metric.name === name);
const chosenMetric = () => metricNamed(state.metric);
const shown = () => entrants.filter((entrant) => !state.hidden.has(entrant.name));

// ---- Head

// The error at which an entrant ends, in words.
function aim() {
  return `${metricNamed(race.stop_at.metric).title} ${number(race.stop_at.value)}`;
}

// Who comes first to the error at which entrants end: by the mean over seeds, of those who come to it with every seed.
function drawFirst(verdict) {
  const came = entrants.filter((entrant) => entrant.seconds_to_stop !== null);
  const first = came.reduce((a, b) => (a && a.seconds_to_stop <= b.seconds_to_stop ? a : b), null);
  if (!first) {
    verdict.append(`Nobody comes to ${aim()}${seeds === 1 ? '' : ' with every seed'}.`);
    return;
  }
  verdict.append(make('strong', {}, first.name), ` comes first to ${aim()}: after `);
  verdict.append(make('strong', {}, `${number(first.seconds_to_stop)} s`), '.');
}

function drawHead() {
  const file = race.scene.file.split('/').pop();
  at('heading').textContent = `Race: ${file}`;
  const limits = [
    race.seconds === null ? null : `${number(race.seconds)} s`,
    race.iterations === null ? null : plural(race.iterations, 'iteration'),
    race.stop_at ? aim() : null,
  ].filter(Boolean);
  const paths = new Set(entrants.map((entrant) => entrant.settings.photons));
  at('facts').textContent = [
    `${race.width}×${race.height} pixels`,
    paths.size === 1 ? `${plural([...paths][0], 'light path')} an iteration` : null,
    `${limits.join(' or ')} each with ${seeds === 1 ? `seed ${race.seeds[0]}` : `each of ${seeds} seeds`}`,
    race.device,
    race.interrupted ? 'interrupted' : null,
  ]
    .filter(Boolean)
    .join(' · ');
  const select = at('metric');
  for (const metric of race.metrics) select.append(make('option', {value: metric.name}, metric.title));
  select.addEventListener('change', () => choose({metric: select.value}));
  for (const entrant of entrants) {
    const chip = make(
      'button',
      {type: 'button', class: 'chip', 'data-name': entrant.name, title: `Show or hide the curve of ${entrant.name}`},
      ...named(entrant),
    );
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
  if (race.stop_at) {
    drawFirst(verdict);
    return;
  }
  const best = measured.reduce((a, b) =>
    b.metrics[metric.name].final.mean < a.metrics[metric.name].final.mean ? b : a,
  );
  const own = best.metrics[metric.name];
  const limit =
    race.interrupted || (race.seconds === null) === (race.iterations === null)
      ? 'At the end'
      : `After ${race.seconds === null ? plural(race.iterations, 'iteration') : `${number(race.seconds)} s`} each`;
  verdict.append(
    `${limit}, `,
    make('strong', {}, best.name),
    ` is nearest to the reference: ${metric.title} `,
    make('strong', {}, number(own.final.mean)),
    '.',
  );
  // Entrants whose interval reaches that of the best.
  const near = measured.filter(
    (entrant) => entrant !== best && own.final.low !== null && entrant.metrics[metric.name].final.low <= own.final.high,
  );
  if (seeds === 1) {
    verdict.append(' One seed cannot tell that from chance: --seeds 5 gives intervals.');
  } else if (near.length > 0) {
    const names = near.map((entrant) => entrant.name);
    verdict.append(
      ` Within the ${percent} % intervals ${plural(seeds, 'seed')} cannot tell it from ${names.join(', ')}.`,
    );
  }
  if (best === baseline || !own.equal_seconds.speedup) return;
  /** "1.5 times (95 %: 1.2 to 1.9) sooner", or later where the factor is below 1. */
  const times = ({mean, low, high}, more, less) => {
    const [factor, from, to] = mean >= 1 ? [mean, low, high] : [1 / mean, 1 / high, 1 / low];
    return [
      make('strong', {}, `${number(factor)} times`),
      low === null ? '' : ` (${percent} %: ${number(from)} to ${number(to)})`,
      mean >= 1 ? more : less,
    ];
  };
  verdict.append(
    ` It reaches the error that ${baseline.name} has at its end `,
    ...times(own.equal_seconds.speedup, ' sooner', ' later'),
  );
  if (own.equal_iterations.speedup) {
    verdict.append(', with ', ...times(own.equal_iterations.speedup, ' fewer iterations', ' as many iterations'));
  }
  verdict.append('.');
  const {low, high} = own.equal_seconds.speedup;
  if (low !== null && low <= 1 && high >= 1)
    verdict.append(` ${plural(seeds, 'seed')} cannot tell that time from the same time.`);
}

// ---- Foot

function drawSettings() {
  at('command').textContent = race.command;
  at('copy').addEventListener('click', () => {
    const chosen = document.createRange();
    chosen.selectNodeContents(at('command'));
    getSelection().removeAllRanges();
    getSelection().addRange(chosen);
    navigator.clipboard?.writeText(race.command).then(
      () => {
        at('copy').textContent = 'Copied';
      },
      () => {},
    );
  });
  const settings = entrants[0].settings;
  const own = ['estimator', ...race.parameters];
  const common = Object.entries(settings).filter(([name]) => ![...own, 'iterations', 'time', 'seed'].includes(name));
  const lines = [
    ['scene', race.scene.file],
    ['hash of the scene', race.scene.hash],
    ['environment', race.scene.environment ?? 'none'],
    ['glass without a volume', race.scene.thin_glass],
    ['reference', race.reference.file],
    ...Object.entries(race.reference.attributes)
      .filter(([name]) =>
        ['iterations_done', 'samples_done', 'estimator', 'photons', 'relmse'].includes(name.replace('vkcppm.', '')),
      )
      .map(([name, value]) => [`${name.replace('vkcppm.', '').replace('_', ' ')} of the reference`, value]),
    ['each gets', at('facts').textContent.split(' · ')[2].replace(' each with', ' with')],
    ['seeds', race.seeds.join(', ')],
    ...common.map(([name, value]) => [name.replace('_', ' '), String(value)]),
    ['exposure of the pictures', `${race.exposure} stops`],
    ['device', race.device],
    ['driver', race.driver],
    ['version', `vkcppm ${race.version}`],
  ];
  at('settings').append(
    make(
      'tbody',
      {},
      ...lines.map(([name, value]) => make('tr', {}, make('th', {scope: 'row'}, name), make('td', {}, value))),
    ),
  );
  at('parameters').append(
    make('thead', {}, row('th', own)),
    make(
      'tbody',
      {},
      ...entrants.map((entrant) =>
        make(
          'tr',
          {},
          make('th', {scope: 'row'}, key(entrant), ` ${entrant.settings.estimator}`),
          ...own
            .slice(1)
            .map((name) =>
              make(
                'td',
                {class: entrant.settings[name] === settings[name] ? '' : 'best'},
                number(entrant.settings[name]),
              ),
            ),
        ),
      ),
    ),
  );
}

function drawNotes() {
  const spread =
    seeds === 1
      ? 'There is one seed, so nothing tells how much of a difference is chance: --seeds 3 adds confidence bands.'
      : `Curves are geometric means over ${seeds} seeds; bands and ranges are ${percent} % confidence intervals by ` +
        'Student’s t on the logarithms.';
  at('curves-note').textContent =
    `Both axes are logarithmic. ${spread} A slope is the least squares fit over the last factor of ten; ` +
    'of a squared error −1 is that of noise alone, −2/3 the best asymptotic rate of progressive photon mapping ' +
    '(Kaplanyan and Dachsbacher 2013).';
  at('equal-note').textContent =
    `Where each curve, interpolated log-log, first comes down to the error that ${baseline.name} ` +
    `has at its end, seed by seed; “sooner” and “fewer” are ${baseline.name}’s own over that.`;
  at('pictures-note').textContent =
    `Pictures and maps are those of seed ${race.seeds[0]} at its end. The difference is the ` +
    'absolute one, mean over the channels; the radius is that of the disc over which photons are gathered.';
  at('winner-note').textContent =
    `Errors are squared, means over channels${seeds === 1 ? '' : ` and ${seeds} seeds`}, each estimator at its end. ` +
    'A single pixel is a throw of dice between good estimators; over its neighbours it shows where one is better.';
  at('settings-note').textContent =
    'With the same device, driver and reference the error against iterations is the same to the last bit' +
    (race.reference_made ? `; the reference of this race is ${race.reference.file}. ` : '. ') +
    'race.json holds all of this and every snapshot, curves.csv the snapshots alone; pictures are beside them as EXR ' +
    'and PNG.';
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
followAddress(readAddress, draw);
let lastWidth = innerWidth;
addEventListener('resize', () => {
  if (innerWidth === lastWidth) return;
  lastWidth = innerWidth;
  draw();
});
