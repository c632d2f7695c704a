// The sky above the receiver: each satellite's way, coloured by what became of its signals.
function drawSky(chosen) {
  const section = card('half', 'Sky', 'North is up, the rim is the horizon. A satellite counts as its best signal.');
  const holder = element('div');
  section.append(stateKeys(), holder);
  drawIn(holder, width => {
    const run = chosen();
    const size = Math.min(width, 460), r = size / 2 - 24, cx = width / 2, cy = size / 2;
    const root = svg('svg', {viewBox: `0 0 ${width} ${size}`, height: size, role: 'img', 'aria-label': skySummary(run)});
    for (const elevation of [0, 30, 60]) {
      root.append(svg('circle', {class: elevation ? 'grid' : 'axis', cx, cy, r: r * (90 - elevation) / 90}));
      if (elevation) root.append(svg('text', {x: cx + 3, y: cy - r * (90 - elevation) / 90 - 3}, `${elevation}°`));
    }
    root.append(svg('path', {class: 'grid', d: `M${cx - r} ${cy}H${cx + r}M${cx} ${cy - r}V${cy + r}`}));
    for (const [name, dx, dy] of [['N', 0, -1], ['E', 1, 0], ['S', 0, 1], ['W', -1, 0]]) root.append(svg('text', {class: 'strong', x: cx + dx * (r + 13), y: cy + dy * (r + 13) + 4, 'text-anchor': 'middle'}, name));
    const labels = [];
    for (const satellite of satellitesOf(run)) {
      const xs = satellite.az.map((az, i) => cx + r * (90 - satellite.el[i]) / 90 * Math.sin(az * Math.PI / 180));
      const ys = satellite.az.map((az, i) => cy - r * (90 - satellite.el[i]) / 90 * Math.cos(az * Math.PI / 180));
      // One path per state; each slice goes from its point to the next.
      for (const state of ['x', 'u', 'd', 'r']) {
        let d = '';
        for (let i = 0; i < xs.length; ++i) {
          if (satellite.states[i] !== state || !Number.isFinite(xs[i])) continue;
          d += `M${xs[i].toFixed(1)} ${ys[i].toFixed(1)}` + (Number.isFinite(xs[i + 1]) ? `L${xs[i + 1].toFixed(1)} ${ys[i + 1].toFixed(1)}` : 'h0');
        }
        if (d) root.append(svg('path', {d, fill: 'none', stroke: stateColors[state], 'stroke-width': state === 'x' ? 2.5 : 4, 'stroke-linecap': 'round'}));
      }
      const last = xs.length - 1 - [...xs].reverse().findIndex(Number.isFinite);
      if (last < xs.length && last >= 0 && Number.isFinite(xs[last])) labels.push({x: xs[last], y: ys[last], name: satellite.sat, state: [...satellite.states].reverse().find(s => s !== '-')});
    }
    for (const label of labels) root.append(svg('circle', {cx: label.x, cy: label.y, r: 5.5, fill: stateColors[label.state] || 'var(--unusable)', stroke: 'var(--card)', 'stroke-width': 1.5}));
    // A name goes to the first of eight places around its dot that is free.
    const taken = labels.map(label => [label.x - 5, label.y - 5, label.x + 5, label.y + 5]);
    for (const label of labels) {
      const places = [[8, 4, 'start'], [-8, 4, 'end'], [0, -9, 'middle'], [0, 18, 'middle'], [8, -7, 'start'], [-8, -7, 'end'], [8, 15, 'start'], [-8, 15, 'end']];
      const box = ([dx, dy, anchor]) => { const x0 = label.x + dx - (anchor === 'start' ? 0 : anchor === 'end' ? 23 : 11); return [x0, label.y + dy - 9, x0 + 23, label.y + dy + 1]; };
      const free = place => { const [x0, y0, x1, y1] = box(place); return x0 > 0 && x1 < width && !taken.some(t => x0 < t[2] && x1 > t[0] && y0 < t[3] && y1 > t[1]); };
      const place = places.find(free) || places[0];
      taken.push(box(place));
      root.append(svg('text', {class: 'strong', x: label.x + place[0], y: label.y + place[1], 'text-anchor': place[2], style: 'paint-order:stroke;stroke:var(--card);stroke-width:3px;font-size:11px'}, label.name));
    }
    holder.replaceChildren(root);
  });
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
function skySummary(run) {
  const satellites = satellitesOf(run);
  const used = satellites.filter(s => s.states.includes('u') || s.states.includes('d')).length;
  return `Sky plot of ${run.name}: ${satellites.length} satellites received, ${used} used. The table of signals has the details.`;
}
function stateKeys() {
  return element('div', {class: 'bar'}, ['u', 'd', 'r', 'x'].map(state => key(stateNames[state], stateColors[state])));
}
