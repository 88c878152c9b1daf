// Everything the program wrote into the page, as typed arrays. A level of 65535 is a vertex that is not finite.

function decode(id, Type) {
  const element = document.getElementById(id);
  const text = atob(element.textContent);
  element.remove();
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Type(bytes.buffer);
}

// Positions of one surface at one drawn frame into `out`, from its levels and the frame's box.
function unpack(levels, box, frame, out) {
  const begin = frame * out.length;
  for (let i = 0; i < out.length; ++i) {
    const level = levels[begin + i];
    out[i] = level === 65535 ? NaN : box[i % 3] + level * box[3 + (i % 3)];
  }
}

function loadRuns() {
  const data = JSON.parse(document.getElementById("runs").textContent);
  data.runs.forEach((run, r) => {
    run.triangles = decode(`run${r}-triangles`, Uint32Array);
    run.metric = decode(`run${r}-metric`, Float32Array);
    run.levels = decode(`run${r}-x`, Uint16Array);
    run.maps.forEach((map, m) => {
      map.values = decode(`run${r}-map${m}`, Float32Array);
    });
    run.frames = run.series.time.length;
    run.end = run.series.time[run.frames - 1];
    run.obstacles.forEach((body, b) => {
      body.triangles = decode(`run${r}-body${b}-triangles`, Uint32Array);
      body.levels = decode(`run${r}-body${b}-x`, Uint16Array);
    });
    run.pairs = run.series.self_pairs.map((pairs, f) => pairs + run.series.obstacle_pairs[f]);
  });
  return data;
}

// The last index whose value is not above `value`, in an ascending list.
function lastNotAbove(list, value) {
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

const frameAt = (run, time) => lastNotAbove(run.series.time, time + 1e-9);
const drawnAt = (run, frame) => lastNotAbove(run.drawn, frame);

// The box round everything a run's frames fill, from the frames' own boxes.
function boundsOf(boxes) {
  const bounds = new THREE.Box3();
  for (const b of boxes) {
    bounds.expandByPoint(new THREE.Vector3(b[0], b[1], b[2]));
    bounds.expandByPoint(new THREE.Vector3(b[0] + 65534 * b[3], b[1] + 65534 * b[4], b[2] + 65534 * b[5]));
  }
  return bounds;
}

// Short numbers for reading: three digits, small ones with a power.
function short(value) {
  if (value === null || !isFinite(value)) return "\u2013";
  const size = Math.abs(value);
  if (size === 0) return "0";
  if (size >= 1e5 || size < 1e-3) return value.toExponential(1).replace("e-", "e\u2212").replace("e+", "e");
  return size >= 100 ? value.toFixed(0) :
      size >= 10     ? value.toFixed(1) :
      size >= 1      ? value.toFixed(2) :
                       value.toPrecision(2);
}

function seconds(value) {
  if (value === null || !isFinite(value)) return "\u2013";
  return value < 1 ? `${short(1000 * value)} ms` : `${short(value)} s`;
}

function lengthText(metres) { return metres >= 1 ? `${short(metres)} m` : `${Math.round(metres * 1e3) / 10} cm`; }
