// The sky above the receiver: each satellite's way, told by what became of its signals.
const skyStrokes = {x: {'stroke-width': 1.5}, u: {'stroke-width': 3.5}, d: {'stroke-width': 3.5, 'stroke-dasharray': '6 5'}, r: {'stroke-width': 3.5, 'stroke-dasharray': '1 6'}};

function drawSky(chosen) {
  const section = card('half', 'Sky', 'North is up, the rim is the horizon. A satellite counts as its best signal; marks show the time of the cursor, or the end.');
  const holder = element('div');
  section.append(element('div', {class: 'bar'}, [...'udrx'].map(state => markKey(stateNames[state], state))), holder);
  let drawMarks = () => {};
  cursor.listeners.push(time => drawMarks(time));
  drawIn(holder, width => {
    const run = chosen(), satellites = satellitesOf(run);
    const size = Math.min(width, 460), r = size / 2 - 24, cx = width / 2, cy = size / 2;
    const root = svg('svg', {viewBox: `0 0 ${width} ${size}`, height: size, role: 'img', 'aria-label': skySummary(run, satellites)});
    for (const elevation of [0, 30, 60]) {
      root.append(svg('circle', {class: elevation ? 'grid' : 'axis', cx, cy, r: r * (90 - elevation) / 90}));
      if (elevation) root.append(svg('text', {x: cx + 3, y: cy - r * (90 - elevation) / 90 - 3}, `${elevation}°`));
    }
    root.append(svg('path', {class: 'grid', d: `M${cx - r} ${cy}H${cx + r}M${cx} ${cy - r}V${cy + r}`}));
    for (const [name, dx, dy] of [['N', 0, -1], ['E', 1, 0], ['S', 0, 1], ['W', -1, 0]]) root.append(svg('text', {class: 'strong', x: cx + dx * (r + 13), y: cy + dy * (r + 13) + 4, 'text-anchor': 'middle'}, name));
    for (const satellite of satellites) {
      const away = satellite.el.map(el => r * (90 - el) / 90);
      satellite.xs = satellite.az.map((az, i) => cx + away[i] * Math.sin(az * Math.PI / 180));
      satellite.ys = satellite.az.map((az, i) => cy - away[i] * Math.cos(az * Math.PI / 180));
      // One path per state; each slice goes from its point to the next.
      for (const state of ['x', 'u', 'd', 'r']) {
        let d = '';
        for (let i = 0; i < satellite.xs.length; ++i) {
          if (satellite.states[i] !== state || !Number.isFinite(satellite.xs[i])) continue;
          d += `M${satellite.xs[i].toFixed(1)} ${satellite.ys[i].toFixed(1)}` + (Number.isFinite(satellite.xs[i + 1]) ? `L${satellite.xs[i + 1].toFixed(1)} ${satellite.ys[i + 1].toFixed(1)}` : 'h0');
        }
        if (d) root.append(svg('path', {d, fill: 'none', stroke: stateColors[state], 'stroke-linecap': 'round', ...skyStrokes[state]}));
      }
    }
    const layer = svg('g');
    root.append(layer);
    drawMarks = time => { if (root.isConnected) layer.replaceChildren(...satelliteMarks(satellites, time === null ? span : time, run.span, width)); };
    holder.replaceChildren(root);
    drawMarks(cursor.time);
  });
}

// Where the satellites are at a time, or were last before it, and their names.
function satelliteMarks(satellites, time, runSpan, width) {
  const shown = [];
  for (const {sat, states, xs, ys} of satellites) {
    let i = Math.min(xs.length - 1, Math.max(0, Math.floor(time / Math.max(1e-3, runSpan) * xs.length)));
    // A slice between two epochs is empty; one far from any says that the satellite was lost.
    const least = time >= runSpan ? 0 : i - Math.max(2, Math.ceil(xs.length / 50));
    while (i > 0 && i > least && !(Number.isFinite(xs[i]) && states[i] !== '-')) --i;
    if (i >= 0 && Number.isFinite(xs[i]) && stateColors[states[i]]) shown.push({x: xs[i], y: ys[i], name: sat, state: states[i]});
  }
  const nodes = shown.map(({x, y, state}) => svg('g', {}, marks(state, [[x, y]], 5.5, 'var(--card)', {'stroke': 'var(--card)', 'stroke-width': state === 'r' || state === 'x' ? 6 : 3}), marks(state, [[x, y]], 5)));
  // A name goes to the first of eight places around its mark that is free.
  const taken = shown.map(({x, y}) => [x - 5, y - 5, x + 5, y + 5]);
  for (const {x, y, name} of shown) {
    const places = [[9, 4, 'start'], [-9, 4, 'end'], [0, -9, 'middle'], [0, 18, 'middle'], [8, -7, 'start'], [-8, -7, 'end'], [8, 15, 'start'], [-8, 15, 'end']];
    const box = ([dx, dy, anchor]) => { const x0 = x + dx - (anchor === 'start' ? 0 : anchor === 'end' ? 23 : 11); return [x0, y + dy - 9, x0 + 23, y + dy + 1]; };
    const free = place => { const [x0, y0, x1, y1] = box(place); return x0 > 0 && x1 < width && !taken.some(t => x0 < t[2] && x1 > t[0] && y0 < t[3] && y1 > t[1]); };
    const place = places.find(free) || places[0];
    taken.push(box(place));
    nodes.push(svg('text', {class: 'strong halo', x: x + place[0], y: y + place[1], 'text-anchor': place[2], style: 'font-size:11px'}, name));
  }
  return nodes;
}

const stateRank = {'-': 0, x: 1, r: 2, d: 3, u: 4};
// Signals of one satellite joined: directions from any, the best of the states.
function satellitesOf(run) {
  const found = new Map();
  for (const signal of run.signals) {
    const az = column(signal.az, 1), el = column(signal.el, 1);
    const known = found.get(signal.sat);
    if (!known) { found.set(signal.sat, {sat: signal.sat, az, el, states: [...signal.states]}); continue; }
    for (let i = 0; i < az.length; ++i) {
      if (!Number.isFinite(known.az[i])) { known.az[i] = az[i]; known.el[i] = el[i]; }
      if (stateRank[signal.states[i]] > stateRank[known.states[i]]) known.states[i] = signal.states[i];
    }
  }
  return [...found.values()];
}
function skySummary(run, satellites) {
  const used = satellites.filter(s => s.states.includes('u') || s.states.includes('d')).length;
  return `Sky plot of ${run.name}: ${satellites.length} satellites received, ${used} used. The table of signals has the details.`;
}
function stateKeys() {
  return element('div', {class: 'bar'}, ['u', 'd', 'r', 'x'].map(state => key(stateNames[state], stateColors[state])));
}
