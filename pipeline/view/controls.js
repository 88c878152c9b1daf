// Buttons, slider, keys and the address's options (#frame=30&strain=1&wire=1&...).

const element = (id) => document.getElementById(id);

function readOptions() {
  const options = new URLSearchParams(location.hash.slice(1));
  const number = (name, otherwise) => (options.has(name) && isFinite(options.get(name)) ? Number(options.get(name)) : otherwise);
  return { number, flag: (name, otherwise) => (options.has(name) ? options.get(name) !== "0" : otherwise), text: (name) => options.get(name) };
}

// Marks under the slider: frames with intersecting pairs in red, frames of a fall-back stepper in amber.
function drawTicks(canvas, runs, timeline) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2), frames = timeline.length;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const context = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
  timeline.forEach((time, f) => {
    const at = runs.map((run) => [run, frameAt(run, time)]).filter(([run]) => time <= run.end + 1e-9);
    const bad = at.some(([run, g]) => run.pairs[g] > 0 || run.series.nonfinite[g] > 0);
    const fell = at.some(([run, g]) => run.series.fellBack[g]);
    if (!bad && !fell) return;
    context.fillStyle = style.getPropertyValue(bad ? "--bad" : "--warn");
    const step = canvas.width / Math.max(1, frames - 1);
    context.fillRect(Math.max(0, (f - 0.5) * step), 0, Math.max(ratio, step), canvas.height);
  });
}

function bindToggle(id, key, look, change) {
  const button = element(id);
  const show = () => button.setAttribute("aria-pressed", look[id]);
  const flip = () => { look[id] = !look[id]; show(); change(); };
  button.addEventListener("click", flip);
  show();
  return { [key]: flip };
}

function bindKeys(actions) {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches("input[type=number], select")) return;
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}
