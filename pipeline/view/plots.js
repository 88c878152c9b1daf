// Small charts of one run: energy, intersecting pairs, seconds a frame. One click or drag goes to that frame.

function niceTop(value) {
  if (!(value > 0)) return 1;
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  return power * [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((factor) => factor * power >= value * 0.9999);
}

const largest = (list) => list.reduce((top, value) => (value !== null && value > top ? value : top), 0);

function chartElement(parent, title, logarithmic) {
  const chart = document.createElement("section");
  chart.className = "chart";
  chart.innerHTML = `<div class="chart-head"><b></b><span></span></div><div class="keys"></div><canvas></canvas>`;
  chart.querySelector("b").textContent = title;
  if (logarithmic) {
    const button = document.createElement("button");
    button.textContent = "log";
    button.title = "Logarithmic scale";
    button.setAttribute("aria-pressed", "false");
    chart.querySelector(".chart-head span").replaceWith(button);
  }
  parent.append(chart);
  return {
    chart,
    canvas: chart.querySelector("canvas"),
    value: chart.querySelector(".chart-head span"),
    keys: chart.querySelector(".keys"),
    button: chart.querySelector("button")
  };
}

// The value of a colour; names that begin with `--` are those of the page's style.
function colourOf(name) {
  return name.startsWith("--") ? getComputedStyle(document.documentElement).getPropertyValue(name).trim() : name;
}

// Lines at round parts of the top, over the whole width.
function drawLevels(context, levels, {left, right, bottom, top}) {
  context.strokeStyle = colourOf("--line");
  context.lineWidth = 1;
  for (const level of levels) {
    const at = Math.round(bottom - level * (bottom - top)) + 0.5;
    context.beginPath();
    context.moveTo(left, at);
    context.lineTo(right, at);
    context.stroke();
  }
}

// One curve over the times; `x` and `y` are its places on the canvas. Frames without a value are left out.
function drawCurve(context, curve, times, x, y, bottom) {
  context.beginPath();
  curve.values.forEach((value, f) => {
    if (value !== null) context.lineTo(x(times[f]), y(value));
  });
  context.lineWidth = 1.6;
  context.lineJoin = "round";
  context.strokeStyle = colourOf(curve.colour);
  context.stroke();
  if (!curve.filled) return;
  context.lineTo(x(times[times.length - 1]), bottom);
  context.lineTo(x(times[0]), bottom);
  context.globalAlpha = 0.13;
  context.fillStyle = context.strokeStyle;
  context.fill();
  context.globalAlpha = 1;
}

// The line of the shown frame, and a dot on every curve that has a value there.
function drawCursor(context, curves, frame, at, y, height) {
  context.strokeStyle = colourOf("--ink");
  context.globalAlpha = 0.55;
  context.lineWidth = 1;
  context.beginPath();
  context.moveTo(at, 0);
  context.lineTo(at, height);
  context.stroke();
  context.globalAlpha = 1;
  for (const curve of curves) {
    const value = curve.values[frame];
    if (value === null) continue;
    context.fillStyle = colourOf(curve.colour);
    context.beginPath();
    context.arc(at, y(value), 2.6, 0, 7);
    context.fill();
  }
}

// Curves on the common time axis. `log` shows five decades below the top.
function drawCurves(canvas, curves, run, view) {
  const ratio = Math.min(window.devicePixelRatio || 1, 2), width = canvas.clientWidth, height = canvas.clientHeight;
  if (!width || !height) return;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  const left = 1, right = width - 4, top = 4, bottom = height - 4;
  const x = (time) => left + ((right - left) * (time - view.begin)) / (view.end - view.begin || 1);
  const share = (value) =>
      view.log ? Math.max(0, 1 + Math.log10(Math.max(value, 1e-30) / view.top) / 5) : value / view.top;
  const y = (value) => bottom - (bottom - top) * Math.min(1, Math.max(0, share(value)));

  drawLevels(context, view.log ? [0, 0.2, 0.4, 0.6, 0.8, 1] : [0, 0.5, 1], {left, right, bottom, top});
  for (const curve of curves) drawCurve(context, curve, run.series.time, x, y, bottom);
  drawCursor(context, curves, view.frame, x(run.series.time[view.frame]), y, height);
  context.fillStyle = colourOf("--faint");
  context.font = `10px ${getComputedStyle(document.body).fontFamily}`;
  context.textBaseline = "top";
  context.fillText(view.topText, left + 2, top + 2);
}

// Gravity is counted from its lowest frame, so that all share one axis that begins at zero. Springs are shown where
// there are any.
function energyCurves(run) {
  const gravity = run.series.gravity_energy, springs = run.series.spring_energy;
  const lowest = gravity.reduce((low, value) => (value !== null && value < low ? value : low), Infinity);
  return Object.keys(energyColours)
      .filter((name) => name !== "spring" || springs.some((value) => value))
      .map((name) => ({
             name,
             colour: energyColours[name],
             values: name === "gravity" ? gravity.map((value) => (value === null ? null : value - lowest)) :
                                          run.series[`${name}_energy`],
           }));
}

// Charts of a run in `parent`; the tops are shared by all runs so that they can be compared by eye.
function makePlots(parent, run, {tops, range, terse}, seek, redraw) {
  parent.classList.toggle("terse", terse);
  const energy = chartElement(parent, "Energy [J]", true);
  const pairs = chartElement(parent, terse ? "Pairs" : "Intersecting pairs", false);
  const cost = chartElement(parent, terse ? "Time" : "Time a frame", false);
  const curves = energyCurves(run);
  const values = curves.map((curve) => {
    const key = document.createElement("span");
    key.innerHTML = `<i style="background:${curve.colour}"></i>${curve.name} <b></b>`;
    if (curve.name === "gravity") key.title = "above its lowest frame";
    energy.keys.append(key);
    return key.querySelector("b");
  });
  const pairCurve = [{values: run.pairs, colour: "--bad", filled: true}];
  const costCurve = [{values: run.series.seconds, colour: "--accent", filled: true}];
  const total = run.series.seconds.reduce((sum, value) => sum + (value || 0), 0);
  const middle = [...run.series.seconds].sort((a, b) => a - b)[run.frames >> 1];
  const most = largest(run.pairs), scope = run.selfAudited ? "" : "obstacles only, ";
  pairs.keys.textContent = terse ? `${scope}most ${most}` : `${scope}most in a frame ${most}`;
  cost.keys.textContent = terse ? `all ${seconds(total)}` : `median ${seconds(middle)}, all ${seconds(total)}`;
  let log = false;
  energy.button.addEventListener("click", () => {
    log = !log;
    energy.button.setAttribute("aria-pressed", log);
    redraw();
  });
  for (const {canvas} of [energy, pairs, cost]) {
    const go = (event) => {
      const share = (event.offsetX - 1) / (canvas.clientWidth - 5);
      seek(range.begin + Math.min(1, Math.max(0, share)) * (range.end - range.begin));
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      go(event);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) go(event);
    });
  }
  return function show(frame) {
    const view = {...range, frame};
    const joule = niceTop(tops.energy), crowd = niceTop(tops.pairs), slowest = niceTop(tops.seconds);
    drawCurves(energy.canvas, curves, run, {...view, top: joule, topText: `${short(joule)} J`, log});
    drawCurves(pairs.canvas, pairCurve, run, {...view, top: crowd, topText: tops.pairs > 0 ? String(crowd) : ""});
    drawCurves(cost.canvas, costCurve, run, {...view, top: slowest, topText: seconds(slowest)});
    curves.forEach((curve, i) => {
      values[i].textContent = short(curve.values[frame]);
    });
    pairs.value.textContent = `${run.pairs[frame]}`;
    cost.value.textContent = seconds(run.series.seconds[frame]);
  };
}
