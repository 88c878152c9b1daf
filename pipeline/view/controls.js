// Buttons, slider, keys and the address's options (#frame=30&strain=1&wire=1&...).

const element = (id) => document.getElementById(id);

function readOptions() {
  const options = new URLSearchParams(location.hash.slice(1));
  const number = (name, otherwise) =>
      (options.has(name) && isFinite(options.get(name)) ? Number(options.get(name)) : otherwise);
  return {
    number,
    flag: (name, otherwise) => (options.has(name) ? options.get(name) !== "0" : otherwise),
    text: (name) => options.get(name)
  };
}

// Marks under the slider: frames with intersecting pairs in red; frames of a fall-back stepper in amber, half as high.
function drawTicks(canvas, runs, timeline) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2), frames = timeline.length;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const context = canvas.getContext("2d"), style = getComputedStyle(document.documentElement);
  timeline.forEach((time, f) => {
    const at = runs.map((run) => [run, frameAt(run, time)]).filter(([run]) => time <= run.end + 1e-9);
    const bad = at.some(([run, g]) => run.pairs[g] > 0 || run.series.nonfinite[g] > 0);
    const fell = at.some(([run, g]) => run.series.fell_back[g]);
    if (!bad && !fell) return;
    context.fillStyle = style.getPropertyValue(bad ? "--bad" : "--warn");
    const step = canvas.width / Math.max(1, frames - 1);
    const top = bad ? 0 : canvas.height / 2;
    context.fillRect(Math.max(0, (f - 0.5) * step), top, Math.max(ratio, step), canvas.height - top);
  });
}

function bindToggle(id, key, look, change) {
  const button = element(id);
  const show = () => button.setAttribute("aria-pressed", look[id]);
  const flip = () => {
    look[id] = !look[id];
    show();
    change();
  };
  button.addEventListener("click", flip);
  show();
  return {[key]: flip};
}

function bindKeys(actions) {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target instanceof Element && event.target.matches("input[type=number], select")) return;
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

function firstTheme(options) {
  const asked = options.text("theme");
  if (asked === "dark" || asked === "light") return asked;
  return window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

function showTransport(player, {times, last}) {
  const slider = element("frame");
  element("transport").hidden = last === 0;  // one frame, as of a fit, has nothing to play
  slider.max = last;
  slider.value = player.frame;
  slider.style.setProperty("--played", `${last ? (100 * player.frame) / last : 0}%`);
  element("frame-text").textContent = player.frame;
  element("frame-last").textContent = ` / ${last}`;
  element("time-text").textContent = `${times[player.frame].toFixed(3)} s`;
  element("play").classList.toggle("playing", player.playing);
  element("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
}

function bindControls(page) {
  const {player, look, timeline, redraw} = page, root = document.documentElement;
  const toggle = () => player.play(!player.playing);
  const flipTheme = () => page.setTheme(root.dataset.theme === "dark" ? "light" : "dark");
  element("frame").max = timeline.last;
  element("frame").addEventListener("input", (event) => {
    player.pause();
    player.go(Number(event.target.value));
  });
  element("play").addEventListener("click", toggle);
  element("back").addEventListener("click", () => player.step(-1));
  element("forward").addEventListener("click", () => player.step(1));
  element("reset").addEventListener("click", page.home);
  element("theme").addEventListener("click", flipTheme);
  element("strain-top").value = look.strainTop.toFixed(3).replace(/0$/, "");
  element("strain-top").addEventListener("input", (event) => {
    look.strainTop = Math.max(1.0001, Number(event.target.value) || 1.1);
    redraw();
  });
  bindKeys({
    " ": toggle,
    ArrowLeft: (event) => player.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => player.step(event.shiftKey ? 10 : 1),
    Home: () => player.step(-timeline.last),
    End: () => player.step(timeline.last),
    r: page.home,
    t: flipTheme,
    ...bindToggle("strain", "s", look, redraw),
    ...bindToggle("wire", "w", look, redraw),
    ...bindToggle("marks", "x", look, redraw),
    ...bindToggle("plots", "p", look, page.arrange),
  });
}
