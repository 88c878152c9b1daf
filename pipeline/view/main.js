// Puts the page together and plays it.

// Errors are kept in the document too, where a headless browser can read them.
const errors = [];
function note(message) {
  errors.push(String(message));
  document.documentElement.dataset.errors = JSON.stringify(errors);
}
window.addEventListener("error", (event) => note(event.message));
window.addEventListener("unhandledrejection", (event) => note(event.reason));
const printError = console.error;
console.error = (...parts) => { note(parts.join(" ")); printError.apply(console, parts); };
document.documentElement.dataset.errors = "[]";

function makePanel(run, scaleText) {
  const panel = document.createElement("section");
  panel.className = "panel";
  panel.innerHTML = `<div class="view"><div class="name"></div><div class="detail"></div><div class="chips"></div><div class="scale"></div></div><div class="charts"></div>`;
  panel.querySelector(".name").textContent = run.name;
  panel.querySelector(".scale").textContent = scaleText;
  const drawnEvery = run.drawn.length < run.frames ? `, drawn every ${run.drawn[1] - run.drawn[0]} frames` : "";
  panel.querySelector(".detail").textContent =
    `${run.stepper} \u00b7 ${run.vertices.toLocaleString("en")} vertices, ${(run.triangles.length / 3).toLocaleString("en")} triangles${drawnEvery}`;
  return { panel, view: panel.querySelector(".view"), chips: panel.querySelector(".chips"), charts: panel.querySelector(".charts") };
}

// What is worth saying about a frame, most important first: [text, class].
function chipsOf(run, frame, marked) {
  const at = (name) => run.series[name][frame], reason = at("reason") === "none" ? "" : at("reason").replace(/_/g, " ");
  const range = ["minStretch", "maxStretch"].map((name) => (at(name) === null ? "\u2013" : at(name).toFixed(3)));
  const plural = (n, word) => `${n} ${n === 1 ? word : word.replace(/ex$/, "ice")}${n === 1 ? "" : "s"}`;
  const chips = [], pairs = run.pairs[frame];
  if (at("nonfinite")) chips.push([`${plural(at("nonfinite"), "vertex")} not finite`, "bad"]);
  if (pairs) chips.push([`${plural(pairs, "intersecting pair")}, ${plural(marked, "triangle")} marked`, "bad"]);
  else chips.push([run.selfAudited ? "0 intersecting pairs" : "0 pairs with obstacles", "good"]);
  if (!run.selfAudited) chips.push(["self: not audited", "warn"]);
  if (at("vertexPairs")) chips.push([`${plural(at("vertexPairs"), "pair")} crossing at a shared vertex`, "warn"]);
  if (at("inside")) chips.push([`${plural(at("inside"), "vertex")} inside an obstacle`, "bad"]);
  if (at("fellBack")) chips.push([`fell back${reason ? `: ${reason}` : ""}`, "warn"]);
  else if (reason) chips.push([reason, "warn"]);
  if (at("by") && at("by") !== run.stepper) chips.push([`by ${at("by")}`, ""]);
  chips.push([`stretch ${range[0]} to ${range[1]}`, ""]);
  if (at("contacts")) chips.push([plural(at("contacts"), "contact"), ""]);
  if (frame === run.frames - 1 && run.ended) chips.push(["ended", ""]);
  return chips;
}

function showChips(parent, chips) {
  parent.replaceChildren(...chips.map(([text, kind]) => {
    const chip = document.createElement("span");
    chip.className = `chip ${kind}`;
    chip.textContent = text;
    return chip;
  }));
}

// A round top for the colours that nearly all frames stay under.
function strainTop(runs) {
  const tops = runs.flatMap((run) => run.series.maxStretch).filter((value) => value !== null).sort((a, b) => a - b);
  const high = tops.length ? tops[Math.floor(0.9 * (tops.length - 1))] : 1.1;
  return Math.min(3, 1 + Math.max(0.01, niceTop(high - 1)));
}

function start() {
  const data = loadRuns(), runs = data.runs, options = readOptions();
  const longest = runs.reduce((best, run) => (run.end > best.end || (run.end === best.end && run.frames > best.frames) ? run : best));
  const timeline = longest.series.time, last = timeline.length - 1;
  runs.forEach((run) => { run.ended = run.end < longest.end - 1e-9; });
  const root = document.documentElement, look = {
    strain: options.flag("strain", false), wire: options.flag("wire", false), marks: options.flag("marks", true),
    plots: options.flag("plots", true), strainTop: Math.max(1.0001, options.number("top", strainTop(runs))),
  };
  const systemDark = window.matchMedia && window.matchMedia("(prefers-color-scheme: dark)").matches;
  root.dataset.theme = ["dark", "light"].includes(options.text("theme")) ? options.text("theme") : systemDark ? "dark" : "light";
  document.title = `${runs.map((run) => run.name).join(", ")} \u00b7 selvedge`;
  element("summary").textContent = `${runs.length} run${runs.length === 1 ? "" : "s"} \u00b7 version ${data.program}`;

  const stage = makeStage(element("canvas"), runs);
  const spacing = stage.spacing, scaleText = `grid ${spacing >= 1 ? `${short(spacing)} m` : `${Math.round(spacing * 1e3) / 10} cm`}`;
  const columns = runs.length === 4 ? 2 : Math.min(3, runs.length);
  const panels = runs.map((run) => makePanel(run, scaleText));
  element("panels").append(...panels.map(({ panel }) => panel));
  const tops = {
    energy: Math.max(...runs.flatMap((run) => energyCurves(run).map((curve) => largest(curve.values)))),
    pairs: Math.max(...runs.map((run) => largest(run.pairs))),
    seconds: Math.max(...runs.map((run) => largest(run.series.seconds))),
  };
  const range = { begin: timeline[0], end: timeline[last] };

  let frame = 0, playing = options.flag("play", false), clock = range.begin, before = 0, stale = true;
  const redraw = () => { stale = true; };
  const plots = runs.map((run, i) => makePlots(panels[i].charts, run, { tops, range, terse: runs.length > 2 },
    (time) => { pause(); setFrame(lastNotAbove(timeline, time + 0.5 / longest.fps)); }, redraw));

  const slider = element("frame");
  slider.max = last;
  element("frame-last").textContent = ` / ${last}`;
  function setFrame(next) {
    frame = Math.min(last, Math.max(0, Math.round(next)));
    clock = timeline[frame];
    redraw();
  }
  function setPlaying(on) {
    playing = on;
    if (on && frame === last) setFrame(0);
    element("play").classList.toggle("playing", on);
    element("play").setAttribute("aria-label", on ? "Pause" : "Play");
  }
  const pause = () => setPlaying(false);
  const step = (by) => { pause(); setFrame(frame + by); };

  function arrange() {
    const wanted = element("stage").clientWidth < 700 ? 1 : columns;
    const sized = `repeat(${wanted}, minmax(0, 1fr))`;
    element("panels").style.gridTemplateColumns = sized;
    element("panels").style.gridAutoRows = "minmax(0, 1fr)";
    document.body.classList.toggle("no-plots", !look.plots);
    stage.resize();
    drawTicks(element("ticks"), runs, timeline);
    redraw();
  }
  function rectangles() {
    const origin = element("stage").getBoundingClientRect();
    return panels.map(({ view }) => {
      const box = view.getBoundingClientRect();
      return { left: box.left - origin.left, top: box.top - origin.top, width: box.width, height: box.height };
    });
  }
  function drawNow() {
    stale = false;
    const time = timeline[frame];
    runs.forEach((run, i) => {
      const own = frameAt(run, time), drawn = drawnAt(run, own);
      stage.figures[i].show(drawn, look);
      showChips(panels[i].chips, chipsOf(run, own, run.marked[drawn].length));
      if (look.plots) plots[i](own);
    });
    stage.draw(rectangles());
    slider.value = frame;
    slider.style.setProperty("--played", `${last ? (100 * frame) / last : 0}%`);
    element("frame-text").textContent = frame;
    element("time-text").textContent = `${time.toFixed(3)} s`;
    element("legend").hidden = !look.strain;
    root.dataset.frame = frame;
  }
  function tick(now) {
    if (playing) {
      clock += (Math.min(0.1, (now - before) / 1000)) * Number(element("speed").value);
      const next = lastNotAbove(timeline, clock);
      if (clock > range.end + 1 / longest.fps) setFrame(0);
      else if (next !== frame) { frame = next; redraw(); }
    }
    before = now;
    if (stage.controls.update()) redraw();
    if (stale) drawNow();
    requestAnimationFrame(tick);
  }
  const home = () => {
    const [azimuth, elevation, distance] = (options.text("camera") || "30,20,1").split(",").map(Number);
    const { width, height } = rectangles()[0];
    stage.camera.aspect = width / Math.max(1, height);
    stage.look(azimuth || 0, elevation || 0, distance || 1);
    redraw();
  };
  const setTheme = (theme) => { root.dataset.theme = theme; stage.setDark(theme === "dark"); arrange(); };
  const flipTheme = () => setTheme(root.dataset.theme === "dark" ? "light" : "dark");

  slider.addEventListener("input", () => { pause(); setFrame(Number(slider.value)); });
  element("play").addEventListener("click", () => setPlaying(!playing));
  element("back").addEventListener("click", () => step(-1));
  element("forward").addEventListener("click", () => step(1));
  element("reset").addEventListener("click", home);
  element("theme").addEventListener("click", flipTheme);
  element("strain-top").value = look.strainTop.toFixed(3).replace(/0$/, "");
  element("strain-top").addEventListener("input", (event) => {
    look.strainTop = Math.max(1.0001, Number(event.target.value) || 1.1);
    redraw();
  });
  panels[0].view.append(element("legend"));
  drawStrainScale(element("legend-scale"));
  bindKeys({
    " ": () => setPlaying(!playing), ArrowLeft: (e) => step(e.shiftKey ? -10 : -1), ArrowRight: (e) => step(e.shiftKey ? 10 : 1),
    Home: () => step(-last), End: () => step(last), r: home, t: flipTheme,
    ...bindToggle("strain", "s", look, redraw), ...bindToggle("wire", "w", look, redraw),
    ...bindToggle("marks", "x", look, redraw), ...bindToggle("plots", "p", look, arrange),
  });
  window.addEventListener("resize", arrange);

  setTheme(root.dataset.theme);
  home();
  setFrame(options.number("frame", 0));
  setPlaying(playing);
  window.selvedge = { get frame() { return frame; }, setFrame: (next) => { pause(); setFrame(next); drawNow(); }, ready: true };
  drawNow();
  if (options.text("probe")) probe(options.text("probe").split(",").map(Number), slider, drawNow, stage.renderer);
  root.dataset.ready = "1";
  requestAnimationFrame(tick);
}

try {
  start();
} catch (error) {
  element("trouble").hidden = false;
  element("trouble").textContent = `The page cannot be drawn: ${error.message}. It needs a browser with WebGL.`;
  console.error(error);
}
