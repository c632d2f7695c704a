// Speed and the receiver's clock over time.
const lightSpeed = 299792458;

// A panel of lines over time. Series: {t, v, color, wide, dash, band, breaks}; band is a half-width about the
// line, breaks are times that the line does not cross.
function linePanel({label, series, least = 0, floor = null, top, tall, width, left, right, x}) {
  // The label stands above its panel.
  top += 16;
  tall -= 16;
  const group = svg('g'), all = series.flatMap(of => of.v).filter(Number.isFinite);
  let low = quantile(all, 0.005), high = quantile(all, 0.995);
  const spare = Math.max(least, (high - low) * 0.12, 1e-9);
  [low, high] = [floor === null ? low - spare : floor, high + spare];
  const y = v => top + (high - Math.max(low - (high - low) * 0.05, Math.min(high + (high - low) * 0.05, v))) / (high - low) * tall;
  const id = `clip-${label.replace(/[^a-z]/gi, '')}`;
  group.append(svg('clipPath', {id}, svg('rect', {x: left, y: top, width: Math.max(1, width - left - right), height: tall})));
  const steps = ticks(low, high, tall / 22), texts = labels(steps);
  for (const [i, v] of steps.entries()) {
    group.append(svg('path', {class: v === 0 ? 'zero' : 'grid', d: `M${left} ${y(v).toFixed(1)}H${width - right}`}), svg('text', {x: left - 6, y: y(v) + 4, 'text-anchor': 'end'}, texts[i]));
  }
  const plot = svg('g', {'clip-path': `url(#${id})`});
  for (const of of series) if (of.band) plot.append(svg('path', {d: bandPath(of, x, y), fill: of.color, 'fill-opacity': of.faint ? 0.1 : 0.18}));
  for (const of of series) plot.append(svg('path', {d: path(...broken(of, x, y)), fill: 'none', stroke: of.color, 'stroke-width': of.wide || 1.4, 'stroke-opacity': of.opacity, 'stroke-dasharray': of.dash, 'stroke-linejoin': 'round', 'stroke-linecap': 'round'}));
  group.append(plot, svg('text', {class: 'strong', x: left, y: top - 5}, label));
  return group;
}
function bandPath(of, x, y) {
  let d = '';
  for (let from = 0; from < of.t.length;) {
    const known = i => i < of.t.length && Number.isFinite(of.v[i]) && Number.isFinite(of.band[i]) && (i === from || of.t[i] - of.t[i - 1] < of.gap);
    let to = from;
    while (known(to)) ++to;
    if (to > from + 1) {
      const edge = (i, sign) => `${x(of.t[i]).toFixed(1)} ${y(of.v[i] + sign * of.band[i]).toFixed(1)}`;
      const there = [], back = [];
      for (let i = from; i < to; ++i) { there.push(edge(i, 1)); back.unshift(edge(i, -1)); }
      d += `M${there.concat(back).join('L')}Z`;
    }
    from = Math.max(to, from + 1);
  }
  return d;
}
// Points of a line, with a NaN where it breaks: at a jump, and where nothing was told for long.
function broken(of, x, y) {
  const xs = [], ys = [];
  let next = 0;
  const breaks = of.breaks || [];
  of.t.forEach((t, i) => {
    while (next < breaks.length && i > 0 && breaks[next] <= of.t[i - 1] + 1e-6) ++next;
    if (i > 0 && ((next < breaks.length && breaks[next] <= t + 1e-6) || t - of.t[i - 1] > of.gap)) { xs.push(NaN); ys.push(NaN); }
    xs.push(x(t));
    ys.push(Number.isFinite(of.v[i]) ? y(of.v[i]) : NaN);
  });
  return [xs, ys];
}
// Panels under each other on one axis of time.
function drawPanels(holder, name, panelsOf, decorate = () => []) {
  drawIn(holder, width => {
    const left = 56, right = 8, each = width < 560 ? 126 : 150, gap = 12, bottom = 24;
    const panels = panelsOf().filter(panel => panel.series.some(of => of.v.some(Number.isFinite)));
    const height = panels.length * (each + gap) + bottom, x = t => left + t / span * (width - left - right);
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img', 'aria-label': `${name}: ${panels.map(panel => panel.label).join('; ')}. Arrow keys move through the epochs.`});
    panels.forEach((panel, row) => root.append(linePanel({...panel, top: row * (each + gap) + 6, tall: each, width, left, right, x})));
    for (const t of timeTicks(span, Math.max(3, width / 110))) root.append(svg('text', {x: x(t), y: height - 6, 'text-anchor': 'middle'}, clock(t)));
    root.append(...decorate(x, height - bottom), cursorLine(root, left, right, width, height - bottom));
    holder.replaceChildren(root);
  });
}
const gapOf = run => 4 * run.steps + 1e-6;

function drawSpeed() {
  const runs = data.runs.filter(run => run.speed.some(Number.isFinite));
  if (!runs.length) return;
  const truth = data.truth, known = truth.speed.some(Number.isFinite), stated = runs.some(run => run.sacc.some(Number.isFinite));
  const hint = [stated ? 'The band is the stated speed accuracy (68 %).' : '',
    known && truth.byDifferences ? 'The truth states no velocity: its speed is how its positions change within a second.' : '',
    known ? 'Thick and pale: the truth.' : ''];
  const section = card('', 'Speed over time', hint.filter(text => text).join(' ') + sparse);
  const holder = element('div');
  section.append(element('div', {class: 'bar'}, runButtons(), known ? key('truth', 'var(--truth)', 'thin') : []), holder);
  if (known && runs.some(run => run.velocityErrors.horizontal.length)) section.append(element('p', {class: 'readout'}, 'Velocity error against the truth, in m/s: half below / 95 % below.'), velocityTable(runs));
  const trueSeries = values => {
    if (!values.some(Number.isFinite)) return [];
    if (truth.t.length === 1) return [{t: [0, span], v: [values[0], values[0]], color: 'var(--truth)', wide: 4, opacity: 0.38, gap: Infinity}];
    return [{t: truth.t, v: values, color: 'var(--truth)', wide: 4, opacity: 0.38, gap: 4 * medianStep(truth.t) + 1e-6}];
  };
  drawPanels(holder, 'Speed over time', () => {
    const shown = runs.filter(run => run.visible), faint = shown.length > 1;
    return [
      {label: 'Horizontal, m/s', least: 0.2, floor: 0, series: [...trueSeries(truth.speed), ...shown.map(run => ({t: run.t, v: run.speed, band: run.sacc, color: run.color, gap: gapOf(run), faint}))]},
      {label: 'Upwards, m/s', least: 0.2, series: [...trueSeries(truth.climb), ...shown.map(run => ({t: run.t, v: run.climb, color: run.color, gap: gapOf(run)}))]},
    ];
  });
}

function velocityTable(runs) {
  const pair = values => values.length ? values.map(value => value === null ? '–' : (value / 1000).toFixed(2)).join(' / ') : '–';
  const columns = ['Run', 'Horizontal', 'Upwards', 'Inside the stated 68 %'];
  return element('div', {class: 'scroll'}, element('table', {class: 'plain'}, element('caption', {class: 'hidden'}, 'Velocity errors against the truth'),
    element('thead', {}, element('tr', {}, columns.map(text => element('th', {scope: 'col'}, text)))),
    element('tbody', {}, runs.map(run => {
      const {horizontal, up, within} = run.velocityErrors;
      return element('tr', {}, element('th', {scope: 'row'}, run.name), [pair(horizontal), pair(up), within === null ? '–' : `${Math.round(within / 10)} %`].map(text => element('td', {}, text)));
    }))));
}

function drawClock() {
  const runs = data.runs.filter(run => run.bias.some(Number.isFinite));
  if (!runs.length) return;
  const widest = Math.max(...runs.flatMap(run => run.bias).filter(Number.isFinite).map(Math.abs)) / lightSpeed * 1e9;
  const [unit, scale] = widest > 1e6 ? ['ms', 1e-6] : widest > 2e3 ? ['µs', 1e-3] : ['ns', 1];
  const jumps = run => eventsOf(run).filter(event => event.event === 'millisecond_jump' || event.event === 'clock_discontinuity');
  const jumping = runs.some(run => jumps(run).length);
  const metresHint = unit === 'ns' ? '10 ns are 3 m of range.' : unit === 'µs' ? '1 µs is 300 m of range.' : '1 ms is 300 km of range.';
  const section = card('', 'Receiver clock', `How far the receiver’s clock is ahead of GPS time, and how fast that grows. It is solved for with the position, so it need not be right. ${metresHint}${jumping ? ' Dashed: the receiver set its clock.' : ''}`);
  const holder = element('div');
  section.append(element('div', {class: 'bar'}, runButtons(), jumping ? element('span', {class: 'key'}, svg('svg', {class: 'mark', viewBox: '0 0 14 14', 'aria-hidden': 'true'}, svg('path', {d: 'M7 0V14', stroke: 'var(--rejected)', 'stroke-width': 1.6, 'stroke-dasharray': '3 2'})), 'jump') : []), holder);
  drawPanels(holder, 'Receiver clock', () => {
    const shown = runs.filter(run => run.visible);
    const series = (values, run) => ({t: run.t, v: values, color: run.color, gap: gapOf(run), breaks: jumps(run).map(event => event.t)});
    return [
      {label: `Ahead of GPS time, ${unit}`, series: shown.map(run => series(run.bias.map(v => v / lightSpeed * 1e9 * scale), run))},
      {label: 'Gains, ns a second', series: shown.map(run => series(run.drift.map(v => v / lightSpeed * 1e9), run))},
    ];
  }, (x, bottom) => runs.filter(run => run.visible).flatMap(jumps).map(event => svg('g', {},
    svg('path', {d: `M${x(event.t).toFixed(1)} 0V${bottom}`, stroke: 'var(--rejected)', 'stroke-width': 1.2, 'stroke-opacity': 0.7, 'stroke-dasharray': '3 3'}),
    svg('path', {d: `M${x(event.t).toFixed(1)} 0V${bottom}`, stroke: 'transparent', 'stroke-width': 9}), svg('title', {}, eventText(event)))));
}
