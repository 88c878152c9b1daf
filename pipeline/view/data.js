// Everything the program wrote into the page, as typed arrays. Runs share arrays that are equal.

const bytesOf = (id) => {
  const text = atob(document.getElementById(id).textContent), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};

// What make(...) made the first time that it was asked for with these arguments.
function onlyOnce(make) {
  const known = new Map();
  return (...asked) => {
    const key = asked.join(" ");
    return known.get(key) || known.set(key, make(...asked)).get(key);
  };
}

const indices = onlyOnce((id) => new Uint32Array(bytesOf(id).buffer));
const floats = onlyOnce((id) => new Float32Array(bytesOf(id).buffer));

// Bits from the highest of each byte on.
function bitReader(bytes) {
  let at = 0;
  const next32 = () => {
    const i = at >>> 3, s = at & 7;
    return ((bytes[i] << 24 | bytes[i + 1] << 16 | bytes[i + 2] << 8 | bytes[i + 3]) << s) | (bytes[i + 4] >> (8 - s));
  };
  const read = (bits) => {
    if (!bits) return 0;
    const value = next32() >>> (32 - bits);
    at += bits;
    return value;
  };
  // A Rice code: ones, a zero, k bits; after 24 ones the number itself in 40 bits. The codes 0, 1, 2, 3, ... stand for
  // 0, -1, 1, -2, ...
  const signed = (k, scale) => {
    const ones = Math.clz32(~next32());
    let number;
    if (ones < 24) {
      at += ones + 1;
      number = ones * scale + read(k);
    } else {
      at += 24;
      number = read(20) * 1048576;
      number += read(20);
    }
    return number % 2 ? -(number + 1) / 2 : number / 2;
  };
  return {read, signed};
}

// Whole steps of a surface in every frame, 3 a vertex, as packed_positions.hpp says.
const steps = onlyOnce((id, vertices, frames) => {
  const {read, signed} = bitReader(bytesOf(id)), size = 3 * vertices, levels = new Int32Array(size * frames);
  for (let frame = 0; frame < frames; ++frame)
    for (let axis = 0; axis < 3; ++axis) {
      const line = read(1), againstNeighbour = read(1), k = read(5), scale = 2 ** k;
      const begin = frame * size, end = begin + size;
      let neighbour = 0;
      for (let i = begin + axis; i < end; i += 3) {
        const before = frame ? levels[i - size] : 0;
        const predicted = line ? 2 * before - levels[i - 2 * size] : before;
        const rest = signed(k, scale) + (againstNeighbour ? neighbour : 0);
        neighbour = rest;
        levels[i] = predicted + rest;
      }
    }
  return levels;
});

// Boxes round the surface by frame, without what is absent.
function boxesOf({levels, step, frames, absent}) {
  const size = levels.length / frames;
  return Array.from({length: frames}, (_, frame) => {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const left = new Set(absent[frame] || []), begin = frame * size;
    for (let i = 0; i < size; ++i) {
      if (left.has(Math.floor(i / 3))) continue;
      const value = levels[begin + i] * step, k = i % 3;
      if (value < low[k]) low[k] = value;
      if (value > high[k]) high[k] = value;
    }
    return new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high));
  });
}

function openPositions(positions, vertices) {
  positions.levels = steps(positions.bytes, vertices, positions.frames);
  return positions;
}

// Positions of one surface at one drawn frame into `out`; NaN for a vertex that is absent.
function unpack({levels, step, absent}, frame, out) {
  const begin = frame * out.length;
  for (let i = 0; i < out.length; ++i) out[i] = levels[begin + i] * step;
  for (const v of absent[frame] || []) out.fill(NaN, 3 * v, 3 * v + 3);
}

// Gives a map `at`: the number of each vertex in a drawn frame, NaN for none. A map that changes has bytes of every
// drawn frame, 0 to 254 from 0 to its top, and 255 for none.
function openMap(map, vertices) {
  if (!map.changes) {
    const values = floats(map.values);
    map.at = () => (v) => values[v];
    return;
  }
  const levels = bytesOf(map.values), step = map.high / 254;
  map.at = (drawn) => (v) => {
    const level = levels[drawn * vertices + v];
    return level === 255 ? NaN : level * step;
  };
}

// Maps of a name that change have one scale in all runs.
function shareScales(runs) {
  const maps = runs.flatMap((run) => run.maps.filter((map) => map.changes));
  const tops = maps.map((map) => Math.max(...maps.filter((other) => other.name === map.name).map(({high}) => high)));
  maps.forEach((map, m) => {
    map.high = tops[m];
  });
}

function loadRuns() {
  const data = JSON.parse(document.getElementById("runs").textContent);
  data.runs.forEach((run) => {
    run.triangles = indices(run.triangleArray);
    run.metric = floats(run.metric);
    run.maps.forEach((map) => openMap(map, run.vertices));
    run.frames = run.series.time.length;
    run.end = run.series.time[run.frames - 1];
    run.boxes = boxesOf(openPositions(run.positions, run.vertices));
    run.obstacles.forEach((body) => {
      body.triangles = indices(body.triangleArray);
      body.boxes = boxesOf(openPositions(body.positions, body.vertices));
    });
    run.pairs = run.series.self_pairs.map((pairs, f) => pairs + run.series.obstacle_pairs[f]);
  });
  shareScales(data.runs);
  document.querySelectorAll("script[type='text/plain']").forEach((array) => array.remove());
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

// The box round several boxes.
const boundsOf = (boxes) => boxes.reduce((sum, box) => sum.union(box), new THREE.Box3());

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
