// The tables of the page of a race.

const row = (kind, cells) =>
  make('tr', {}, ...cells.map((cell) => (cell instanceof Node ? cell : make(kind, {}, cell))));
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
  const unreached = (equal) =>
    equal.reached === 0 ? 'not reached' : `reached by ${equal.reached} of ${seeds} seeds`;
  const equal = (entrant, axis) => {
    const {reached, at: place, speedup} = values(entrant)[`equal_${axis}`];
    if (!place) return [make('td', {colspan: 2, class: 'quiet'}, unreached({reached}))];
    const best = place.mean === least((other) => values(other)[`equal_${axis}`].at?.mean);
    return [
      cells(estimate(place, entrant === baseline && axis === 'iterations' ? number : digits), best),
      entrant === baseline ? make('td', {}, '1×') : cells(estimate(speedup, digits, '×'), best),
    ];
  };
  table.replaceChildren(
    make(
      'thead',
      {},
      make(
        'tr',
        {},
        make('th', {rowspan: 2}, 'estimator'),
        make('th', {class: 'group', colspan: 3}, 'at its end'),
        make('th', {class: 'group', colspan: 4}, `to the error of ${baseline.name} at its end`),
      ),
      row('th', [metric.title, 'iterations', 'seconds', 'iterations', 'fewer', 'seconds', 'sooner']),
    ),
    make(
      'tbody',
      {},
      ...ranked(metric).map((entrant) => {
        const iterations = totals(entrant, 'iterations'),
          seconds = totals(entrant, 'seconds');
        const {final} = values(entrant);
        return make(
          'tr',
          {'data-name': entrant.name},
          make(
            'th',
            {scope: 'row'},
            ...named(entrant),
            entrant === baseline ? make('span', {class: 'badge'}, 'baseline') : null,
          ),
          cells(estimate(final), final?.mean === bestEnd),
          cells([number(iterations / seeds)]),
          cells([digits(seconds / seeds)]),
          ...equal(entrant, 'iterations'),
          ...equal(entrant, 'seconds'),
        );
      }),
    ),
  );
}

/** Kernels by the pass that they belong to. */
const passes = [
  ['eye', /^eye$/],
  ['photon', /^photon$/],
  ['grid', /^(grid|scan|radix)/],
  ['knn', /^knn$/],
  ['gather', /^gather$/],
  ['update', /^(update|advance)$/],
];

function drawCost() {
  const milliseconds = (entrant, kernels) =>
    (1000 / totals(entrant, 'iterations')) *
    entrant.runs.reduce(
      (sum, run) =>
        sum +
        Object.entries(run.pass_seconds)
          .filter(([name]) => kernels.test(name))
          .reduce((all, [, value]) => all + value, 0),
      0,
    );
  at('cost').replaceChildren(
    make(
      'thead',
      {},
      row('th', ['estimator', ...passes.map(([name]) => name), 'all', 'photons stored an iteration']),
    ),
    make(
      'tbody',
      {},
      ...entrants.map((entrant) => {
        const each = passes.map(([, kernels]) => milliseconds(entrant, kernels));
        return make(
          'tr',
          {},
          make('th', {scope: 'row'}, ...named(entrant)),
          ...each.map((value) => make('td', {}, digits(value))),
          make('td', {}, digits(each.reduce((a, b) => a + b, 0))),
          make('td', {}, number(totals(entrant, 'stored_photons') / totals(entrant, 'iterations'))),
        );
      }),
    ),
  );
}
