// What became of every signal over time, and how strong it was.
function drawTimeline(chosen) {
  const section = card('', 'Signals', 'One row per signal. A full bar was used, a lower one counted less, a thin one was rejected or not usable.');
  const holder = element('div', {class: 'tall'});
  section.append(stateKeys(), holder);
  drawIn(holder, width => {
    const run = chosen();
    const left = 70, right = 52, row = 15, top = 4, bottom = 24, height = top + run.signals.length * row + bottom;
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img', 'aria-label': `Use of ${run.signals.length} signals over time. The table of signals has the details.`});
    const x = t => left + t / span * (width - left - right);
    for (const t of timeTicks(span, Math.max(3, width / 110))) root.append(svg('path', {class: 'grid', d: `M${x(t).toFixed(1)} ${top}V${height - bottom}`}), svg('text', {x: x(t), y: height - 7, 'text-anchor': 'middle'}, clock(t)));
    const shape = {u: [2, 11], d: [5, 8], r: [9, 4], x: [10, 2]};
    const bars = {u: '', d: '', r: '', x: ''};
    run.signals.forEach((signal, index) => {
      const y = top + index * row, slices = signal.states.length;
      const name = `${signal.sat} ${signal.sig}`;
      const newSystem = index > 0 && run.signals[index - 1].sat[0] !== signal.sat[0];
      if (newSystem) root.append(svg('path', {class: 'axis', d: `M0 ${y}H${width}`}));
      root.append(svg('text', {x: 4, y: y + 11.5, style: 'font-size:11px'}, name));
      let from = 0;
      while (from < slices) {
        const state = signal.states[from];
        let to = from + 1;
        while (to < slices && signal.states[to] === state) ++to;
        if (shape[state]) {
          const [dy, h] = shape[state], x0 = x(from / slices * run.span), x1 = x(to / slices * run.span);
          bars[state] += `M${x0.toFixed(1)} ${y + dy}H${x1.toFixed(1)}v${h}H${x0.toFixed(1)}Z`;
        }
        from = to;
      }
      const share = signal.counts[0] ? Math.round(100 * signal.counts[1] / signal.counts[0]) : 0;
      root.append(svg('text', {x: width - 4, y: y + 11.5, 'text-anchor': 'end', style: 'font-size:11px'}, `${share} %`));
    });
    for (const state of ['x', 'u', 'd', 'r']) root.append(svg('path', {d: bars[state], fill: stateColors[state]}));
    root.append(cursorLine(root, left, right, width, height - bottom));
    holder.replaceChildren(root);
  });
}

// Means over every `count` values, so that noise does not hide the trend.
function thinned(values, count) {
  const means = [];
  for (let i = 0; i < values.length; i += count) {
    const some = values.slice(i, i + count).filter(Number.isFinite);
    means.push(some.length ? some.reduce((a, b) => a + b) / some.length : NaN);
  }
  return means;
}

function drawStrength(chosen) {
  const section = card('half', 'Signal strength', 'C/N0 in dB-Hz, a line per signal; dashed: L5, E5 and other second frequencies.');
  const bar = element('div', {class: 'bar'}), holder = element('div');
  section.append(bar, holder);
  drawIn(holder, width => {
    const run = chosen();
    const left = 34, right = 8, top = 8, bottom = 24, height = Math.round(Math.min(430, Math.max(260, width * 0.75)));
    const strengths = run.signals.map(signal => thinned(column(signal.cn0, 1), Math.max(1, Math.round(360 / Math.max(60, width / 5)))));
    const all = strengths.flat().filter(Number.isFinite);
    const low = Math.min(15, Math.floor((quantile(all, 0.002) || 15) / 5) * 5), high = Math.max(50, Math.ceil((quantile(all, 0.999) || 50) / 5) * 5);
    const x = t => left + t / span * (width - left - right), y = v => height - bottom - (v - low) / (high - low) * (height - top - bottom);
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img', 'aria-label': 'Carrier to noise density of every signal over time'});
    for (const v of ticks(low, high, height / 50)) root.append(svg('path', {class: 'grid', d: `M${left} ${y(v).toFixed(1)}H${width - right}`}), svg('text', {x: left - 6, y: y(v) + 4, 'text-anchor': 'end'}, String(v)));
    for (const t of timeTicks(span, Math.max(3, width / 110))) root.append(svg('text', {x: x(t), y: height - 7, 'text-anchor': 'middle'}, clock(t)));
    const systems = new Set();
    run.signals.forEach((signal, index) => {
      const slices = strengths[index].length, system = signal.sat[0];
      systems.add(system);
      const xs = strengths[index].map((_, i) => x((i + 0.5) / slices * run.span));
      const second = signal.sig[0] !== '1' && !(system === 'C' && signal.sig[0] === '2');
      root.append(svg('path', {d: path(xs, strengths[index].map(y)), fill: 'none', stroke: systemColors[system] || 'var(--soft)', 'stroke-width': 1.1, 'stroke-opacity': 0.8, 'stroke-dasharray': second ? '4 3' : undefined},
        svg('title', {}, `${signal.sat} ${signal.sig}`)));
    });
    root.append(cursorLine(root, left, right, width, height - bottom));
    bar.replaceChildren(...[...systems].map(system => key(systemNames[system] || system || 'unknown', systemColors[system] || 'var(--soft)', 'thin')));
    holder.replaceChildren(root);
  });
}

function listSignals(chosen) {
  const holder = element('div', {class: 'scroll'});
  document.getElementById('lists').append(element('section', {class: 'card'}, element('details', {}, element('summary', {}, 'Table of signals'), holder)));
  const show = () => {
    const run = chosen();
    const head = ['Signal', 'Epochs', 'Used', 'Down-weighted', 'Rejected', 'Mean C/N0', 'RMS residual', 'Most often not used because'];
    const percent = (part, whole) => whole ? `${(100 * part / whole).toFixed(0)} %` : '–';
    holder.replaceChildren(element('table', {}, element('caption', {class: 'hidden'}, `Signals of ${run.name}`),
      element('thead', {}, element('tr', {}, head.map(text => element('th', {scope: 'col'}, text)))),
      element('tbody', {}, run.signals.map(signal => {
        const [seen, used, down, rejected] = signal.counts;
        return element('tr', {}, element('th', {scope: 'row'}, `${signal.sat} ${signal.sig}`),
          [seen.toLocaleString('en'), percent(used, seen), percent(down, seen), percent(rejected, seen),
            signal.cn0mean === null ? '–' : (signal.cn0mean / 10).toFixed(1), signal.rms === null ? '–' : metres(signal.rms / 100)].map(text => element('td', {}, text)),
          element('td', {class: 'text'}, signal.reason.replaceAll('_', ' ') || '–'));
      }))));
  };
  redraws.push(show);
  show();
}

function listEvents(chosen) {
  const holder = element('div', {class: 'scroll tall'}), summary = element('summary', {});
  const details = element('details', {open: ''}, summary, holder);
  document.getElementById('lists').append(element('section', {class: 'card'}, details));
  const show = () => {
    const run = chosen();
    summary.textContent = `Events (${run.eventCount.toLocaleString('en')})`;
    if (!run.events.length) { holder.replaceChildren(element('p', {class: 'hint'}, 'Nothing out of the ordinary was reported.')); return; }
    const cut = run.eventCount > run.events.length ? `The first ${run.events.length} of ${run.eventCount} events` : 'Events';
    holder.replaceChildren(element('table', {}, element('caption', {class: 'hidden'}, cut),
      element('thead', {}, element('tr', {}, ['Time', 'Event', 'What happened'].map(text => element('th', {scope: 'col', class: 'text', style: 'text-align:left'}, text)))),
      element('tbody', {}, run.events.map(([t, event, text]) => {
        const seconds = t === null ? NaN : t / 1000;
        const go = Number.isFinite(seconds) ? element('button', {type: 'button', title: 'Show on the map', onclick: () => cursor.set(seconds)}, clock(Math.max(0, seconds))) : '–';
        return element('tr', {}, element('td', {class: 'text'}, go), element('td', {class: 'text'}, event.replaceAll('_', ' ')), element('td', {class: 'text'}, text));
      }))));
  };
  redraws.push(show);
  show();
}
