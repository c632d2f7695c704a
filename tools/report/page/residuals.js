// How far every signal's range and Doppler lay from what the answer says they should have been.
const levelDigits = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/';
const mostLevel = 31;

function drawResiduals(chosen) {
  drawResidualStrips(chosen, {
    title: 'Residuals of ranges', values: 'code', states: 'codeStates', step: () => 0.25, most: 5, unit: 'σ', marked: 3,
    hint: 'Measured minus expected range in units of its stated sigma, a strip per signal; within the grey band (3 σ) is as expected. Right: how many that were used lie beyond it.',
    tail: signal => { const [beyond, of] = signal.beyond; return !of ? '' : beyond && beyond / of < 0.005 ? '< 1 %' : `${(100 * beyond / of).toFixed(0)} %`; },
  });
  drawResidualStrips(chosen, {
    title: 'Residuals of Doppler', values: 'rate', states: 'rateStates', step: run => run.rateStep * 1e-4, most: Infinity, unit: 'm/s', marked: null,
    hint: 'Measured minus expected range rate, a strip per signal. Colours: what became of its range.', tail: () => '',
  });
}

function drawResidualStrips(chosen, of) {
  const has = run => run.signals.some(signal => signal[of.values] !== '');
  const runs = data.runs.filter(has);
  if (!runs.length) return;
  const both = data.runs.some(run => run.signals.some(signal => signal.code !== '')) && data.runs.some(run => run.signals.some(signal => signal.rate !== ''));
  const section = card(both ? 'half' : '', of.title, `${of.hint} The worst of each slice of time is drawn, on the edge where it lies beyond.`);
  const holder = element('div', {class: 'tall'}), edges = element('span', {});
  const keys = Object.keys(stateNames).filter(state => stateColors[state] && runs.some(run => run.signals.some(signal => signal[of.states].includes(state))));
  section.append(element('div', {class: 'bar legend'}, keys.map(state => markKey(stateNames[state], state)), edges), holder);
  drawIn(holder, width => {
    const run = chosen(), full = Math.min(of.most, of.step(run) * mostLevel), edge = full / of.step(run), signals = run.signals.filter(signal => signal[of.values] !== '');
    if (!signals.length) { holder.replaceChildren(element('p', {class: 'hint'}, `${run.name} has none.`)); return; }
    const left = 64, right = of.marked === null ? 8 : 48, row = 30, top = 4, bottom = 24, height = top + signals.length * row + bottom;
    edges.textContent = `Strips reach ±${full.toPrecision(2)} ${of.unit}.`;
    const x = t => left + t / span * (width - left - right);
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img', 'aria-label': `${of.title} of ${signals.length} signals over time. The table of signals has the details.`});
    for (const t of timeTicks(span, Math.max(3, width / 110))) root.append(svg('path', {class: 'grid', d: `M${x(t).toFixed(1)} ${top}V${height - bottom}`}), svg('text', {x: x(t), y: height - 7, 'text-anchor': 'middle'}, clock(t)));
    const stems = {u: '', d: '', r: '', x: ''}, heads = {u: [], d: [], r: [], x: []};
    const half = row / 2 - 3;
    let bands = '', zeros = '';
    signals.forEach((signal, index) => {
      const middle = top + index * row + row / 2, levels = signal[of.values], states = signal[of.states];
      if (index > 0 && signals[index - 1].sat[0] !== signal.sat[0]) root.append(svg('path', {class: 'axis', d: `M0 ${middle - row / 2}H${width}`}));
      root.append(svg('text', {x: 4, y: middle + 4, style: 'font-size:11px'}, `${signal.sat} ${signal.sig}`), svg('text', {x: width - 4, y: middle + 4, 'text-anchor': 'end', style: 'font-size:11px'}, of.tail(signal)));
      if (of.marked !== null) bands += `M${left} ${(middle - of.marked / full * half).toFixed(1)}H${width - right}v${(2 * of.marked / full * half).toFixed(1)}H${left}Z`;
      zeros += `M${left} ${middle}H${width - right}`;
      for (let i = 0; i < levels.length; ++i) {
        const level = levelDigits.indexOf(levels[i]) - mostLevel, state = states[i];
        if (levels[i] === '-' || !stems[state] && stems[state] !== '') continue;
        const at = x((i + 0.5) / levels.length * run.span), y = middle - Math.max(-edge, Math.min(edge, level)) / edge * half;
        stems[state] += `M${at.toFixed(1)} ${middle}V${y.toFixed(1)}`;
        if (state === 'r' || Math.abs(level) >= edge) heads[state].push([at, y]);
      }
    });
    root.append(svg('path', {d: bands, fill: 'var(--soft)', 'fill-opacity': 0.16}), svg('path', {class: 'zero', d: zeros}));
    const slices = Math.max(...signals.map(signal => signal[of.values].length));
    const thick = Math.max(1, Math.min(5, (width - left - right) / slices * 0.7));
    for (const state of ['x', 'u', 'd', 'r']) {
      root.append(svg('path', {d: stems[state], fill: 'none', stroke: stateColors[state], 'stroke-width': thick}));
      if (heads[state].length) root.append(marks(state, heads[state], 1.8));
    }
    root.append(cursorLine(root, left, right, width, height - bottom));
    holder.replaceChildren(root);
  });
}
