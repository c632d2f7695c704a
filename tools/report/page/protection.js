// Stanford diagrams: what each epoch stated as its protection level against its error.
function drawProtection() {
  if (!hasErrors) return;
  drawStanford('Horizontal protection', 'pl', run => run.ee.map((east, i) => Math.hypot(east, run.en[i])));
  drawStanford('Vertical protection', 'vpl', run => run.eu.map(Math.abs));
}

function drawStanford(title, level, errorsOf) {
  const points = data.runs.map(run => {
    const errors = errorsOf(run);
    return run[level].map((stated, i) => [errors[i], stated]).filter(pair => pair[0] >= 0 && pair[1] > 0 && pair.every(Number.isFinite));
  });
  const all = points.flat();
  if (!all.length) return;
  const section = card('half', title, 'A point per epoch. Above the line the protection level held; below it, in the hatched part, the error was larger.' + sparse);
  const holder = element('div'), summary = element('p', {class: 'readout'});
  section.append(element('div', {class: 'bar'}, runButtons(runShapeKey)), holder, summary);

  // Decades that hold all but the smallest errors, which stay on the edge.
  const low = Math.max(-2, Math.floor(Math.log10(Math.max(1e-9, quantile(all.map(pair => Math.min(...pair)), 0.02)))));
  const high = Math.max(low + 1, Math.ceil(Math.log10(quantile(all.map(pair => Math.max(...pair)), 1))));
  const texts = data.runs.filter((_, k) => points[k].length).map(run => {
    const mine = points[run.index], beyond = mine.filter(([error, stated]) => error > stated).length;
    return `${data.runs.length > 1 ? run.name + ': ' : ''}${beyond} of ${mine.length} beyond`;
  });
  const drawnOnly = sparse && ', of the epochs drawn; the table counts all.';
  summary.textContent = texts.join('  ·  ') + drawnOnly;

  drawIn(holder, width => {
    const left = 56, right = 10, top = 8, bottom = 40, size = Math.min(width - left - right, 400);
    const full = left + size + right, height = top + size + bottom;
    const place = v => (Math.min(high, Math.max(low, Math.log10(Math.max(v, 1e-9)))) - low) / (high - low) * size;
    const x = v => left + place(v), y = v => top + size - place(v);
    const root = svg('svg', {viewBox: `0 0 ${full} ${height}`, height, style: `width:${full}px;max-width:100%;margin:0 auto`, role: 'img', 'aria-label': `${title}: protection level against error. ${texts.join('; ')}${drawnOnly || '.'}`});
    const id = `hatch-${level}`;
    root.append(svg('defs', {}, svg('pattern', {id, width: 7, height: 7, patternUnits: 'userSpaceOnUse', patternTransform: 'rotate(45)'}, svg('path', {d: 'M0 0V7', stroke: 'var(--rejected)', 'stroke-width': 1.6, 'stroke-opacity': 0.4}))));
    root.append(svg('path', {d: `M${left} ${top + size}H${left + size}V${top}Z`, fill: `url(#${id})`}));
    for (let power = low; power <= high; ++power) {
      const v = 10 ** power, text = power < 0 ? v.toFixed(-power) : String(v);
      root.append(svg('path', {class: 'grid', d: `M${x(v).toFixed(1)} ${top}v${size}M${left} ${y(v).toFixed(1)}h${size}`}));
      root.append(svg('text', {x: x(v), y: top + size + 17, 'text-anchor': power === high ? 'end' : 'middle'}, text), svg('text', {x: left - 6, y: y(v) + (power === high ? 9 : 4), 'text-anchor': 'end'}, text));
    }
    root.append(svg('path', {class: 'zero', d: `M${left} ${top + size}L${left + size} ${top}`}));
    for (const run of data.runs) if (run.visible) root.append(runPoints(run, points[run.index].map(([error, stated]) => [x(error), y(stated)]), 3));
    // What must not happen is ringed.
    const missed = data.runs.filter(run => run.visible).flatMap(run => points[run.index]).filter(([error, stated]) => error > stated);
    root.append(marks('x', missed.map(([error, stated]) => [x(error), y(stated)]), 6, 'var(--rejected)', {'stroke-width': 1.6}));
    root.append(svg('text', {x: left + size / 2, y: height - 4, 'text-anchor': 'middle'}, 'error, m'));
    root.append(svg('text', {transform: `translate(12 ${top + size / 2}) rotate(-90)`, 'text-anchor': 'middle'}, 'protection level, m'));
    holder.replaceChildren(root);
  });
}
