// What carried each moment: a lane per source, and the events above them.
const sourceNames = {gnss: 'Satellites', vision: 'Photographs', inertial: 'Inertial sensors', motion: 'Motion alone', none: 'No answer'};
const sourceColors = {gnss: 'var(--run0)', vision: 'var(--run2)', inertial: 'var(--run3)', motion: 'var(--down)', none: 'var(--soft)'};
const noSource = 'none';
// Of an event: a triangle for what begins, a cross for what ends or is put right, a ring for what a clock
// did or came too late, a dot for the rest.
const eventKinds = {
  first_fix: 'begins', inertial_aligned: 'begins',
  fix_lost: 'ends', filter_restarted: 'ends', inertial_lost: 'ends', photo_contradicted: 'ends', photo_failed: 'ends', photo_too_late: 'ends',
  clock_discontinuity: 'clock', millisecond_jump: 'clock', time_backwards: 'clock', duplicate_epoch: 'clock', sensor_dropped: 'clock',
};
const eventStyles = {
  begins: {shape: 'd', color: 'var(--run2)', label: 'begins'},
  ends: {shape: 'r', color: 'var(--rejected)', label: 'ends, or is put right'},
  clock: {shape: 'x', color: 'var(--soft)', label: 'clock, time'},
  other: {shape: 'u', color: 'var(--soft)', label: 'other event'},
};
const eventKind = name => (Object.hasOwn(eventKinds, name) ? eventKinds[name] : 'other');
const nameOfSource = word => (Object.hasOwn(sourceNames, word) ? sourceNames[word] : word.replaceAll('_', ' '));
const colorOfSource = word => (Object.hasOwn(sourceColors, word) ? sourceColors[word] : 'var(--run4)');
const eventsOf = run => run.events.filter(event => event[0] !== null).map(([t, event, text]) => ({t: t / 1000, event, text})).filter(event => event.t > -1 && event.t < span + 1);
const eventText = event => `${clock(Math.max(0, event.t))} ${event.event.replaceAll('_', ' ')}${event.text ? ': ' + event.text : ''}`;

// The words of every epoch; an epoch without an answer has none of its own.
function sourceWords(run, i) {
  if (!Number.isFinite(run.e[i])) return [noSource];
  return run.sources[run.source[i]].split('+').filter(word => word !== '');
}

// Spans [from, to] of time in which a word holds, an epoch reaching half way to its neighbours.
function sourceSpans(run, words, word) {
  const spans = [], reach = 1.5 * run.steps;
  let open = null;
  run.t.forEach((t, i) => {
    const before = i > 0 ? Math.min(reach, t - run.t[i - 1]) / 2 : 0, after = i + 1 < run.t.length ? Math.min(reach, run.t[i + 1] - t) / 2 : 0;
    if (!words[i].includes(word)) { open = null; return; }
    if (open && t - before <= open[1] + 1e-6) open[1] = t + after;
    else spans.push(open = [t - before, t + after]);
  });
  return spans;
}

function drawSources() {
  const runs = data.runs.filter(run => run.sources.some(word => word !== '') || run.events.length);
  if (!runs.length) return;
  const lanesOf = new Map();
  for (const run of runs) {
    const words = run.t.map((_, i) => sourceWords(run, i)), counts = new Map();
    for (const word of words.flat()) counts.set(word, (counts.get(word) || 0) + 1);
    const order = Object.keys(sourceNames), place = word => (order.includes(word) ? order.indexOf(word) : order.length - 1.5);
    lanesOf.set(run, [...counts.keys()].sort((a, b) => place(a) - place(b)).slice(0, 12).map(word => ({word, share: counts.get(word) / words.length, spans: sourceSpans(run, words, word)})));
  }
  const kinds = Object.keys(eventStyles).filter(kind => runs.some(run => run.events.some(event => eventKind(event[1]) === kind)));
  const section = card('', 'What carried each moment', `A bar where a source took part, with its share of the epochs.${kinds.length ? ' Marks are events: point at one, or see the list below.' : ''}`);
  const holder = element('div'), readout = element('p', {class: 'readout'});
  const legend = kinds.map(kind => markKey(eventStyles[kind].label, eventStyles[kind].shape, eventStyles[kind].color));
  section.append(element('div', {class: 'bar'}, data.runs.length > 1 ? runButtons() : [], legend), holder, readout);

  drawIn(holder, width => {
    const narrow = width < 560, left = narrow ? 98 : 122, right = 46, lane = 17, bottom = 24;
    const shown = runs.filter(run => run.visible);
    const tallOf = run => (data.runs.length > 1 ? 20 : 0) + (run.events.length ? 20 : 4) + lanesOf.get(run).length * lane + 8;
    const height = shown.reduce((sum, run) => sum + tallOf(run), 0) + bottom;
    const x = t => left + Math.min(span, Math.max(0, t)) / span * (width - left - right);
    const summary = shown.map(run => `${run.name}: ${lanesOf.get(run).map(of => `${nameOfSource(of.word)} ${Math.round(of.share * 100)} %`).join(', ')}`).join('; ');
    const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, height, tabindex: 0, role: 'img', 'aria-label': `What carried each moment. ${summary}. Arrow keys move through the epochs.`});
    for (const t of timeTicks(span, Math.max(3, (width - left - right) / 110))) root.append(svg('path', {class: 'grid', d: `M${x(t).toFixed(1)} 0V${height - bottom}`}), svg('text', {x: x(t), y: height - 6, 'text-anchor': 'middle'}, clock(t)));
    root.append(cursorLine(root, left, right, width, height - bottom));
    let top = 0;
    for (const run of shown) {
      let y = top;
      if (data.runs.length > 1) { root.append(svg('text', {class: 'strong', x: 0, y: y + 14, style: `fill:${run.color}`}, run.name)); y += 20; }
      if (run.events.length) { root.append(svg('text', {x: 0, y: y + 14}, 'Events'), eventMarks(run, x, y + 10, width)); y += 20; } else y += 4;
      for (const of of lanesOf.get(run)) {
        let d = '';
        for (const [from, to] of of.spans) d += `M${x(from).toFixed(1)} ${y + 2}H${Math.max(x(from) + 1, x(to)).toFixed(1)}v${lane - 5}H${x(from).toFixed(1)}Z`;
        const percent = of.share * 100, text = percent > 99.5 && percent < 100 ? '> 99 %' : percent < 0.5 ? '< 1 %' : `${percent.toFixed(0)} %`;
        root.append(svg('text', {x: 0, y: y + 12.5}, nameOfSource(of.word)), svg('path', {d, fill: colorOfSource(of.word)}, svg('title', {}, nameOfSource(of.word))), svg('text', {x: width, y: y + 12.5, 'text-anchor': 'end'}, text));
        y += lane;
      }
      top += tallOf(run);
    }
    holder.replaceChildren(root);
    showSources(readout, shown, width);
  });
}

// Beside a mark stands what it is, where there is room up to the next.
function eventMarks(run, x, y, width) {
  const group = svg('g'), events = eventsOf(run).sort((a, b) => a.t - b.t);
  for (const [i, event] of events.entries()) {
    const style = eventStyles[eventKind(event.event)], name = event.event.replaceAll('_', ' ');
    const room = (i + 1 < events.length ? x(events[i + 1].t) - 6 : width) - x(event.t) - 9;
    if (name.length * 6.4 < room) group.append(svg('text', {x: x(event.t) + 8, y: y + 4, style: 'font-size:11px'}, name));
    // The invisible disc is easier to point at than the mark.
    group.append(svg('g', {}, marks(style.shape, [[x(event.t), y]], 4, style.color), svg('circle', {cx: x(event.t), cy: y, r: 9, fill: 'transparent'}), svg('title', {}, eventText(event))));
  }
  return group;
}

// Below the lanes: what the cursor stands on, events near it included, for those who cannot point.
function showSources(readout, runs, width) {
  const show = time => {
    if (time === null) { readout.textContent = 'Point at a moment, or move with the arrow keys, to read what carried it.'; return; }
    const near = span / Math.max(40, width / 8);
    readout.replaceChildren(element('b', {}, clock(time)), ...runs.map(run => {
      const events = eventsOf(run).filter(event => Math.abs(event.t - time) < near).slice(0, 3).map(eventText);
      const names = run.t.length ? sourceWords(run, nearestEpoch(run, time)).map(nameOfSource).join(' + ') : '';
      return `  ${data.runs.length > 1 ? run.name + ': ' : ''}${[names, ...events].join(' · ')}  `;
    }));
  };
  show.owner = readout;
  cursor.listeners = cursor.listeners.filter(listener => listener.owner !== readout);
  cursor.listeners.push(show);
  show(cursor.time);
}
