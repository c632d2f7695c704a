// The map: tracks, truth and accuracy in local metres, with zoom and pan.
function drawMap() {
  const section = card('map', 'Map', 'East and north in metres. Drag to move, wheel or + and − to zoom, 0 to see all.', 'top');
  const bar = element('div', {class: 'bar'}, runButtons(), layerButtons(() => draw()));
  const legend = element('div', {class: 'bar legend'}, data.truth.e.length ? key('truth', 'var(--truth)', data.truth.e.length > 1 ? 'thin' : 'ring') : [], data.runs.some(run => run.ell.some(Boolean)) ? key('68 % ellipse', 'var(--soft)', 'ring') : [], landmarkKeys());
  const zoomButton = (label, title, action) => element('button', {type: 'button', 'aria-label': title, title, onclick: action}, label);
  bar.append(element('span', {class: 'push'}, zoomButton('+', 'Zoom in', () => zoom(1.5)), zoomButton('−', 'Zoom out', () => zoom(1 / 1.5)), hasLandmarks ? zoomButton('Track', 'Show the track', () => { fit(false); draw(); }) : '', zoomButton('All', 'Show everything', () => { fit(); draw(); })));
  const holder = element('div');
  const readout = element('p', {class: 'readout', 'aria-live': 'polite'});
  section.append(bar, holder, legend, readout);

  let width = 0, height = 0, scale = 1, centre = [0, 0], fitted = false;
  const x = e => width / 2 + (e - centre[0]) * scale;
  const y = n => height / 2 - (n - centre[1]) * scale;
  const root = svg('svg', {class: 'plan', tabindex: 0, role: 'img', 'aria-label': mapSummary()});
  holder.append(root);

  function fit(withLandmarks = hasLandmarks) {
    // The middle 99 % of the estimates and all of the truth: one wild estimate must not shrink the rest.
    const es = data.truth.e.filter(Number.isFinite), ns = data.truth.n.filter(Number.isFinite);
    for (const places of [...data.runs, withLandmarks ? data.scene.landmarks : {e: [], n: []}]) {
      for (const [values, out] of [[places.e, es], [places.n, ns]]) {
        const low = quantile(values, 0.005), high = quantile(values, 0.995);
        if (Number.isFinite(low)) out.push(low, high);
      }
    }
    const range = values => values.length ? [Math.min(...values), Math.max(...values)] : [-10, 10];
    const [e0, e1] = range(es), [n0, n1] = range(ns);
    centre = [(e0 + e1) / 2, (n0 + n1) / 2];
    scale = Math.min(width / Math.max(4, (e1 - e0) * 1.12), height / Math.max(4, (n1 - n0) * 1.12));
    fitted = true;
  }
  function zoom(factor, at = [width / 2, height / 2]) {
    const next = Math.min(2000, Math.max(1e-4, scale * factor));
    centre[0] += (at[0] - width / 2) * (1 / scale - 1 / next);
    centre[1] -= (at[1] - height / 2) * (1 / scale - 1 / next);
    scale = next;
    draw();
  }

  function accuracyShape(run, i, opacity) {
    const cx = x(run.e[i]), cy = y(run.n[i]);
    const look = {fill: run.color, 'fill-opacity': opacity, stroke: run.color, 'stroke-opacity': Math.min(1, opacity * 4)};
    if (run.ell[i]) {
      const [major, minor, azimuth] = run.ell[i];
      return svg('ellipse', {cx, cy, rx: minor * 0.01 * scale, ry: major * 0.01 * scale, transform: `rotate(${azimuth} ${cx} ${cy})`, ...look});
    }
    return Number.isFinite(run.acc[i]) ? svg('circle', {cx, cy, r: run.acc[i] * scale, ...look}) : null;
  }

  function drawGrid() {
    const group = svg('g');
    const left = centre[0] - width / 2 / scale, bottom = centre[1] - height / 2 / scale;
    const count = Math.max(3, width / 110);
    const steps = ticks(left, left + width / scale, count);
    const step = steps.length > 1 ? steps[1] - steps[0] : width / scale;
    for (const e of steps) group.append(svg('path', {class: 'grid', d: `M${x(e).toFixed(1)} 0V${height}`}));
    for (let n = Math.ceil(bottom / step) * step; n < bottom + height / scale; n += step) group.append(svg('path', {class: 'grid', d: `M0 ${y(n).toFixed(1)}H${width}`}));
    return group;
  }

  function drawScaleBar() {
    const wanted = 110 / scale, power = 10 ** Math.floor(Math.log10(wanted));
    const length = [5, 2, 1].find(factor => factor * power <= wanted) * power;
    const label = length >= 1000 ? `${length / 1000} km` : length >= 1 ? `${length} m` : `${Math.round(length * 100)} cm`;
    const x0 = 16, y0 = height - 16, x1 = x0 + length * scale;
    return svg('g', {},
      svg('rect', {x: x0 - 8, y: y0 - 24, width: x1 - x0 + 16, height: 34, rx: 5, fill: 'var(--card)', 'fill-opacity': 0.85}),
      svg('path', {d: `M${x0} ${y0 - 5}V${y0}H${x1}V${y0 - 5}`, stroke: 'var(--ink)', 'stroke-width': 1.5, fill: 'none'}),
      svg('text', {class: 'strong', x: (x0 + x1) / 2, y: y0 - 9, 'text-anchor': 'middle'}, label));
  }

  function drawRun(run) {
    const group = svg('g');
    const xs = run.e.map(x), ys = run.n.map(y);
    const inside = [];
    for (let i = 0; i < xs.length; ++i) if (xs[i] > -50 && xs[i] < width + 50 && ys[i] > -50 && ys[i] < height + 50) inside.push(i);
    const every = Math.max(1, Math.ceil(inside.length / 40));
    for (let k = 0; k < inside.length; k += every) {
      const shape = accuracyShape(run, inside[k], 0.05);
      if (shape) group.append(shape);
    }
    group.append(svg('path', {d: path(xs, ys), fill: 'none', stroke: run.color, 'stroke-width': 1.2, 'stroke-opacity': 0.55, 'stroke-linecap': 'round', 'stroke-linejoin': 'round'}));
    // One path for all dots: zero-length strokes with round ends.
    let dots = '';
    for (const i of inside) dots += `M${xs[i].toFixed(1)} ${ys[i].toFixed(1)}h0`;
    group.append(svg('path', {d: dots, stroke: run.color, 'stroke-width': inside.length > 1500 ? 2 : inside.length > 400 ? 3 : 4.5, 'stroke-linecap': 'round'}));
    return group;
  }

  function drawTruth() {
    const {e, n} = data.truth;
    if (!e.length) return '';
    if (e.length === 1) {
      const cx = x(e[0]), cy = y(n[0]);
      return svg('g', {stroke: 'var(--truth)', 'stroke-width': 2, fill: 'none'}, svg('circle', {cx, cy, r: 7}), svg('path', {d: `M${cx - 12} ${cy}h24M${cx} ${cy - 12}v24`}));
    }
    return svg('path', {d: path(e.map(x), n.map(y)), fill: 'none', stroke: 'var(--truth)', 'stroke-opacity': 0.45, 'stroke-width': 5, 'stroke-linejoin': 'round', 'stroke-linecap': 'round'});
  }

  const spot = svg('g');
  function drawMarks(time) {
    spot.replaceChildren();
    if (time === null || !width) { readout.textContent = ''; return; }
    spot.append(drawSightLines(time, x, y));
    const lines = [];
    for (const run of data.runs) {
      if (!run.visible || !run.t.length) continue;
      const i = nearestEpoch(run, time);
      if (Number.isFinite(run.e[i])) {
        const shape = accuracyShape(run, i, 0.18);
        if (shape) spot.append(shape);
        spot.append(svg('circle', {cx: x(run.e[i]), cy: y(run.n[i]), r: 6, fill: run.color, stroke: 'var(--card)', 'stroke-width': 2}));
      }
      lines.push(describeEpoch(run, i));
    }
    readout.replaceChildren(element('b', {}, clock(time)), '  ', lines.join('  ·  '));
  }
  cursor.listeners.push(drawMarks);

  function draw() {
    if (!fitted) fit();
    root.setAttribute('viewBox', `0 0 ${width} ${height}`);
    root.setAttribute('height', height);
    const still = data.truth.e.length === 1;
    root.replaceChildren(drawGrid(), drawBuildings(x, y), drawLandmarks(x, y, width, height), still ? '' : drawTruth(), ...data.runs.filter(run => run.visible).map(drawRun), still ? drawTruth() : '', spot, drawScaleBar(),
      svg('g', {transform: `translate(${width - 26} 30)`}, svg('path', {d: 'M0 -16L6 6L0 2L-6 6Z', fill: 'var(--ink)'}), svg('text', {class: 'strong', x: 0, y: 20, 'text-anchor': 'middle'}, 'N')));
    drawMarks(cursor.time);
  }
  drawIn(holder, now => { width = now; height = Math.round(Math.min(470, Math.max(300, now * 0.8))); fitted = false; draw(); });

  // Pointers: one drags, two pinch.
  const pointers = new Map();
  const place = event => { const box = root.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  root.addEventListener('pointerdown', event => { root.setPointerCapture(event.pointerId); pointers.set(event.pointerId, place(event)); root.classList.add('dragging'); });
  root.addEventListener('pointermove', event => {
    if (!pointers.has(event.pointerId)) return;
    const before = [...pointers.values()], old = pointers.get(event.pointerId), now = place(event);
    pointers.set(event.pointerId, now);
    if (pointers.size === 1) {
      centre[0] -= (now[0] - old[0]) / scale;
      centre[1] += (now[1] - old[1]) / scale;
      draw();
    } else if (pointers.size === 2) {
      const after = [...pointers.values()];
      const distance = p => Math.hypot(p[0][0] - p[1][0], p[0][1] - p[1][1]);
      zoom(distance(after) / Math.max(1, distance(before)), [(after[0][0] + after[1][0]) / 2, (after[0][1] + after[1][1]) / 2]);
    }
  });
  const release = event => { pointers.delete(event.pointerId); if (!pointers.size) root.classList.remove('dragging'); };
  root.addEventListener('pointerup', release);
  root.addEventListener('pointercancel', release);
  root.addEventListener('wheel', event => { event.preventDefault(); zoom(Math.exp(-event.deltaY * 0.0015), place(event)); }, {passive: false});
  root.addEventListener('keydown', event => {
    const move = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (move) { centre[0] += move[0] * 40 / scale; centre[1] += move[1] * 40 / scale; draw(); }
    else if (event.key === '+' || event.key === '=') zoom(1.3);
    else if (event.key === '-') zoom(1 / 1.3);
    else if (event.key === '0') { fit(); draw(); }
    else return;
    event.preventDefault();
  });
}

function describeEpoch(run, i) {
  const name = data.runs.length > 1 ? `${run.name}: ` : '';
  if (!Number.isFinite(run.e[i])) return `${name}no answer (${run.statuses[run.status[i]].replaceAll('_', ' ') || 'unknown'})`;
  const parts = [];
  if (Number.isFinite(run.ee[i])) parts.push(`${metres(Math.hypot(run.ee[i], run.en[i]))} off`);
  if (Number.isFinite(run.acc[i])) parts.push(`±${metres(run.acc[i])} stated`);
  if (Number.isFinite(run.used[i])) parts.push(`${run.used[i]} ${run.used[i] === 1 ? 'signal' : 'signals'}`);
  return name + (parts.join(', ') || 'answered');
}

function mapSummary() {
  const parts = data.runs.map(run => `${run.name}: ${run.count} ${run.count === 1 ? 'epoch' : 'epochs'}`);
  return `Map of ${parts.join('; ')}${data.truth.e.length ? ', with the truth' : ''}${hasLandmarks ? ', landmarks' : ''}${data.scene.buildings.length ? ', buildings' : ''}. The figures are in the results table.`;
}
