// Puts the page together.
if (chosenRun) {
  drawMap();
  if (hasErrors) drawDistribution(); else document.querySelector('.map').classList.add('alone');
  drawPhotos();
  drawErrors();
  drawSources();
  drawSpeed();
  drawProtection();
  drawHonesty();
  drawClock();
  if (data.runs.some(run => run.signals.length)) {
    if (data.runs.length > 1) document.getElementById('charts').append(element('section', {class: 'card'}, chosenSelect('Satellites and events of')));
    drawSky(chosen);
    drawStrength(chosen);
    drawTimeline(chosen);
    drawResiduals(chosen);
    listSignals(chosen);
  }
  listEvents(chosen);
}
document.addEventListener('keydown', event => { if (event.key === 'Escape') cursor.set(null); });
