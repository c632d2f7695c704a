// What stands around the receiver, for the map: buildings, landmarks, and the lines of sight to them.
const hasLandmarks = data.runs.some(run => /[udrx]/.test(run.landmarks));
const layers = {landmarks: true, buildings: true};

// The chosen run, or the last that has landmarks.
const landmarkRun = () => /[udrx]/.test(chosenRun.landmarks) ? chosenRun : [...data.runs].reverse().find(run => /[udrx]/.test(run.landmarks));

function drawBuildings(x, y) {
  const group = svg('g');
  if (!layers.buildings) return group;
  for (const building of data.scene.buildings) {
    const d = path(building.e.map(x), building.n.map(y));
    if (d) group.append(svg('path', {class: 'building', d: d + 'Z'}, svg('title', {}, `${building.name || 'building'}, ${(building.h / 10).toFixed(0)} m high`)));
  }
  return group;
}

function drawLandmarks(x, y, width, height) {
  const group = svg('g');
  if (!layers.landmarks || !hasLandmarks) return group;
  const {e, n} = data.scene.landmarks, states = landmarkRun().landmarks;
  const points = {x: [], u: [], d: [], r: []};
  for (let i = 0; i < e.length; ++i) {
    const px = x(e[i]), py = y(n[i]);
    if (points[states[i]] && px > -5 && px < width + 5 && py > -5 && py < height + 5) points[states[i]].push([px, py]);
  }
  for (const state of ['x', 'u', 'd', 'r']) {
    if (points[state].length) group.append(marks(state, points[state], {u: 1.6, d: 2.4, r: 2.4, x: 1.5}[state], stateColors[state], {'fill-opacity': 0.75}));
  }
  return group;
}

// From the fix at a time to the landmarks of the photograph it looked at.
function drawSightLines(time, x, y) {
  const run = hasLandmarks && landmarkRun();
  if (!run || !layers.landmarks) return '';
  const of = run.sights.find(sights => Math.abs(data.scene.photos[sights.p].t - time) <= 1.5);
  const at = nearestEpoch(run, time);
  if (!of || !Number.isFinite(run.e[at]) || Math.abs(run.t[at] - time) > 1.5) return '';
  const {e, n} = data.scene.landmarks, from = `M${x(run.e[at]).toFixed(1)} ${y(run.n[at]).toFixed(1)}`;
  let d = '';
  of.i.forEach((landmark, k) => {
    if ((of.states[k] === 'u' || of.states[k] === 'd') && Number.isFinite(e[landmark]) && Number.isFinite(n[landmark])) d += `${from}L${x(e[landmark]).toFixed(1)} ${y(n[landmark]).toFixed(1)}`;
  });
  return svg('path', {d, fill: 'none', stroke: 'var(--used)', 'stroke-width': 0.7, 'stroke-opacity': 0.22});
}

// Buttons that show and hide the layers, and what the marks mean.
function layerButtons(draw) {
  const button = (name, label) => element('button', {type: 'button', 'aria-pressed': 'true', onclick: event => {
    layers[name] = !layers[name];
    event.currentTarget.setAttribute('aria-pressed', String(layers[name]));
    draw();
  }}, label);
  return [hasLandmarks ? button('landmarks', 'Landmarks') : [], data.scene.buildings.length ? button('buildings', 'Buildings') : []].flat();
}
function landmarkKeys() {
  if (!hasLandmarks) return [];
  const seen = data.runs.map(run => run.landmarks).join('');
  return [...'udrx'].filter(state => seen.includes(state)).map(state => markKey(`landmark ${state === 'x' ? 'not used' : stateNames[state]}`, state));
}
