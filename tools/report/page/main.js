// Puts the page together.
let chosenRun = data.runs[0];
const chosen = () => chosenRun;

if (chosenRun) {
  drawMap();
  if (hasErrors) drawDistribution(); else document.querySelector('.map').classList.add('alone');
  drawErrors();
  if (data.runs.some(run => run.signals.length)) {
    if (data.runs.length > 1) {
      const select = element('select', {id: 'chosen', onchange: event => { chosenRun = data.runs[event.target.value]; redrawAll(); }},
        data.runs.map(run => element('option', {value: run.index}, run.name)));
      document.getElementById('charts').append(element('section', {class: 'card'}, element('label', {for: 'chosen'}, 'Satellites and events of '), select));
    }
    drawSky(chosen);
    drawStrength(chosen);
    drawTimeline(chosen);
    listSignals(chosen);
  }
  listEvents(chosen);
}
document.addEventListener('keydown', event => { if (event.key === 'Escape') cursor.set(null); });
