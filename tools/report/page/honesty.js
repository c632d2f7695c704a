// Whether the runs know how good they are: squared errors in units of their covariance, and how often the
// stated areas held the truth.
const neesBand = [0.2158, 9.3484];  // the middle 95 % of chi-square with 3 degrees of freedom

function drawHonesty() {
  const stated = data.runs.filter(run => run.chance.length);
  if (!stated.length) return;
  if (data.runs.some(run => run.nees.some(Number.isFinite))) drawNees();
  drawChances(stated);
}

function drawNees() {
  const section = card('half', 'NEES', 'Squared 3D error in units of its stated covariance: 3 on average if that is honest, 95 % inside the band.' + sparse);
  const holder = element('div');
  section.append(element('div', {class: 'bar'}, runButtons(runShapeKey)), holder, honestyTable());
  const all = data.runs.flatMap(run => run.nees).filter(v => v > 0);
  const low = Math.min(-1, Math.max(-3, Math.floor(Math.log10(quantile(all, 0.01) || 0.1)))), high = Math.max(2, Math.min(6, Math.ceil(Math.log10(quantile([1, ...all], 1)))));
  drawIn(holder, width => {
    const left = 46, right = 8, top = 8, bottom = 24, height = 300;
    const x = t => left + t / span * (width - left - right);
    const y = v => top + (high - Math.min(high, Math.max(low, Math.log10(Math.max(v, 1e-12))))) / (high - low) * (height - top - bottom);
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img', 'aria-label': 'Normalised squared error over time. The table below has the means. Arrow keys move through the epochs.'});
    root.append(svg('rect', {x: left, y: y(neesBand[1]), width: Math.max(1, width - left - right), height: y(neesBand[0]) - y(neesBand[1]), fill: 'var(--soft)', 'fill-opacity': 0.16}));
    for (let power = low; power <= high; ++power) {
      const v = 10 ** power;
      root.append(svg('path', {class: 'grid', d: `M${left} ${y(v).toFixed(1)}H${width - right}`}), svg('text', {x: left - 6, y: y(v) + 4, 'text-anchor': 'end'}, power < 0 ? v.toFixed(-power) : String(v)));
    }
    root.append(svg('path', {class: 'zero', 'stroke-dasharray': '5 3', d: `M${left} ${y(3).toFixed(1)}H${width - right}`}));
    for (const t of timeTicks(span, Math.max(3, width / 110))) root.append(svg('text', {x: x(t), y: height - 6, 'text-anchor': 'middle'}, clock(t)));
    for (const run of data.runs) {
      if (!run.visible) continue;
      const points = [];
      run.nees.forEach((v, i) => { if (Number.isFinite(v)) points.push([x(run.t[i]), y(v)]); });
      root.append(runPoints(run, points, points.length > 800 ? 1.6 : 2.6));
    }
    root.append(cursorLine(root, left, right, width, height - bottom));
    holder.replaceChildren(root);
  });
}

function honestyTable() {
  const percent = value => value === null ? '–' : `${(value / 10).toFixed(0)} %`;
  return element('div', {class: 'scroll'}, element('table', {class: 'plain'}, element('caption', {class: 'hidden'}, 'Honesty of the stated accuracy'),
    element('thead', {}, element('tr', {}, ['Run', 'Mean NEES', 'In the 95 % band', 'Inside the 68 % radius'].map(text => element('th', {scope: 'col'}, text)))),
    element('tbody', {}, data.runs.map(run => element('tr', {}, element('th', {scope: 'row'}, run.name),
      [run.meanNees === null ? '–' : (run.meanNees / 100).toFixed(2), percent(run.neesInBand), percent(run.within)].map(text => element('td', {}, text)))))));
}

function drawChances(stated) {
  const section = card('half', 'Stated against held', 'How often the area that states a share holds the truth. On the diagonal it is honest, below it too sure, above it too careful. Lines: ellipses; dots: the circle of the stated 68 % radius.');
  const holder = element('div');
  section.append(element('div', {class: 'bar'}, runButtons()), holder);
  drawIn(holder, width => {
    const left = 60, right = 14, top = 8, bottom = 40, size = Math.min(width - left - right, 400);
    const full = left + size + right, height = top + size + bottom;
    const x = share => left + share * size, y = share => top + size - share * size;
    const summary = stated.filter(run => run.within !== null).map(run => `${run.name}: ${(run.within / 10).toFixed(0)} % inside the 68 % radius`).join('; ');
    const root = svg('svg', {viewBox: `0 0 ${full} ${height}`, height, style: `width:${full}px;max-width:100%;margin:0 auto`, role: 'img', 'aria-label': `Share held against share stated. ${summary}.`});
    for (const share of [0, 0.25, 0.5, 0.68, 0.95]) {
      root.append(svg('path', {class: 'grid', d: `M${x(share).toFixed(1)} ${top}v${size}M${left} ${y(share).toFixed(1)}h${size}`}));
      root.append(svg('text', {x: x(share), y: top + size + 17, 'text-anchor': 'middle'}, `${Math.round(share * 100)} %`), svg('text', {x: left - 6, y: y(share) + 4, 'text-anchor': 'end'}, `${Math.round(share * 100)} %`));
    }
    root.append(svg('path', {class: 'axis', d: `M${left} ${top}h${size}v${size}`}));
    root.append(svg('path', {class: 'zero', 'stroke-dasharray': '5 3', d: `M${x(0)} ${y(0)}L${x(1)} ${y(1)}`}));
    for (const run of stated) {
      if (!run.visible) continue;
      const last = run.chance.length - 1;
      root.append(svg('path', {d: path([x(0), ...run.chance.map(x), x(1)], [y(0), ...run.chance.map((_, i) => y(i / last)), y(1)]), fill: 'none', stroke: run.color, 'stroke-width': 2.2, 'stroke-linejoin': 'round'}));
      if (run.within !== null) root.append(svg('circle', {cx: x(0.68), cy: y(run.within / 1000), r: 4.5, fill: run.color, stroke: 'var(--card)', 'stroke-width': 1.5}));
    }
    root.append(svg('text', {x: left + size / 2, y: height - 4, 'text-anchor': 'middle'}, 'stated share'));
    root.append(svg('text', {transform: `translate(12 ${top + size / 2}) rotate(-90)`, 'text-anchor': 'middle'}, 'share of epochs held'));
    holder.replaceChildren(root);
  });
}
