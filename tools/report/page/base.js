// Decoding the data, building elements, scales and the cursor that all drawings share.
const data = JSON.parse(document.getElementById('data').textContent);
const column = (values, scale) => values.map(v => (v === null ? NaN : v * scale));

for (const name of ['e', 'n', 'speed', 'climb']) data.truth[name] = column(data.truth[name], 1e-2);
data.truth.t = column(data.truth.t, 1e-3);
data.runs.forEach((run, index) => {
  run.index = index;
  run.color = `var(--run${index % 5})`;
  run.visible = true;
  run.t = column(run.t, 1e-3);
  for (const name of ['e', 'n', 'u', 'acc', 'vacc', 'ee', 'en', 'eu', 'we', 'wn', 'pl', 'vpl', 'nees', 'cdf', 'speed', 'climb', 'sacc', 'drift']) run[name] = column(run[name], 1e-2);
  run.chance = column(run.chance, 1e-3);
  run.used = column(run.used, 1);
  run.bias = column(run.bias, 0.1);
  run.span *= 1e-3;
  for (const of of run.sights) for (const name of ['rx', 'ry']) of[name] = column(of[name], 1e-2);
  run.hasErrors = run.ee.some(Number.isFinite);
  run.steps = medianStep(run.t);
});
for (const place of [data.scene.landmarks, ...data.scene.buildings]) for (const name of ['e', 'n']) place[name] = column(place[name], 1e-2);
for (const photo of data.scene.photos) photo.t = photo.t === null ? NaN : photo.t * 1e-3;
// Of long runs not every epoch is drawn.
const sparse = data.runs.some(run => run.count > run.t.length) ? ' Of every stretch of epochs the worst is drawn.' : '';
const hasErrors = data.runs.some(run => run.hasErrors);
const span = Math.max(1e-3, ...data.runs.map(run => run.span));

// Signals are sorted by system and number already.
const systemColors = {G: 'var(--run0)', R: 'var(--run1)', E: 'var(--run2)', C: 'var(--run3)', J: 'var(--run4)', I: 'var(--soft)', S: 'var(--soft)'};
const systemNames = {G: 'GPS', R: 'GLONASS', E: 'Galileo', C: 'BeiDou', J: 'QZSS', I: 'NavIC', S: 'SBAS'};
// States of signals and of landmarks.
const stateNames = {u: 'used', d: 'down-weighted', r: 'rejected', x: 'not usable', '-': 'not received'};
const stateColors = {u: 'var(--used)', d: 'var(--down)', r: 'var(--rejected)', x: 'var(--unusable)'};

function medianStep(times) {
  const steps = [];
  for (let i = 1; i < times.length; ++i) steps.push(times[i] - times[i - 1]);
  steps.sort((a, b) => a - b);
  return steps.length ? steps[steps.length >> 1] : 1;
}

// All text set here is text, never markup.
function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  return fill(node, attributes, children);
}
function svg(name, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  return fill(node, attributes, children);
}
function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== null) node.setAttribute(name, value);
  }
  for (const child of children.flat()) node.append(child);
  return node;
}

const metres = value => Math.abs(value) >= 1000 ? `${(value / 1000).toFixed(2)} km` : Math.abs(value) >= 100 ? `${value.toFixed(0)} m` : `${value.toFixed(2)} m`;
function clock(seconds) {
  const whole = Math.floor(seconds + 1e-6), two = n => String(n).padStart(2, '0');
  const h = Math.floor(whole / 3600), m = Math.floor(whole / 60) % 60, s = whole % 60;
  return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

// Round numbers that cover [low, high] in about `count` steps.
function ticks(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  if (!(raw > 0) || !Number.isFinite(raw)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find(factor => factor * power >= raw * 0.999) * power;
  const values = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + step * 1e-6; v += step) values.push(Math.abs(v) < step * 1e-6 ? 0 : v);
  return values;
}
function timeTicks(high, count) {
  const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 14400, 21600, 43200, 86400];
  const step = steps.find(s => high / s <= count) || high / count;
  const values = [];
  for (let v = 0; v <= high + 1e-6; v += step) values.push(v);
  return values;
}
// Texts for ticks: all with the decimals that their step needs.
function labels(values) {
  const step = values.length > 1 ? values[1] - values[0] : 1;
  const decimals = step < 1 ? Math.ceil(-Math.log10(step) - 1e-9) : 0;
  return values.map(value => value.toFixed(decimals).replace('-', '−'));
}
function quantile(values, share) {
  const sorted = values.filter(Number.isFinite).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : NaN;
}
// Path through points; a NaN lifts the pen, and a point alone becomes a dot where line ends are round.
function path(xs, ys) {
  let d = '', down = 0;
  for (let i = 0; i < xs.length; ++i) {
    if (!Number.isFinite(xs[i]) || !Number.isFinite(ys[i])) { if (down === 1) d += 'h0'; down = 0; continue; }
    d += `${down ? 'L' : 'M'}${xs[i].toFixed(1)} ${ys[i].toFixed(1)}`;
    ++down;
  }
  return down === 1 ? d + 'h0' : d;
}

// States have shapes as well as colours: a dot was used, a triangle counted less, a cross was rejected, a
// ring could not be used.
const markPaths = {
  u: (x, y, r) => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`,
  d: (x, y, r) => `M${x} ${y - 1.3 * r}l${1.25 * r} ${2.2 * r}h${-2.5 * r}Z`,
  r: (x, y, r) => `M${x - r} ${y - r}l${2 * r} ${2 * r}m0 ${-2 * r}l${-2 * r} ${2 * r}`,
  x: (x, y, r) => `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`,
};
const tenths = value => Math.round(value * 10) / 10;
// One path for all points [x, y] of a state.
function marks(state, points, r, color = stateColors[state], attributes = {}) {
  const d = points.map(([x, y]) => markPaths[state](tenths(x), tenths(y), r)).join('');
  const filled = state === 'u' || state === 'd';
  return svg('path', {d, fill: filled ? color : 'none', stroke: filled ? 'none' : color, 'stroke-width': Math.max(1, r * 0.55), ...attributes});
}
// Runs have shapes too, where points of several lie among each other.
const runShapes = [
  (x, y, r) => markPaths.u(x, y, r),
  (x, y, r) => `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}Z`,
  (x, y, r) => markPaths.d(x, y, r),
  (x, y, r) => `M${x} ${y - 1.4 * r}l${1.4 * r} ${1.4 * r}l${-1.4 * r} ${1.4 * r}l${-1.4 * r} ${-1.4 * r}Z`,
  (x, y, r) => `M${x} ${y + 1.3 * r}l${1.25 * r} ${-2.2 * r}h${-2.5 * r}Z`,
];
function runPoints(run, points, r) {
  const shape = runShapes[run.index % 5];
  return svg('path', {d: points.map(([x, y]) => shape(tenths(x), tenths(y), r)).join(''), fill: run.color, 'fill-opacity': 0.7, stroke: points.length > 300 ? 'none' : 'var(--card)', 'stroke-width': 0.6});
}
function runShapeKey(run) {
  return element('span', {class: 'key'}, svg('svg', {class: 'mark', viewBox: '0 0 14 14', 'aria-hidden': 'true'}, runPoints(run, [[7, 7]], 4.5)), run.name);
}
function markKey(label, state, color = stateColors[state]) {
  return element('span', {class: 'key'}, svg('svg', {class: 'mark', viewBox: '0 0 14 14', 'aria-hidden': 'true'}, marks(state, [[7, 7]], 4, color)), label);
}

// The instant the reader looks at, shared by all drawings.
const cursor = {
  time: null,
  listeners: [],
  set(time) {
    this.time = time === null ? null : Math.min(span, Math.max(0, time));
    for (const listener of this.listeners) listener(this.time);
  },
};
function nearestEpoch(run, time) {
  let low = 0, high = run.t.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (run.t[middle] < time) low = middle + 1; else high = middle;
  }
  if (low > 0 && Math.abs(run.t[low - 1] - time) < Math.abs(run.t[low] - time)) --low;
  return low;
}
function moveCursorByKey(event) {
  const run = data.runs.find(r => r.visible) || data.runs[0];
  if (!run || !run.t.length) return;
  const step = {ArrowLeft: -1, ArrowRight: 1, PageUp: -20, PageDown: 20}[event.key];
  if (event.key === 'Escape') { cursor.set(null); return; }
  if (event.key === 'Home' || event.key === 'End') cursor.set(event.key === 'Home' ? 0 : span);
  else if (step) {
    const at = cursor.time === null ? (step > 0 ? -1 : run.t.length) : nearestEpoch(run, cursor.time);
    cursor.set(run.t[Math.min(run.t.length - 1, Math.max(0, at + step))]);
  } else return;
  event.preventDefault();
}

// A card with a heading; draw(width) is called again whenever its width or the shown runs change.
const redraws = [];
function card(className, title, hint, parent = 'charts') {
  const section = element('section', {class: `card ${className}`}, element('h2', {}, title));
  if (hint) section.append(element('p', {class: 'hint'}, hint));
  document.getElementById(parent).append(section);
  return section;
}
function drawIn(holder, draw) {
  let width = 0;
  const redraw = () => { if (width > 0) draw(width); };
  redraws.push(redraw);
  new ResizeObserver(entries => {
    const now = Math.floor(entries[0].contentRect.width);
    if (now !== width) { width = now; requestAnimationFrame(redraw); }
  }).observe(holder);
}
const redrawAll = () => redraws.forEach(redraw => redraw());

function key(label, color, kind = '') {
  return element('span', {class: 'key'}, element('i', {class: kind, style: kind === 'ring' ? `border-color:${color}` : `background:${color}`}), label);
}
// Buttons that show and hide runs, where there is more than one.
function runButtons(keyOf = run => key(run.name, run.color)) {
  return data.runs.map(run => {
    const mark = keyOf(run);
    if (data.runs.length === 1) return mark;
    const button = element('button', {type: 'button', 'aria-pressed': String(run.visible), 'data-run': run.index, onclick: () => {
      run.visible = !run.visible;
      document.querySelectorAll(`[data-run="${run.index}"]`).forEach(b => b.setAttribute('aria-pressed', String(run.visible)));
      redrawAll();
    }}, mark);
    return button;
  });
}

// The run whose photographs, satellites and events are shown: the last that saw landmarks.
let chosenRun = [...data.runs].reverse().find(run => run.sights.length) || data.runs[0];
const chosen = () => chosenRun;
// A list to choose it from, where there is more than one.
function chosenSelect(label, runs = data.runs) {
  if (runs.length < 2) return [];
  const select = element('select', {class: 'chosen', onchange: event => {
    chosenRun = data.runs[event.target.value];
    document.querySelectorAll('select.chosen').forEach(other => { if ([...other.options].some(o => o.value === event.target.value)) other.value = event.target.value; });
    redrawAll();
  }}, runs.map(run => element('option', {value: run.index}, run.name)));
  if (runs.includes(chosenRun)) select.value = chosenRun.index;
  return [element('label', {}, `${label} `, select)];
}
