// The photographs with their landmarks, coloured by how far each is from where the estimate expects it.
const residualSteps = [[1, '#56b4e9', 'below 1 px'], [2, '#f5ea51', '1 to 2 px'], [4, '#f5a300', '2 to 4 px'], [Infinity, '#ff5a2a', 'above 4 px']];
const residualStretch = 10;

function drawPhotos() {
  const photos = data.scene.photos, runs = data.runs.filter(run => run.sights.length);
  if (!photos.length || !runs.length) return;
  const run = () => runs.includes(chosenRun) ? chosenRun : runs[runs.length - 1];
  const sightsOf = photo => run().sights.find(of => of.p === photo);
  const section = card('', 'Photographs', `Landmarks where they were seen. Lines lead to where the estimate expects them, ${residualStretch} times as long as they are.`);
  let at = Math.max(0, photos.findIndex((_, index) => sightsOf(index)?.counts[2] > 0));

  const slider = element('input', {type: 'range', min: 0, max: photos.length - 1, step: 1, value: at, 'aria-label': 'Photograph', oninput: event => choose(Number(event.target.value))});
  const step = (label, title, by) => element('button', {type: 'button', 'aria-label': title, title, onclick: () => choose(at + by)}, label);
  const bar = element('div', {class: 'bar'}, chosenSelect('As seen by', runs), photos.length > 1 ? element('span', {class: 'turn'}, step('‹', 'Previous photograph', -1), slider, step('›', 'Next photograph', 1)) : []);
  const holder = element('div'), list = element('div', {class: 'scroll'});
  const caption = element('p', {class: 'readout', 'aria-live': 'polite'});
  const legend = element('div', {class: 'bar legend'}, residualSteps.map(([, color, label]) => markKey(label, 'u', color)),
    markKey(stateNames.d, 'd', 'var(--soft)'), markKey(stateNames.r, 'r', 'var(--soft)'), markKey('not used', 'x', 'var(--soft)'));
  section.append(bar, element('div', {class: 'beside'}, element('div', {}, holder, caption, legend), list));

  function choose(index) {
    at = Math.min(photos.length - 1, Math.max(0, index));
    if (Number.isFinite(photos[at].t)) cursor.set(photos[at].t);
    redraw();
  }
  // A cursor on another drawing brings the photograph of that time.
  cursor.listeners.push(time => {
    if (time === null) return;
    const near = photos.findIndex(photo => Math.abs(photo.t - time) <= 1.5 && Math.abs(photo.t - time) <= Math.abs(photos[at].t - time));
    if (near >= 0 && near !== at) { at = near; redraw(); }
  });

  let width = 0;
  function redraw() {
    slider.value = at;
    slider.setAttribute('aria-valuetext', describePhoto(photos[at], sightsOf(at)));
    caption.textContent = describePhoto(photos[at], sightsOf(at));
    if (width > 0) holder.replaceChildren(photoDrawing(photos[at], sightsOf(at), width, event => {
      const by = {ArrowLeft: -1, ArrowRight: 1, Home: -photos.length, End: photos.length}[event.key];
      if (by) { event.preventDefault(); choose(at + by); holder.firstChild.focus(); }
    }));
    list.replaceChildren(photoTable(photos, sightsOf, at, index => {
      choose(index);
      list.querySelector('[aria-current]').focus({preventScroll: true});
    }, run().name));
  }
  drawIn(holder, now => { width = now; redraw(); });
}

// Its own size; of one that could not be read, the size of another or the room its landmarks take.
function photoSize(photo, of) {
  const known = photo.w > 0 ? photo : data.scene.photos.find(other => other.w > 0);
  if (known) return [known.w, known.h];
  const most = values => Math.max(1, ...values.filter(Number.isFinite));
  return of ? [most(of.x) * 1.05, most(of.y) * 1.05] : [4, 3];
}

function photoDrawing(photo, of, width, onkeydown) {
  const [wide, tall] = photoSize(photo, of);
  const height = Math.min(620, width * tall / wide), scale = height / tall;
  const root = svg('svg', {class: 'photo', viewBox: `0 0 ${wide * scale} ${height}`, height, style: `width:${wide * scale}px;max-width:100%`, tabindex: 0, role: 'img', 'aria-label': `Photograph ${describePhoto(photo, of)}. Arrow keys turn to the next.`, onkeydown});
  root.append(svg('rect', {width: wide * scale, height, fill: '#3a424c'}));
  if (photo.jpeg) root.append(svg('image', {href: `data:image/jpeg;base64,${photo.jpeg}`, width: wide * scale, height, preserveAspectRatio: 'none'}));
  else root.append(svg('text', {x: wide * scale / 2, y: 24, 'text-anchor': 'middle', style: 'fill:#fff'}, 'The photograph could not be read.'));
  if (!of) return root;
  const r = width < 560 ? 2.2 : 3;
  const groups = new Map();
  of.x.forEach((x, k) => {
    if (x === null || of.y[k] === null) return;
    const length = Math.hypot(of.rx[k], of.ry[k]), state = of.states[k];
    const color = Number.isFinite(length) ? residualSteps.find(([limit]) => length <= limit)[1] : '#ffffff';
    const id = state + color;
    if (!groups.has(id)) groups.set(id, {state, color, points: [], lines: ''});
    const px = x * scale, py = of.y[k] * scale;
    groups.get(id).points.push([px, py]);
    if (length > 0 && (state === 'u' || state === 'd')) groups.get(id).lines += `M${px.toFixed(1)} ${py.toFixed(1)}l${(-of.rx[k] * residualStretch * scale).toFixed(1)} ${(-of.ry[k] * residualStretch * scale).toFixed(1)}`;
  });
  // Large residuals lie on top of small ones.
  const order = ({state, color}) => 'xudr'.indexOf(state) * 10 + residualSteps.findIndex(step => step[1] === color);
  for (const group of [...groups.values()].sort((a, b) => order(a) - order(b))) {
    root.append(svg('path', {d: group.lines, stroke: group.color, 'stroke-width': 1.2, fill: 'none'}));
    root.append(marks(group.state, group.points, r, '#000', {'stroke': '#000', 'stroke-width': 2.6, 'stroke-opacity': 0.55, 'fill-opacity': 0}));
    root.append(marks(group.state, group.points, r, group.color));
  }
  return root;
}

function describePhoto(photo, of) {
  const parts = [Number.isFinite(photo.t) ? `${photo.name}, ${clock(photo.t)}` : photo.name];
  if (!of) return parts[0] + ': no landmark was recognised';
  const [, unused, used, down, rejected] = of.counts;
  if (unused && !used && !down) return `${parts[0]}: recognised by ${unused} landmarks, but not used`;
  parts.push(`${used} landmarks used`);
  if (down) parts.push(`${down} down-weighted`);
  if (rejected) parts.push(`${rejected} rejected`);
  if (unused) parts.push(`${unused} not used`);
  if (of.median !== null) parts.push(`median residual ${(of.median / 100).toFixed(2)} px`);
  return parts.join(' · ');
}

function photoTable(photos, sightsOf, at, choose, name) {
  const head = ['File', 'Used', 'Down-weighted', 'Rejected', 'Residual, px'];
  return element('table', {class: 'photos'}, element('caption', {class: 'hidden'}, `Landmarks of the photographs, ${name}`),
    element('thead', {}, element('tr', {}, head.map(text => element('th', {scope: 'col'}, text)))),
    element('tbody', {}, photos.map((photo, index) => {
      const of = sightsOf(index), counts = of ? of.counts : [0, 0, 0, 0, 0];
      return element('tr', {class: index === at ? 'current' : ''},
        element('th', {scope: 'row'}, element('button', {type: 'button', 'aria-current': index === at ? 'true' : null, onclick: () => choose(index)}, photo.name)),
        [String(counts[2]), String(counts[3]), String(counts[4]), !of || of.median === null ? '–' : (of.median / 100).toFixed(2)].map(text => element('td', {}, text)));
    })));
}
