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
console.error = (...parts) => {
  note(parts.join(" "));
  printError.apply(console, parts);
};
document.documentElement.dataset.errors = "[]";

// A round top for the colours, which all but two of a hundred triangles stay under: so runs without trouble differ in
// colour too. Measured on up to eight drawn frames of each run.
function strainTop(runs) {
  const stretches = runs.flatMap((run) => {
    const x = new Float32Array(3 * run.vertices), every = Math.ceil(run.drawn.length / 8), found = [];
    for (let k = 0; k < run.drawn.length; k += every) {
      unpack(run.positions, k, x);
      for (let t = 0; 3 * t < run.triangles.length; ++t) found.push(stretchOf(x, run.triangles, run.metric, t));
    }
    return found.filter(isFinite);
  });
  const high = Float32Array.from(stretches).sort()[Math.floor(0.98 * (stretches.length - 1))] || 1.1;
  return Math.min(3, 1 + Math.max(0.01, niceTop(high - 1)));
}

// The slider counts the frames of the run that ends last; with equal ends, of the one with most frames.
function makeTimeline(runs) {
  const longest = runs.reduce((best, run) => {
    return run.end > best.end || (run.end === best.end && run.frames > best.frames) ? run : best;
  });
  const times = longest.series.time, last = times.length - 1;
  runs.forEach((run) => {
    run.ended = run.end < longest.end - 1e-9;
  });
  return {times, last, begin: times[0], end: times[last], spacing: 1 / longest.fps};
}

// The current frame and whether it advances by itself. `changed` is called after every change.
function makePlayer(timeline, changed) {
  const {times, last} = timeline;
  const player = {frame: 0, playing: false};
  let clock = timeline.begin;
  player.go = (next) => {
    player.frame = Math.min(last, Math.max(0, Math.round(next) || 0));
    clock = times[player.frame];
    changed();
  };
  player.seek = (time) => {
    player.pause();
    player.go(lastNotAbove(times, time + timeline.spacing / 2));
  };
  player.step = (by) => {
    player.pause();
    player.go(player.frame + by);
  };
  player.play = (on) => {
    player.playing = on;
    if (on && player.frame === last) player.go(0);
    changed();
  };
  player.pause = () => player.play(false);
  // The last frame stays for its own duration, then the run begins again.
  player.advance = (duration) => {
    clock += duration;
    const next = lastNotAbove(times, clock);
    if (clock > timeline.end + timeline.spacing) player.go(0);
    else if (next !== player.frame) {
      player.frame = next;
      changed();
    }
  };
  return player;
}

function initialLook(runs, options) {
  return {
    strain: options.flag("strain", false),
    wire: options.flag("wire", false),
    marks: options.flag("marks", true),
    plots: options.flag("plots", !isReport(runs) && (runs.length === 1 || window.innerWidth > 700)),
    map: options.number("map", isReport(runs) ? 0 : -1),
    strainTop: Math.max(1.0001, options.number("top", strainTop(runs))),
  };
}

// Tops of the charts' axes, over all runs.
function chartTops(runs) {
  return {
    energy: Math.max(...runs.flatMap((run) => energyCurves(run).map((curve) => largest(curve.values)))),
    pairs: Math.max(...runs.map((run) => largest(run.pairs))),
    seconds: Math.max(...runs.map((run) => largest(run.series.seconds))),
  };
}

// The page: everything on it, and how it is brought up to date. `stale` is set when something must be drawn again.
function makePage(data, options) {
  const runs = data.runs, timeline = makeTimeline(runs), look = initialLook(runs, options);
  const page = {
    runs,
    timeline,
    look,
    stale: true,
    redraw: () => {
      page.stale = true;
    }
  };
  const player = page.player = makePlayer(timeline, page.redraw);
  const stage = page.stage = makeStage(element("canvas"), runs);
  const panels = runs.map((run) => makePanel(run, `grid ${lengthText(stage.spacing)}`));
  element("panels").append(...panels.map(({panel}) => panel));
  panels[0].view.append(element("legend"));
  const shared = {tops: chartTops(runs), range: timeline, terse: runs.length > 2};
  const plots = runs.map((run, i) => makePlots(panels[i].charts, run, shared, player.seek, page.redraw));
  const columns = runs.length === 4 ? 2 : Math.min(3, runs.length);

  page.rectangles = () => {
    const origin = element("stage").getBoundingClientRect();
    const boxes = panels.map(({view}) => view.getBoundingClientRect());
    // In a narrow panel the labels, with one row of chips, would lie over the figure's head: it is drawn below them, or
    // beside them where it stands in a panel that is wider than high.
    const narrow = boxes[0].width < 640, beside = narrow && stage.slender && boxes[0].width > 1.3 * boxes[0].height;
    document.body.classList.toggle("beside", beside);
    const labels = narrow && !beside ? Math.max(...panels.map(({chips}) => chips.offsetTop)) + 26 : 0;
    return boxes.map((box) => ({
      left: box.left - origin.left,
      top: box.top - origin.top,
      width: box.width,
      height: box.height,
      labels: Math.min(labels, 0.3 * box.height),
      aside: beside ? 0.22 * box.width : 0
    }));
  };
  page.arrange = () => {
    const wanted = element("stage").clientWidth < 700 ? 1 : columns;
    element("panels").style.gridTemplateColumns = `repeat(${wanted}, minmax(0, 1fr))`;
    document.body.classList.toggle("no-plots", !look.plots);
    stage.resize();
    drawTicks(element("ticks"), runs, timeline.times);
    page.redraw();
    if (!page.turned) page.home();
  };
  stage.controls.addEventListener("start", () => {
    page.turned = true;
  });
  // The camera back; it keeps the figures in view when the window changes, until the user turns it.
  page.home = () => {
    page.turned = false;
    const [azimuth, elevation, distance] = (options.text("camera") || "30,20,1").split(",").map(Number);
    stage.look(azimuth || 0, elevation || 0, distance || 1, page.rectangles()[0]);
    page.redraw();
  };
  page.setTheme = (theme) => {
    document.documentElement.dataset.theme = theme;
    stage.setDark(theme === "dark");
    page.arrange();
  };
  page.draw = () => {
    page.stale = false;
    runs.forEach((run, i) => {
      const own = frameAt(run, timeline.times[player.frame]), drawn = drawnAt(run, own);
      stage.figures[i].show(drawn, look);
      if (i === 0) stage.follow(drawn);
      showChips(panels[i].chips, chipsOf(run, own, run.marked[drawn].length));
      if (look.plots) plots[i](own);
    });
    stage.draw(page.rectangles());
    showTransport(player, timeline);
    showLegend(runs[0], look);
    page.showMaps();
    document.documentElement.dataset.frame = player.frame;
  };
  return page;
}

function start() {
  const data = loadRuns(), options = readOptions(), page = makePage(data, options), {player, stage} = page;
  const runs = data.runs.length, names = data.runs.map((run) => run.name).join(", ");
  document.title = `${names} \u00b7 selvedge`;
  element("summary").textContent = `${runs} run${runs === 1 ? "" : "s"} \u00b7 version ${data.program}`;
  drawStrainScale(element("legend-scale"));
  bindControls(page);
  bindMaps(page);
  showTable(data.runs[0].table);
  window.addEventListener("resize", page.arrange);

  document.body.classList.toggle("no-bars", !options.flag("bars", true));
  page.setTheme(firstTheme(options));
  player.go(options.number("frame", 0));
  player.play(options.flag("play", false));
  window.selvedge = {
    get frame() { return player.frame; },
    setFrame(next) {
      player.pause();
      player.go(next);
      page.draw();
    },
    ready: true,
  };
  page.draw();
  if (options.text("probe"))
    probe(options.text("probe").split(",").map(Number), element("frame"), page.draw, stage.renderer);
  document.documentElement.dataset.ready = "1";

  let before = performance.now();
  const tick = (now) => {
    const passed = Math.min(0.1, Math.max(0, now - before) / 1000);
    before = now;
    if (player.playing) player.advance(passed * Number(element("speed").value));
    if (stage.controls.update()) page.redraw();
    if (page.stale) page.draw();
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

try {
  start();
} catch (error) {
  element("trouble").hidden = false;
  element("trouble").textContent = `The page cannot be drawn: ${error.message}. It needs a browser with WebGL.`;
  console.error(error);
}
