// Errors over time with the stated accuracy behind them, and their distribution.
function drawErrors() {
  const section = card('', hasErrors ? 'Error over time' : 'Position over time',
    hasErrors ? 'Estimate minus truth, in metres. The band is what each estimate states of itself and should hold 68 % of the line; how much it held stands beside it. Grey: no answer.' + sparse
              : 'Around the middle of the track. The band is the stated accuracy (68 %). Grey: no answer.' + sparse);
  const bar = element('div', {class: 'bar'}, runButtons());
  const holder = element('div');
  section.append(bar, holder);

  // Without truth, a still receiver scatters around its median.
  const middle = {};
  for (const name of ['e', 'n', 'u']) middle[name] = quantile(data.runs.flatMap(run => run[name]), 0.5);
  const panels = [
    {label: 'East', error: 'ee', position: 'e', axis: 0, accuracy: 'we'},
    {label: 'North', error: 'en', position: 'n', axis: 1, accuracy: 'wn'},
    {label: 'Up', error: 'eu', position: 'u', axis: 2, accuracy: 'vacc'},
  ];
  const values = (run, panel) => hasErrors ? run[panel.error] : run[panel.position].map(v => v - middle[panel.position]);
  const shown = panels.filter(panel => data.runs.some(run => values(run, panel).some(Number.isFinite)));

  drawIn(holder, width => {
    const left = 46, right = 8, each = width < 560 ? 110 : 132, gap = 12, bottom = 24;
    const height = shown.length * (each + gap) + bottom;
    const x = t => left + t / span * (width - left - right);
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img',
      'aria-label': `${hasErrors ? 'Error' : 'Position'} over time, ${shown.map(p => p.label.toLowerCase()).join(', ')}. Arrow keys move through the epochs.`});
    const runs = data.runs.filter(run => run.visible);
    shown.forEach((panel, row) => root.append(drawPanel(panel, row * (each + gap) + 6, each, width, left, right, x, runs, values)));
    for (const t of timeTicks(span, Math.max(3, width / 110))) root.append(svg('text', {x: x(t), y: height - 6, 'text-anchor': 'middle'}, clock(t)));
    root.append(cursorLine(root, left, right, width, height - bottom));
    holder.replaceChildren(root);
  });
}

function drawPanel(panel, top, tall, width, left, right, x, runs, values) {
  const group = svg('g');
  const all = runs.flatMap(run => values(run, panel)).filter(Number.isFinite).map(Math.abs);
  const bands = runs.flatMap(run => run[panel.accuracy]).filter(Number.isFinite);
  const limit = Math.max(0.5, Math.min(1.15 * Math.max(0, ...all.slice(0, 100000)), 1.4 * (quantile(all, 0.985) || 0.5)), Math.min(quantile(bands, 0.5) * 1.2 || 0, 3 * (quantile(all, 0.9) || 1)));
  const y = v => top + tall / 2 - Math.max(-1.05, Math.min(1.05, v / limit)) * tall / 2;
  const id = `clip${panel.label}`;
  group.append(svg('clipPath', {id}, svg('rect', {x: left, y: top, width: Math.max(1, width - left - right), height: tall})));
  const steps = ticks(-limit, limit, tall / 32), texts = labels(steps);
  for (const [i, v] of steps.entries()) {
    group.append(svg('path', {class: v === 0 ? 'zero' : 'grid', d: `M${left} ${y(v).toFixed(1)}H${width - right}`}));
    group.append(svg('text', {x: left - 6, y: y(v) + 4, 'text-anchor': 'end'}, texts[i]));
  }
  const plot = svg('g', {'clip-path': `url(#${id})`});
  for (const run of runs) {
    const v = values(run, panel), xs = run.t.map(x);
    let silent = '', band = '';
    for (let i = 0; i < xs.length; ++i) {
      if (!Number.isFinite(run.e[i])) {
        const wide = Math.max(1, x(run.steps) - x(0));
        if (runs.length === 1) silent += `M${(xs[i] - wide / 2).toFixed(1)} ${top}h${wide.toFixed(1)}v${tall}h${(-wide).toFixed(1)}Z`;
      }
    }
    let from = 0;
    while (from < xs.length) {
      while (from < xs.length && !Number.isFinite(run[panel.accuracy][from])) ++from;
      let to = from;
      while (to < xs.length && Number.isFinite(run[panel.accuracy][to]) && (to === from || run.t[to] - run.t[to - 1] < 4 * run.steps + 1e-6)) ++to;
      if (to > from) {
        const centre = i => hasErrors ? 0 : (Number.isFinite(v[i]) ? v[i] : 0);
        band += 'M';
        for (let i = from; i < to; ++i) band += `${xs[i].toFixed(1)} ${y(centre(i) + run[panel.accuracy][i]).toFixed(1)}L`;
        for (let i = to - 1; i >= from; --i) band += `${xs[i].toFixed(1)} ${y(centre(i) - run[panel.accuracy][i]).toFixed(1)}${i > from ? 'L' : 'Z'}`;
      }
      from = Math.max(to, from + 1);
    }
    plot.append(svg('path', {d: silent, fill: 'var(--soft)', 'fill-opacity': 0.22}));
    plot.append(svg('path', {d: band, fill: run.color, 'fill-opacity': runs.length > 1 ? 0.1 : 0.16}));
  }
  for (const run of runs) {
    const v = values(run, panel), xs = run.t.map(x);
    plot.append(svg('path', {d: path(xs, v.map(y)), fill: 'none', stroke: run.color, 'stroke-width': 1.4, 'stroke-linejoin': 'round', 'stroke-linecap': 'round'}));
    // Values beyond the drawn range get a tick on its edge.
    let beyond = '';
    for (let i = 0; i < v.length; ++i) if (Math.abs(v[i]) > limit) beyond += `M${xs[i].toFixed(1)} ${v[i] > 0 ? top : top + tall}v${v[i] > 0 ? 6 : -6}`;
    plot.append(svg('path', {d: beyond, stroke: run.color, 'stroke-width': 2}));
  }
  group.append(plot, svg('text', {class: 'strong halo', x: left + 6, y: top + 13}, `${panel.label}, m`));
  if (hasErrors) {
    const held = svg('text', {class: 'halo', x: width - right - 6, y: top + 13, 'text-anchor': 'end'});
    for (const run of runs) {
      const share = run.withinAxes[panel.axis];
      if (share !== null) held.append(svg('tspan', {dx: 10, fill: run.color}, `${runs.length > 1 && width >= 560 ? run.name + ' ' : ''}${Math.round(share / 10)} %`));
    }
    if (held.childNodes.length) held.append(' inside');
    group.append(held);
  }
  return group;
}

// A line at the cursor, which follows the pointer and the arrow keys.
function cursorLine(root, left, right, width, height) {
  const line = svg('path', {class: 'cursor', d: ''});
  const show = time => line.setAttribute('d', time === null ? '' : `M${(left + time / span * (width - left - right)).toFixed(1)} 0V${height}`);
  cursor.listeners = cursor.listeners.filter(listener => !listener.owner || listener.owner.isConnected);
  show.owner = root;
  cursor.listeners.push(show);
  const point = event => { const box = root.getBoundingClientRect(); cursor.set((event.clientX - box.left - left) / (width - left - right) * span); };
  root.addEventListener('pointermove', point);
  root.addEventListener('pointerdown', point);
  root.addEventListener('keydown', moveCursorByKey);
  show(cursor.time);
  return line;
}

function drawDistribution() {
  if (!hasErrors) return;
  const section = card('side', 'Horizontal error, share below', 'The higher and the further left, the better.', 'top');
  const holder = element('div');
  section.append(element('div', {class: 'bar'}, runButtons()), holder);
  drawIn(holder, width => {
    const left = 40, right = 12, top = 8, bottom = 40, height = innerWidth <= 860 ? 300 : hasLandmarks ? 510 : 470;
    const runs = data.runs.filter(run => run.visible && run.cdf.length);
    const last = share => Math.max(0.1, ...runs.map(run => run.cdf[Math.round(share * (run.cdf.length - 1))]));
    const limit = Math.min(last(1), last(0.98) * 1.25);
    const x = v => left + Math.min(1, v / limit) * (width - left - right), y = share => height - bottom - share * (height - top - bottom);
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, role: 'img', 'aria-label': 'Cumulative distribution of the horizontal error. ' + runs.map(run => `${run.name}: half below ${metres(cdfAt(run, 0.5))}, 95 % below ${metres(cdfAt(run, 0.95))}`).join('; ')});
    for (const share of [0, 0.25, 0.5, 0.68, 0.95, 1]) {
      root.append(svg('path', {class: 'grid', d: `M${left} ${y(share).toFixed(1)}H${width - right}`}));
      if (share !== 1) root.append(svg('text', {x: left - 6, y: y(share) + 4, 'text-anchor': 'end'}, `${Math.round(share * 100)} %`));
    }
    const steps = ticks(0, limit, Math.max(3, width / 80)), texts = labels(steps);
    for (const [i, v] of steps.entries()) {
      root.append(svg('path', {class: 'grid', d: `M${x(v).toFixed(1)} ${top}V${height - bottom}`}), svg('text', {x: x(v), y: height - bottom + 17, 'text-anchor': 'middle'}, texts[i]));
    }
    root.append(svg('text', {x: (left + width - right) / 2, y: height - 4, 'text-anchor': 'middle'}, 'horizontal error, m'));
    for (const run of runs) {
      const inside = run.cdf.filter(v => v <= limit).length;
      const xs = run.cdf.slice(0, inside).map(x), ys = run.cdf.slice(0, inside).map((_, i) => y(i / (run.cdf.length - 1)));
      root.append(svg('path', {d: path(xs, ys), fill: 'none', stroke: run.color, 'stroke-width': 2.2, 'stroke-linejoin': 'round'}));
      for (const share of [0.5, 0.68, 0.95]) {
        const v = cdfAt(run, share);
        if (v > limit) continue;
        root.append(svg('circle', {cx: x(v), cy: y(share), r: 4, fill: run.color, stroke: 'var(--card)', 'stroke-width': 1.5}));
        if (runs.length === 1) root.append(svg('text', {class: 'strong halo', x: x(v) + (x(v) > width - 80 ? -8 : 8), y: y(share) + 16, 'text-anchor': x(v) > width - 80 ? 'end' : 'start'}, metres(v)));
      }
    }
    holder.replaceChildren(root);
  });
}
function cdfAt(run, share) {
  const place = share * (run.cdf.length - 1), low = Math.floor(place);
  return low + 1 < run.cdf.length ? run.cdf[low] + (place - low) * (run.cdf[low + 1] - run.cdf[low]) : run.cdf[low];
}
